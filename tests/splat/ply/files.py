"""Gaussians drawn at random and PLY files made by hand."""

import numpy as np

from wm.types import Gaussians


def some(n, k, seed=0):
    """Gaussians with unit quaternions."""
    rng = np.random.default_rng(seed)
    draw = lambda *shape: rng.normal(size=shape).astype(np.float32)  # noqa: E731
    quats = draw(n, 4)
    quats /= np.linalg.norm(quats, axis=1, keepdims=True)
    return Gaussians(means=draw(n, 3), quats=quats, log_scales=draw(n, 3), opacity_logits=draw(n), sh=draw(n, k, 3))


def columns(gaussians):
    """The INRIA columns of gaussians of degree 0 by name."""
    named = {"x": gaussians.means[:, 0], "y": gaussians.means[:, 1], "z": gaussians.means[:, 2]}
    named |= {f"f_dc_{i}": gaussians.sh[:, 0, i] for i in range(3)} | {"opacity": gaussians.opacity_logits}
    named |= {f"scale_{i}": gaussians.log_scales[:, i] for i in range(3)}
    return named | {f"rot_{i}": gaussians.quats[:, i] for i in range(4)}


def binary(tables, order="<", comments=()):
    """The bytes of a binary file of elements: {element: {property: column}}; whole numbers and floats keep their types."""
    kinds = {"f4": "float", "f8": "double", "u1": "uchar", "u2": "ushort", "u4": "uint"}
    lines = ["ply", f"format binary_{'little' if order == '<' else 'big'}_endian 1.0", *(f"comment {c}" for c in comments)]
    body = b""
    for name, table in tables.items():
        lines.append(f"element {name} {len(next(iter(table.values())))}")
        lines += [f"property {kinds[column.dtype.str[1:]]} {field}" for field, column in table.items()]
        fields = [(field, order + column.dtype.str[1:]) for field, column in table.items()]
        rows = np.zeros(len(next(iter(table.values()))), fields)
        for field, column in table.items():
            rows[field] = column
        body += rows.tobytes()
    return ("\n".join([*lines, "end_header\n"])).encode() + body
