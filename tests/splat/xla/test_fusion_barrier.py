"""Borders against fusion: a branch for a CPU, none or a barrier for other devices."""

import re

import jax
import jax.numpy as jnp
import pytest

from tests.splat.scenes import camera, cloud, to_float32
from wm.splat import project
from wm.splat.xla.fusion_barrier import fusion_barrier


def branches(traced, platform: str) -> int:
    """How many branches of a lowered function are chosen by what is computed, not by a constant."""
    text = traced.lower(lowering_platforms=(platform,)).as_text()
    chosen_by = re.findall(r'"stablehlo.case"\((%\w+)\)', text)
    return sum(bool(re.search(rf"{name} = stablehlo.convert", text)) for name in chosen_by)


@pytest.mark.parametrize("everywhere", [False, True])
@pytest.mark.parametrize("default", ["cpu", "gpu"])
def test_a_border_changes_no_result_and_is_where_it_is_needed(everywhere, default, monkeypatch):
    monkeypatch.setattr(jax, "default_backend", lambda: default)

    def twice(x):
        return fusion_barrier(x[0] == -jnp.inf, lambda x: {"sum": x + 1, "product": 2 * x}, x, everywhere=everywhere)

    traced = jax.jit(twice).trace(jnp.arange(3.0))
    assert {name: list(x) for name, x in jax.jit(twice)(jnp.arange(3.0)).items()} == {"sum": [1, 2, 3], "product": [0, 2, 4]}
    assert branches(traced, "cpu") == 1
    assert branches(traced, "cuda") == (default == "cpu")
    barrier = "optimization_barrier" in traced.lower(lowering_platforms=("cuda",)).as_text()
    assert barrier == (everywhere and default == "gpu")


def test_a_projection_and_its_derivative_ask_no_host_on_a_gpu(monkeypatch):
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    gaussians, view = to_float32(cloud()), to_float32(camera())

    def total(gaussians):
        return sum(x.sum() for x in jax.tree.leaves(project(gaussians, view)))

    traced = jax.jit(jax.grad(total)).trace(gaussians)
    assert branches(traced, "cpu") > 5 and branches(traced, "cuda") == 0
