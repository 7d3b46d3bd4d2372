"""Vectors of 512 bits, where the CPU has them: XLA on its own stops at 256."""

import functools
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
from jax.core import Tracer

WIDE = {"xla_cpu_prefer_vector_width": "512"}
"""Compiler options for `jax.jit` of anything that rasterizes on a CPU; JAX takes them only where nothing is jitted around.
They are a preference: LLVM takes what the processor has, and compilers of other devices do not read it."""


def jit_wide(f: Callable, static_argnames: Sequence[str]) -> Callable:
    """`jax.jit(f)`, with WIDE where the call is compiled on its own; inside a caller's jit, grad or vmap the caller chooses."""
    inside = jax.jit(f, static_argnames=static_argnames)
    alone = jax.jit(f, static_argnames=static_argnames, compiler_options=WIDE)

    @functools.wraps(f)
    def call(*args: Any, **kwargs: Any) -> Any:
        # under jit even a constant is traced, which tells where the arguments alone do not
        traced = any(isinstance(leaf, Tracer) for leaf in jax.tree.leaves((args, kwargs, jnp.zeros(()))))
        return (inside if traced else alone)(*args, **kwargs)

    return call
