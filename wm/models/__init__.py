"""Backends of real models. None is in this version; a model of one's own comes from outside (wm.synth.registry says how)."""
