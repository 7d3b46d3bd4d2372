"""A way to keep XLA from fusing across a border."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool


def apart(never: Bool[Array, ""], f: Callable, *args: Any, everywhere: bool = False) -> Any:
    """f(*args), compiled apart from what surrounds it on a CPU.

    XLA fuses cheap operations into each of their uses and repeats them there, so on a CPU a chain of them with many results costs
    their product. It drops optimisation barriers before it fuses for a CPU; a branch that it cannot see through is a border that
    holds. For a GPU it is the other way round: there code moves into branches, for whose conditions the host waits besides.

    Args:
        never: a condition that never holds, which XLA does not know; where it holds the result is zeros.
        f: a function of arrays.
        everywhere: keep a border on every device, for results of which every use must see the same digits.
    """
    if jax.default_backend() == "cpu":
        return _branch(never, f, *args)

    def elsewhere(_, *args: Any) -> Any:
        return jax.lax.optimization_barrier(f(*jax.lax.optimization_barrier(args))) if everywhere else f(*args)

    return jax.lax.platform_dependent(never, *args, cpu=lambda never, *args: _branch(never, f, *args), default=elsewhere)


def _branch(never: Bool[Array, ""], f: Callable, *args: Any) -> Any:
    nothing = jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), jax.eval_shape(f, *args))
    return jax.lax.cond(never, lambda *_: nothing, f, *args)
