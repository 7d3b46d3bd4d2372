"""Backends that estimate depth.

    depth_pro                Depth Pro of Apple, on this machine: metric, by the camera's focal length
    depth_anything_2         Depth Anything V2, on this machine: its metric versions
    local_depth              LocalDepth: what the two have in common
    resampling               images made ready for them, their answers brought back
    depth_anything_3         Depth Anything 3, or any other depth model, served by a worker in its own interpreter
    depth_anything_3_worker  the script that serves it, run by the interpreter of its environment

Models of relative inverse depth are no backends: no depth follows without the shift.
"""
