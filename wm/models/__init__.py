"""Backends of real models. This version has none; a model of your own can come from outside (see wm.synth.registry)."""
