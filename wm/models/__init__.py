"""Backends of real models, a package a group. SDKs and weights are reached only when a model is asked (wm.synth.registry).

segmentation  SAM 3, by names or by clicks
"""
