"""Every kind in two styles (they take turns): valid meshes of closed parts, named slots, plausible sizes, determinism."""

import functools

import numpy as np
import pytest

from wm.offline.furniture import KINDS, make_piece
from wm.offline.furniture.pictures import SUBJECTS, subject
from wm.offline.style.finish import SLOTS
from wm.offline.style.theme import style_of

THEMES = ("gothic", "scandinavian", "roman", "surreal", "japanese", "clockwork")


@functools.cache
def pieces(kind):
    return [
        make_piece(kind, style_of(theme), np.random.default_rng(k))
        for k, theme in enumerate(THEMES)
        if (k + list(KINDS).index(kind)) % len(THEMES) < 2
    ]


def test_there_is_something_to_choose_from():
    assert len(KINDS) >= 40


@pytest.mark.parametrize("kind", KINDS)
def test_pieces_are_sound(kind):
    for piece in pieces(kind):
        a, b, c = (piece.vertices[piece.faces[:, k]] for k in range(3))
        assert np.isfinite(piece.vertices).all() and piece.faces.min() >= 0 and piece.faces.max() < len(piece.vertices)
        assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-10
        assert set(piece.slots) <= set(SLOTS) and piece.face_slot.max() < len(piece.slots)
        assert piece.slot_colors.dtype == np.float32 and ((piece.slot_colors >= 0) & (piece.slot_colors <= 1)).all()
        assert 60 <= len(piece.faces) <= 9000 or kind in ("rug", "range hood", "open book")
        low, high = piece.vertices.min(0), piece.vertices.max(0)
        assert np.allclose(low, [-piece.size[0] / 2, -piece.size[1] / 2, 0]) and np.allclose(high - low, piece.size)
        for start, stop in zip(piece.part_start[:-1], piece.part_start[1:]):
            part = slice(start, stop)
            assert np.einsum("fi,fi->", a[part], np.cross(b[part], c[part])) > 0
            edges = piece.faces[part][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
            assert (np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)[1] == 2).all()


@pytest.mark.parametrize("kind", KINDS)
def test_sizes_are_plausible_and_things_have_room_on_top(kind):
    entry = KINDS[kind]
    for piece in pieces(kind):
        slack = np.array([0.15, 0.15, 0.32])  # cornices, splayed legs, taps, kettles
        assert (piece.size > np.array(entry.low) * 0.6 - 0.03).all() and (piece.size < np.array(entry.high) + slack).all()
        for top in piece.tops:
            assert 0 < top.z <= piece.size[2] + 1e-9 and top.x0 < top.x1 and top.y0 < top.y1
            assert max(-top.x0, top.x1) <= piece.size[0] / 2 and max(-top.y0, top.y1) <= piece.size[1] / 2


@pytest.mark.parametrize("kind", ["armchair", "bookshelf", "plant", "picture"])
def test_the_same_dice_give_the_same_piece_and_other_dice_another(kind):
    first, again, other = (make_piece(kind, style_of("gothic"), np.random.default_rng(k)) for k in (1, 1, 2))
    assert first.vertices.tobytes() == again.vertices.tobytes() and first.faces.tobytes() == again.faces.tobytes()
    assert first.vertices.tobytes() != other.vertices.tobytes()


@pytest.mark.parametrize("family", SUBJECTS)
def test_pictures_stay_on_their_canvas_and_differ(family):
    style = style_of(family if family != "surreal" else "a dream")
    drawn = [subject(style, np.random.default_rng(k), half=0.3, low=0.05, high=0.5, face=-0.004) for k in range(8)]
    for parts in drawn:
        points = np.concatenate([part.solid.vertices for part in parts])
        assert np.abs(points[:, 0]).max() <= 0.3 + 1e-9 and points[:, 2].min() >= 0.05 - 1e-9 and points[:, 2].max() <= 0.5 + 1e-9
        assert points[:, 1].min() > -0.02
    assert len({b"".join(part.solid.vertices.tobytes() for part in parts) for parts in drawn}) > 4


@pytest.mark.parametrize("kind", ["chair", "armchair", "sofa", "bed"])
def test_backs_are_at_the_back(kind):
    """The front faces -y: what is high lies behind what is low."""
    for piece in pieces(kind):
        tall = piece.vertices[:, 2] > 0.8 * piece.size[2]
        assert piece.vertices[tall, 1].mean() > 0.15 * piece.size[1]


def test_an_unknown_kind_is_named():
    with pytest.raises(KeyError, match="flying carpet"):
        make_piece("flying carpet", style_of("gothic"), np.random.default_rng(0))
