"""Gaussians on disk: an exact round trip, others' files, and refusals that name what is wrong."""

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.splat.ply import PlyError, load_ply, save_ply
from wm.types import Gaussians


def some(n, k, seed=0):
    rng = np.random.default_rng(seed)
    draw = lambda *shape: rng.normal(size=shape).astype(np.float32)  # noqa: E731
    return Gaussians(means=draw(n, 3), quats=draw(n, 4), log_scales=draw(n, 3), opacity_logits=draw(n), sh=draw(n, k, 3))


@given(st.integers(0, 5), st.sampled_from([1, 4, 9, 16]), st.integers(0, 99))
def test_round_trip_is_exact_and_bytes_repeat(tmp_path_factory, n, k, seed):
    path, gaussians = tmp_path_factory.mktemp("ply") / "a.ply", some(n, k, seed)
    save_ply(path, gaussians)
    first = path.read_bytes()
    jax.tree.map(np.testing.assert_array_equal, load_ply(path), gaussians)
    save_ply(path, load_ply(path))
    assert path.read_bytes() == first


def test_fields_lie_as_in_the_inria_layout(tmp_path):
    gaussians = some(2, 4)
    save_ply(tmp_path / "a.ply", gaussians)
    header, body = (tmp_path / "a.ply").read_bytes().split(b"end_header\n")
    names = [line.split()[-1] for line in header.decode().splitlines() if line.startswith("property")]
    assert names[:9] == ["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"]
    assert names[9:18] == [f"f_rest_{i}" for i in range(9)]
    assert names[18:] == ["opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    rows = np.frombuffer(body, "<f4").reshape(2, -1)
    np.testing.assert_array_equal(rows[:, 9:12], gaussians.sh[:, 1:, 0])  # channel-major: all of red first
    np.testing.assert_array_equal(rows[:, 3:6], 0)


def test_other_orders_types_and_extra_properties_are_read(tmp_path):
    gaussians = some(3, 1)
    names = ["rot_3", "rot_2", "rot_1", "rot_0", "opacity", "extra", "z", "y", "x", "f_dc_2", "f_dc_1", "f_dc_0"]
    names += ["scale_0", "scale_1", "scale_2"]
    values = {"opacity": gaussians.opacity_logits, "extra": np.arange(3)}
    values |= {f"rot_{i}": gaussians.quats[:, i] for i in range(4)} | {c: gaussians.means[:, i] for i, c in enumerate("xyz")}
    values |= {f"scale_{i}": gaussians.log_scales[:, i] for i in range(3)}
    values |= {f"f_dc_{i}": gaussians.sh[:, 0, i] for i in range(3)}
    kinds = {name: ("uchar", "u1") if name == "extra" else ("double", "<f8") for name in names}
    table = np.zeros(3, [(name, kinds[name][1]) for name in names])
    for name in names:
        table[name] = values[name]
    lines = ["ply", "format binary_little_endian 1.0", "comment by another", "element vertex 3"]
    lines += [f"property {kinds[name][0]} {name}" for name in names]
    lines += ["element face 0", "property list uchar int vertex_indices"]
    path = tmp_path / "b.ply"
    path.write_bytes(("\n".join(lines) + "\nend_header\n").encode() + table.tobytes())
    jax.tree.map(np.testing.assert_array_equal, load_ply(path), gaussians)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda raw: raw[:-1], "truncated"),
        (lambda raw: raw[:40], "end_header"),
        (lambda raw: b"obj" + raw, "does not start with 'ply'"),
        (lambda raw: raw.replace(b"binary_little_endian", b"ascii"), "format ascii"),
        (lambda raw: raw.replace(b"format binary_little_endian 1.0\n", b""), "no format"),
        (lambda raw: raw.replace(b" opacity", b" opaquely"), "no property opacity"),
        (lambda raw: raw.replace(b"float rot_0", b"quad rot_0"), "unknown type quad"),
        (lambda raw: raw.replace(b"float rot_0", b"float rot_1"), "twice"),
        (lambda raw: raw.replace(b"vertex 3", b"vertex -3"), "not a count"),
        (lambda raw: raw.replace(b"element vertex", b"element splat"), "must be vertex"),
        (lambda raw: raw.replace(b"float nx", b"float f_rest_0"), "1 f_rest"),
    ],
)
def test_refusals_name_the_file_and_the_fault(tmp_path, change, says):
    path = tmp_path / "c.ply"
    save_ply(path, some(3, 1))
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(PlyError, match=says) as caught:
        load_ply(path)
    assert "c.ply" in str(caught.value)
