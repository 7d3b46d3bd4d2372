"""Elementwise arithmetic over gaussians, one block of them per iteration: on a CPU its temporaries then stay in the cache, and
blocks without a visible gaussian cost nothing."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp

BLOCK = 2048
"""Gaussians per block: a row of them is 8 KiB, and some hundred rows are in use at once."""


def in_blocks(
    f: Callable, alive: Callable, args: Sequence[Any], axes: Sequence[int], *, out_axis: int, into: Any = None, at: int = 0
) -> Any:
    """f(*args), block by block on a CPU, in one call elsewhere. Same bytes in every block that is alive.

    Args:
        f: a function of `args`, whose results for a gaussian depend on that gaussian alone.
        alive: a function of the same arguments: whether f has to be computed for a block. If not, a CPU leaves the results of the
            block as they were, and other devices compute f: callers must not depend on the difference.
        args: trees of arrays with gaussians along one axis; the first has n of them; of the others only the first n are read.
        axes: that axis in each of them, 0 or -1.
        out_axis: the axis of gaussians in the results, 0 or -1.
        into: the arrays into which the results are written; None: zeros for n gaussians.
        at: the index there of the first gaussian.
    """
    n = jax.tree.leaves(args[0])[0].shape[axes[0]]

    def take(first, size: int) -> list:
        return [jax.tree.map(functools.partial(_take, first, size, axis), arg) for arg, axis in zip(args, axes)]

    def put(first, results, into):
        return jax.tree.map(functools.partial(_put, first, out_axis), into, results)

    def at_once(into):
        return put(at, f(*take(0, n)), into)

    def by_blocks(into):
        def one(k, into):
            first = jnp.minimum(k * BLOCK, n - BLOCK)  # the last block begins early: some of its gaussians are done twice
            block, before = take(first, BLOCK), jax.tree.map(functools.partial(_take, at + first, BLOCK, out_axis), into)
            after = jax.lax.cond(alive(*block), lambda _, *block: f(*block), lambda before, *_: before, before, *block)
            return put(at + first, after, into)

        return jax.lax.fori_loop(0, -(-n // BLOCK), one, into)

    if into is None:
        into = jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), jax.eval_shape(lambda: f(*take(0, n))))
    return jax.lax.platform_dependent(into, cpu=by_blocks if n > BLOCK else at_once, default=at_once)


def _take(first, size: int, axis: int, x):
    return jax.lax.dynamic_slice_in_dim(x, first, size, axis % x.ndim)


def _put(first, axis: int, x, block):
    return jax.lax.dynamic_update_slice_in_dim(x, block, first, axis % x.ndim)
