"""Real spherical harmonics up to degree 3, with the signs and order of the INRIA splat files."""

import numpy as np
from jaxtyping import Array, Float

SH_C0 = 0.28209479177387814
"""The constant one, 1 / (2 sqrt(pi)): colour = 0.5 + SH_C0 * sh_0."""


def harmonics(direction: Float[Array, "3 n"] | Float[np.ndarray, "3 n"] | None, degree: int) -> list:
    """The (degree + 1)^2 basis functions at unit directions.

    Args:
        direction: unit vectors, on the device or the host; may be None for degree 0, which has none.
        degree: 0 to 3.

    Returns:
        One entry per basis function: the constant, then arrays [n].

    Source: Sloan, "Efficient Spherical Harmonic Evaluation" (2013), with the Condon-Shortley signs used by Kerbl et al. (2023).
    Constants are sqrt(1 / 4 pi), sqrt(3 / 4 pi), ... to float64 digits.
    """
    basis = [SH_C0]
    if degree == 0 or direction is None:
        return basis
    x, y, z = direction
    basis += [-0.4886025119029199 * y, 0.4886025119029199 * z, -0.4886025119029199 * x]
    if degree == 1:
        return basis
    xx, yy, zz, xy, yz, xz = x * x, y * y, z * z, x * y, y * z, x * z
    basis += [
        1.0925484305920792 * xy,
        -1.0925484305920792 * yz,
        0.31539156525252005 * (2 * zz - xx - yy),
        -1.0925484305920792 * xz,
        0.5462742152960396 * (xx - yy),
    ]
    if degree == 2:
        return basis
    return [
        *basis,
        -0.5900435899266435 * y * (3 * xx - yy),
        2.890611442640554 * xy * z,
        -0.4570457994644658 * y * (4 * zz - xx - yy),
        0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
        -0.4570457994644658 * x * (4 * zz - xx - yy),
        1.445305721320277 * z * (xx - yy),
        -0.5900435899266435 * x * (xx - 3 * yy),
    ]
