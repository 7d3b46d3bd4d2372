"""Objects are taken apart into the closed surfaces that they are put together of."""

import dataclasses

import numpy as np

from tests.export.simulation.houses import joined, table
from tests.geometry.things import box
from wm.export.simulation.parts import parts_of, volume


def test_boards_and_legs_are_parts_with_their_volume_and_material():
    parts = parts_of(table())
    assert [part.slot for part in parts] == [0, 1, 2, 3, 4]
    assert all(part.closed for part in parts)
    np.testing.assert_allclose([volume(part.corners) for part in parts], [0.024, *[0.00175] * 4])
    np.testing.assert_allclose(parts[0].area, 2 * 0.6 + 3.2 * 0.04)


def test_parts_that_share_an_edge_stay_apart():
    pair = joined(box((0, 0, 0), (1, 1, 1)), box((1, 1, 0), (2, 2, 1)))
    vertices, index = np.unique(pair.vertices, axis=0, return_inverse=True)
    welded = dataclasses.replace(pair, vertices=vertices, faces=index.reshape(-1)[pair.faces].astype(np.int32))
    assert len(vertices) == 14
    assert [volume(part.corners) for part in parts_of(welded)] == [1.0, 1.0]


def test_open_and_inward_surfaces_are_told():
    thing = box((0, 0, 0), (1, 1, 1))
    lidless = dataclasses.replace(thing, faces=thing.faces[:-2], face_slot=thing.face_slot[:-2])
    inward = dataclasses.replace(thing, faces=thing.faces[:, ::-1])
    assert [part.closed for part in (*parts_of(lidless), *parts_of(inward))] == [False, False]
