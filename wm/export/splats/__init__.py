"""Gaussians of a run in the formats that viewers open, each read back after writing.

    copying         SplatCopy: write and check of a format that holds gaussians alone
    comparing       deviations of what was read from what was written
    labels          splat_labels: the room and the object of each gaussian
    splat           .splat
    spz             SPZ, version 3
    sog             SOG
    compressed_ply  PlayCanvas's compressed PLY
    gltf_splats     scaffold and gaussians in one GLB file
    labelled_ply    the PLY file with room and object of each gaussian
"""
