"""`jax.jit` with vectors of 512 bits on CPUs that have them."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
from jax.core import Tracer

from wm.compiler_options import WIDE


def jit_wide(f: Callable, static_argnames: Sequence[str]) -> Callable:
    """`jax.jit(f)`, with WIDE where this is the outermost jit; inside a caller's jit, grad or vmap the caller's options hold."""
    inside = jax.jit(f, static_argnames=static_argnames)
    alone = jax.jit(f, static_argnames=static_argnames, compiler_options=WIDE)

    @functools.wraps(f)
    def call(*args: Any, **kwargs: Any) -> Any:
        # under jit even a constant is traced, which tells where the arguments alone do not
        traced = any(isinstance(leaf, Tracer) for leaf in jax.tree.leaves((args, kwargs, jnp.zeros(()))))
        return (inside if traced else alone)(*args, **kwargs)

    return call
