"""Arithmetic that takes each gaussian alone, a block of them at a time: on a CPU its temporaries then stay in the cache, and
blocks in which no gaussian is seen cost nothing."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp

BLOCK = 2048
"""Gaussians in a block: a row of them is 8 KiB, and some hundred rows are at work at once."""


def in_blocks(
    f: Callable, alive: Callable, args: Sequence[Any], axes: Sequence[int], *, out_axis: int, into: Any = None, at: int = 0
) -> Any:
    """f(*args), block by block on a CPU, at once elsewhere. Same bytes wherever there is something to do.

    Args:
        f: what is done; its results for a gaussian depend on that gaussian alone.
        alive: with the same arguments: whether there is anything to do for a block. If not, a CPU leaves its results as they were
            and elsewhere they are those of f: nobody may read a difference.
        args: trees of arrays with gaussians along one axis; the first has n of them, the others may have more: not read.
        axes: that axis of each of them, 0 or -1.
        out_axis: the same of the results.
        into: what the results are written into; None is zeros for n gaussians.
        at: the place there of the first of them.
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
