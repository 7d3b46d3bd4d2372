"""The prisms of a building cover its surface exactly, from behind."""

import numpy as np
import pytest

from tests.geometry.plans import l_shaped, random_plan, slanted_plan, two_rooms
from wm.export.simulation.parts import volume
from wm.export.simulation.shell import DEPTH, convex_pieces, prisms
from wm.geometry import build_structure
from wm.types import SurfaceKind

PLANS = [two_rooms(), l_shaped(), random_plan(1, 5), slanted_plan(2, 4)]


def surfaces(mesh):
    for room in np.unique(mesh.face_room):
        for kind in SurfaceKind:
            faces = np.flatnonzero((mesh.face_room == room) & (mesh.face_kind == kind))
            if len(faces):
                yield kind, faces


@pytest.mark.parametrize("plan", PLANS, ids=["two", "l_shaped", "random", "slanted"])
def test_pieces_are_convex_and_have_the_area_of_the_surface(plan):
    mesh = build_structure(plan)
    for kind, faces in surfaces(mesh):
        solids = prisms(mesh, faces)
        corners = mesh.vertices[mesh.faces[faces]]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
        # A piece that were not convex would have a hull that is larger, and one that was lost would make the sum smaller.
        assert sum(volume(solid.vertices[solid.faces]) for solid in solids) == pytest.approx(
            area * DEPTH.get(kind, 0.02), rel=1e-6
        )
        assert len(solids) <= len(faces)


def test_a_plain_room_is_six_boxes():
    mesh = build_structure(two_rooms())
    floor = np.flatnonzero((mesh.face_room == 1) & (mesh.face_kind == SurfaceKind.FLOOR))
    (solid,) = prisms(mesh, floor)
    center, size = solid.box
    assert center[2] + size[2] / 2 == pytest.approx(0, abs=1e-9)


def test_pieces_of_one_plane_are_joined_and_those_across_a_corner_are_not():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 1], [1, 1, 1]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    pieces = convex_pieces(vertices, faces)
    assert [sorted(loop.tolist()) for loop, _ in pieces] == [[0, 1, 2, 3], [1, 2, 4, 5]]
