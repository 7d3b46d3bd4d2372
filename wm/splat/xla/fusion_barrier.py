"""`fusion_barrier`: a function call across whose border XLA does not fuse."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool


def fusion_barrier(never: Bool[Array, ""], f: Callable, *args: Any, everywhere: bool = False) -> Any:
    """f(*args), with a barrier between its operations and all others, through which XLA on a CPU fuses nothing.

    XLA fuses cheap operations into each of their uses and repeats them there, so on a CPU the cost of a chain of operations, each
    used several times, is a product. XLA drops `jax.lax.optimization_barrier` before it fuses for a CPU, but does not fuse into
    or out of a conditional branch whose condition it cannot fold. On a GPU it is the other way round: XLA moves code into
    branches, and the host waits for their conditions.

    Args:
        never: a condition that never holds, but that XLA cannot fold; if it held, the result would be zeros.
        f: a function of arrays.
        everywhere: put a barrier on every device, for results of which every use must see the same digits.
    """
    if jax.default_backend() == "cpu":
        return _branch(never, f, *args)

    def elsewhere(_, *args: Any) -> Any:
        return jax.lax.optimization_barrier(f(*jax.lax.optimization_barrier(args))) if everywhere else f(*args)

    return jax.lax.platform_dependent(never, *args, cpu=lambda never, *args: _branch(never, f, *args), default=elsewhere)


def _branch(never: Bool[Array, ""], f: Callable, *args: Any) -> Any:
    nothing = jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), jax.eval_shape(f, *args))
    return jax.lax.cond(never, lambda *_: nothing, f, *args)
