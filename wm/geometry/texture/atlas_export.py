"""The accumulated texture as textured meshes for export: per room, its charts packed side by side into images.

Charts are laid on shelves, tallest first, in as many images as it takes for each to be shown by every viewer. A chart that alone
is larger has coarser pixels. Texels that no view saw take the colour of the nearest one that was seen, and every
chart has a rim of its own border colours, so that filtering in a viewer finds neither black nor the neighbouring chart.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from wm.geometry.mesh.glb_nodes import GlbNode
from wm.geometry.texture.atlas import chart_image
from wm.geometry.texture.packing import filled_image, shelves
from wm.types import Atlas, Mesh

RIM = 2  # texels around every chart: viewers read this atlas through mipmaps, of which the first level needs two
LARGEST_SIDE = 4096  # pixels of an image: what phones show; desktop viewers have 8192 and more
UNPAINTED = 0.5  # sRGB grey of charts that no view saw, and of the outer skin


def atlas_nodes(atlas: Atlas, mesh: Mesh, rooms: Sequence[str] = ()) -> list[GlbNode]:
    """Textured nodes of every room, with "<room> part <k>" where its charts do not fit one image of LARGEST_SIDE; and one of
    plain grey for faces without a chart, "exterior", in the file's second scene: seen from outside it would hide all others.

    Args:
      atlas: the texture.
      mesh: the structure: the mesh the atlas was built from, or the faces that one began with.
      rooms: the ids of the plan's rooms, which name the nodes; "room <index>" without them.

    Raises:
      ValueError: the mesh has more faces than the atlas knows.
    """
    if len(mesh.faces) > len(atlas.face_chart):
        raise ValueError(f"the mesh has {len(mesh.faces)} faces; the atlas was built for {len(atlas.face_chart)}")
    face_chart = atlas.face_chart[: len(mesh.faces)]
    nodes = []
    for room in map(int, np.unique(atlas.chart_room)):
        for part, charts in enumerate(_sheets(atlas, np.flatnonzero(atlas.chart_room == room))):
            told = rooms[room] if rooms else f"room {room}"
            name = f"{told} part {part + 1}" if part else told
            node = _sheet_node(name, atlas, mesh, face_chart, charts)
            nodes.append(dataclasses.replace(node, extras={"room": rooms[room], "label": "room"}) if rooms else node)
    bare = mesh.faces[face_chart < 0]
    if len(bare):
        used, index = np.unique(bare, return_inverse=True)
        grey = np.full(3, UNPAINTED)
        outer = index.reshape(-1, 3)
        nodes.append(GlbNode(name="exterior", vertices=mesh.vertices[used], faces=outer, base_color=grey, apart=True))
    return nodes


def coarse_rooms(atlas: Atlas) -> list[int]:
    """The rooms of which a chart is exported with pixels coarser than its texels, because no image could hold it."""
    return sorted({int(atlas.chart_room[k]) for k in range(len(atlas.chart_room)) if _coarseness(atlas, k) > 1})


def _coarseness(atlas: Atlas, chart: int) -> int:
    """How many texels along a side make one pixel: more than one only where a chart alone exceeds the largest image."""
    return -(-int(atlas.chart_shape[chart].max()) // (LARGEST_SIDE - 2 * RIM))


def _framed_shapes(atlas: Atlas, charts: np.ndarray) -> np.ndarray:
    """[c, 2] rows and columns of pixels of the charts with their rims."""
    coarse = np.array([[_coarseness(atlas, int(k))] for k in charts])
    return -(-atlas.chart_shape[charts] // coarse) + 2 * RIM


def _sheets(atlas: Atlas, charts: np.ndarray) -> list[np.ndarray]:
    """The charts in order, halved until each part fits one image."""
    _, size = shelves(_framed_shapes(atlas, charts))
    if max(size) <= LARGEST_SIDE or len(charts) == 1:
        return [charts]
    half = len(charts) // 2
    return [*_sheets(atlas, charts[:half]), *_sheets(atlas, charts[half:])]


def _sheet_node(name: str, atlas: Atlas, mesh: Mesh, face_chart: np.ndarray, charts: np.ndarray) -> GlbNode:
    """The faces of some charts, and the one image that holds them."""
    corner, size = shelves(_framed_shapes(atlas, charts))
    faces = np.flatnonzero(np.isin(face_chart, charts))
    place, texel = np.zeros((len(atlas.chart_room), 2)), np.ones(len(atlas.chart_room))
    place[charts] = corner + RIM
    coarse = {int(k): _coarseness(atlas, int(k)) for k in charts}
    texel[charts] = [coarse[int(k)] for k in charts]
    key = mesh.faces[faces].astype(np.int64) * len(place) + face_chart[faces, None]
    key, index = np.unique(key, return_inverse=True)
    vertex, chart = np.divmod(key, len(place))
    vertices = mesh.vertices[vertex]
    offset = (vertices - atlas.chart_origin[chart]) / atlas.texel_size
    row, column = (np.einsum("vi,vi->v", offset, axis[chart]) / texel[chart] for axis in (atlas.chart_v, atlas.chart_u))
    uv = np.stack([(column + place[chart, 1]) / size[1], (row + place[chart, 0]) / size[0]], axis=1)
    texture = np.zeros((*size, 3), np.uint8)
    for (y, x), k in zip(corner, charts):
        image = np.pad(_coarser(_filled(atlas, int(k)), coarse[int(k)]), ((RIM, RIM), (RIM, RIM), (0, 0)), mode="edge")
        texture[y : y + image.shape[0], x : x + image.shape[1]] = image
    return GlbNode(name=name, vertices=vertices, faces=index.reshape(-1, 3), uv=uv, texture=texture, unlit=True)


def _coarser(image: np.ndarray, times: int) -> np.ndarray:
    """The means of squares of pixels; at the far edges the last pixel is repeated to whole squares."""
    if times == 1:
        return image
    rows, columns = image.shape[:2]
    padded = np.pad(image, ((0, -rows % times), (0, -columns % times), (0, 0)), mode="edge").astype(np.float32)
    squares = padded.reshape(padded.shape[0] // times, times, padded.shape[1] // times, times, 3)
    return np.round(squares.mean(axis=(1, 3))).astype(np.uint8)


def _filled(atlas: Atlas, chart: int) -> np.ndarray:
    """[rows, columns, 3] uint8: a chart's colours, each unknown texel with that of the nearest known one."""
    color, known = chart_image(atlas, chart, atlas.color), chart_image(atlas, chart, atlas.weight) > 0
    if not known.any():
        color, known = np.full_like(color, UNPAINTED), np.ones_like(known)
    return filled_image(color, known)
