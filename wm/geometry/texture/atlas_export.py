"""The accumulated texture as textured meshes for export: per room, its charts packed side by side into one image.

Charts are laid on shelves, tallest first. Texels that no view saw take the colour of the nearest one that was seen, and every
chart has a rim of its own border colours, so that filtering in a viewer finds neither black nor the neighbouring chart.
"""

import numpy as np

from wm.geometry.mesh.glb import GlbNode
from wm.geometry.texture.atlas import chart_image
from wm.geometry.texture.packing import filled_image, shelves
from wm.types import Atlas, Mesh

RIM = 2  # texels around every chart: viewers read this atlas through mipmaps, of which the first level needs two
UNPAINTED = 0.5  # sRGB grey of charts that no view saw, and of the outer skin


def atlas_nodes(atlas: Atlas, mesh: Mesh) -> list[GlbNode]:
    """One textured node per room, "room <index>", and one of plain grey for faces without a chart, "exterior".

    Args:
      atlas: the texture.
      mesh: the structure: the mesh the atlas was built from, or the faces that one began with.

    Raises:
      ValueError: the mesh has more faces than the atlas knows.
    """
    if len(mesh.faces) > len(atlas.face_chart):
        raise ValueError(f"the mesh has {len(mesh.faces)} faces; the atlas was built for {len(atlas.face_chart)}")
    face_chart = atlas.face_chart[: len(mesh.faces)]
    nodes = []
    for room in np.unique(atlas.chart_room):
        charts = np.flatnonzero(atlas.chart_room == room)
        corner, size = shelves(atlas.chart_shape[charts] + 2 * RIM)
        faces = np.flatnonzero(np.isin(face_chart, charts))
        place = np.zeros((len(atlas.chart_room), 2))
        place[charts] = corner + RIM
        key = mesh.faces[faces].astype(np.int64) * len(place) + face_chart[faces, None]
        key, index = np.unique(key, return_inverse=True)
        vertex, chart = np.divmod(key, len(place))
        vertices = mesh.vertices[vertex]
        offset = (vertices - atlas.chart_origin[chart]) / atlas.texel_size
        row, column = (np.einsum("vi,vi->v", offset, axis[chart]) for axis in (atlas.chart_v, atlas.chart_u))
        uv = np.stack([(column + place[chart, 1]) / size[1], (row + place[chart, 0]) / size[0]], axis=1)
        texture = np.zeros((*size, 3), np.uint8)
        for (y, x), k in zip(corner, charts):
            image = np.pad(_filled(atlas, int(k)), ((RIM, RIM), (RIM, RIM), (0, 0)), mode="edge")
            texture[y : y + image.shape[0], x : x + image.shape[1]] = image
        faces = index.reshape(-1, 3)
        nodes.append(GlbNode(name=f"room {room}", vertices=vertices, faces=faces, uv=uv, texture=texture, unlit=True))
    bare = mesh.faces[face_chart < 0]
    if len(bare):
        used, index = np.unique(bare, return_inverse=True)
        grey = np.full(3, UNPAINTED)
        nodes.append(GlbNode(name="exterior", vertices=mesh.vertices[used], faces=index.reshape(-1, 3), base_color=grey))
    return nodes


def _filled(atlas: Atlas, chart: int) -> np.ndarray:
    """[rows, columns, 3] uint8: a chart's colours, each unknown texel with that of the nearest known one."""
    color, known = chart_image(atlas, chart, atlas.color), chart_image(atlas, chart, atlas.weight) > 0
    if not known.any():
        color, known = np.full_like(color, UNPAINTED), np.ones_like(known)
    return filled_image(color, known)
