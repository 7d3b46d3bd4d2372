"""A script to begin one of your own from (docs/workers.md): the box around the points that an image shows, without any weights.

It needs NumPy and trimesh. The box is upright, faces the camera, and is as deep as it is wide if less of its depth is seen;
it has the mean colour of its pixels. Option: `pose=no` leaves the pose out, as models do that know only the shape.
"""

import numpy as np


def describe(options):
    """Name and version of the model; quick, nothing large is imported."""
    return {"model": "box of points", "version": "1"}


def load(options):
    """What `answer` needs: here would be the weights, on the device."""
    return options


def answer(model, request, arrays):
    """A mesh with vertex colours, a metre of the file being a metre, and where its points lie in the camera."""
    import trimesh

    points = arrays["points"][arrays["mask"] & np.isfinite(arrays["points"]).all(axis=2)]
    if len(points) < 3:
        return {"refused": "fewer than three points"}
    axes = upright_axes(np.array(request["up"]))
    low, high = np.quantile(points @ axes, [0.002, 0.998], axis=0)
    low[2] = min(low[2], high[2] - (high[0] - low[0]))  # the back, away from the camera
    mesh = trimesh.creation.box(extents=np.maximum(high - low, 0.01))
    color = np.append(arrays["rgb"][arrays["mask"]].mean(axis=0), 255).astype(np.uint8)
    mesh = trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_colors=np.tile(color, (len(mesh.vertices), 1)))
    pose = {"scale": 1.0, "rotation": axes, "translation": axes @ (low + high) / 2} if model.get("pose") != "no" else {}
    result = {"mesh.glb": mesh.export(file_type="glb"), **pose}
    return result


def upright_axes(up):
    """[3, 3] columns: right, up, and towards the viewer, as a GLB has them, in the axes of a camera in which `up` is up."""
    towards = np.array([0.0, 0.0, -1.0])
    right = np.cross(up, towards)
    right = right / np.linalg.norm(right)
    return np.stack([right, up, np.cross(right, up)], axis=1)
