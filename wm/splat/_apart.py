"""A way to keep XLA from fusing across a border."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool


def apart(never: Bool[Array, ""], f: Callable, *args: Any) -> Any:
    """f(*args), compiled apart from what surrounds it.

    XLA on a CPU fuses cheap operations into each of their uses and repeats them there, so a chain of them with many results
    costs their product; it drops optimisation barriers before it fuses. A branch it cannot see through is a border that holds.

    Args:
        never: a condition that never holds, which XLA does not know; where it holds the result is zeros.
        f: a function of arrays.
    """
    nothing = jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), jax.eval_shape(f, *args))
    return jax.lax.cond(never, lambda *_: nothing, f, *args)
