"""Offline stand-ins for every model: deterministic, without weights, keys or network.

    style/ furniture/ arrangement/ world/   what they share: a theme's looks, parametric furniture, furnished rooms, the lit world
    language/ image/ objects/ depth/ segmentation/ reconstruction/   one folder a group of backends
"""
