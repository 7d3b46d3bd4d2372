"""Cameras and rays: which ray belongs to which pixel, and what it hits.

    pinhole         make_camera, camera_rays, project_points
    raycast         cast, cast_rays, occluded: Embree on every core
    _embree         the only module that imports embreex
    _reference      the slow float64 twin of raycast
    surface_points  points that stand for a surface, and from where they are in sight
"""
