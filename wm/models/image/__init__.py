"""Backends that draw views.

    flux2_klein  FLUX.2 [klein] of Black Forest Labs, on this machine
    canvas       the size at which a model draws a view, and images scaled between the two

A backend returns what registers with the view's camera pixel by pixel, whatever size its model draws.
"""
