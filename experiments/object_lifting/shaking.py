"""Furniture as a worse reconstruction than ours might give it."""

import dataclasses

import numpy as np

from wm.geometry.placement.upright import transformed
from wm.types import SceneObject


def shaken(things: list[SceneObject], rng: np.random.Generator) -> list[SceneObject]:
    """Things shifted, turned, tilted and scaled, some missing, some twice."""
    out = []
    for thing in things:
        for _ in range(int(rng.choice([0, 1, 2], p=[0.1, 0.82, 0.08]))):
            quarter = np.pi / 2 * int(rng.integers(1, 4)) if rng.random() < 0.08 else 0.0
            turn = (
                _rotation(2, rng.normal() * 0.1 + quarter) @ _rotation(0, rng.normal() * 0.05) @ _rotation(1, rng.normal() * 0.05)
            )
            middle = thing.vertices.mean(axis=0)
            motion = np.eye(4)
            motion[:3, :3] = turn * float(np.exp(rng.normal() * 0.1))
            motion[:3, 3] = middle - motion[:3, :3] @ middle + rng.normal(size=3) * 0.1
            moved = transformed(thing, motion)
            frame = moved.T_world_object.copy()
            frame[:3, :3] = turn @ thing.T_world_object[:3, :3]
            out.append(dataclasses.replace(moved, T_world_object=frame))
    return out


def _rotation(axis: int, angle: float) -> np.ndarray:
    a, b = [k for k in range(3) if k != axis]
    turn = np.eye(3)
    turn[[a, a, b, b], [a, b, a, b]] = [np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)]
    return turn
