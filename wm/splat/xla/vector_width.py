"""Compiler options for vectors of 512 bits on CPUs that have them; by default XLA uses at most 256."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
from jax.core import Tracer

WIDE = {"xla_cpu_prefer_vector_width": "512"}
"""Compiler options for `jax.jit` of anything that rasterizes on a CPU; JAX accepts them at the outermost jit only. They are a
preference: LLVM uses what the processor has, and compilers for other devices ignore it."""


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
