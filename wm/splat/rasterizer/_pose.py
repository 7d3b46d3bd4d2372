"""Points in camera axes, accurate to the last digits of float32 however far camera and points are from the origin.

    p = R m + t = R (m - c) + (R c + t),    m + R^T t = (m - c) + (c + R^T t),    c near the camera's centre, held constant

m - c is exact for points near the camera, and the brackets, three numbers each, are summed exactly: 24-bit factors split into
halves have exact products, and the errors of their sum are carried along (Ogita, Rump, Oishi, "Accurate sum and dot product",
2005, algorithm 4.4). A point costs three subtractions more than R m + t.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from wm.splat.xla.fusion_barrier import fusion_barrier


def to_camera(means: list, T: Float[Array, "4 4"]) -> list:
    """R m + t of points in rows [3]."""
    c = _near_centre(T)
    offset = _exact_affine(T[:3, :3], c, T[:3, 3])
    near = [means[k] - c[k] for k in range(3)]
    return [sum(T[i, k] * near[k] for k in range(3)) + offset[i] for i in range(3)]


def from_centre(means: list, T: Float[Array, "4 4"]) -> list:
    """m + R^T t of points in rows [3]: where they are as seen from the camera's centre, in world axes."""
    c = _near_centre(T)
    offset = _exact_affine(T[:3, :3].T, T[:3, 3], c)
    return [means[k] - c[k] + offset[k] for k in range(3)]


def _near_centre(T):
    # every use must see the same digits; without the barrier XLA computes them twice, with and without fused multiplication
    return fusion_barrier(T[0, 0] == -jnp.inf, _centre, jax.lax.stop_gradient(T), everywhere=True)


def _centre(T):
    return -jnp.matmul(T[:3, :3].T, T[:3, 3], precision="highest")


@jax.custom_jvp
def _exact_affine(A, x, b):
    """A x + b of [3, 3], [3] and [3], rounded once; its derivative is the plain one."""
    # without the barrier XLA may fuse this into the loop over points, and repeat it for each of them
    return fusion_barrier(A[0, 0] == -jnp.inf, _compensated, A, x, b, everywhere=True)


@_exact_affine.defjvp
def _exact_affine_jvp(primals, tangents):
    (A, x, _), (dA, dx, db) = primals, tangents
    return _exact_affine(*primals), (dA * x[None] + A * dx[None]).sum(1) + db


def _compensated(A, x, b):
    total, lost = b, jnp.zeros_like(b)
    for p in _halves(A):
        for q in _halves(x):
            for k in range(3):
                term = p[:, k] * q[k]
                sum_ = total + term
                back = sum_ - total
                lost = lost + ((total - (sum_ - back)) + (term - back))
                total = sum_
    return total + lost


def _halves(x):
    """Two float32 of 12 significant bits each whose sum is x."""
    bits = jax.lax.bitcast_convert_type(x, jnp.int32)
    high = jax.lax.bitcast_convert_type(bits & ~jnp.int32(0xFFF), jnp.float32)
    return high, x - high
