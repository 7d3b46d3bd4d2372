"""Backends that estimate depth.

    depth_anything_3         Depth Anything 3, or any other depth model, served by a worker in its own interpreter
    depth_anything_3_worker  the script that serves it, run by the interpreter of its environment

Models of relative inverse depth are no backends: no depth follows without the shift.
"""
