"""Files of other programs: their headers, their elements and their layouts."""

import contextlib

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.ply.files import binary, columns, some
from wm.splat.ply import PlyError, load_ply, save_ply, splat_render_mode
from wm.splat.rasterizer.checks import check_gaussians
from wm.splat.rasterizer.harmonics import SH_C0


def read(tmp_path, content):
    path = tmp_path / "c.ply"
    path.write_bytes(content)
    return load_ply(path)


def same(a, b):
    jax.tree.map(np.testing.assert_array_equal, a, b)


def ascii_file(gaussians, before="", rows=""):
    table = columns(gaussians)
    lines = ["ply", "format ascii 1.0", *before.splitlines(), f"element vertex {len(gaussians.means)}"]
    lines += [f"property float {name}" for name in table] + ["end_header", *rows.splitlines()]
    lines += [" ".join(repr(float(x)) for x in row) for row in zip(*table.values())]
    return "\n".join(lines).encode() + b"\n"


@pytest.mark.parametrize("order", ["<", ">"])
def test_other_orders_types_byte_orders_and_extra_properties_are_read(tmp_path, order):
    gaussians = some(3, 1)
    table = {name: column.astype(np.float64) for name, column in reversed(columns(gaussians).items())}
    table |= {"segment": np.arange(3, dtype=np.uint8)}
    extra = {"face": {"flag": np.zeros(2, np.uint8)}}
    same(read(tmp_path, binary({"vertex": table, **extra}, order, ["by another"])), gaussians)
    same(read(tmp_path, binary({**extra, "vertex": table}, order)), gaussians)


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_lines_of_the_header_end_as_on_any_system_and_comments_end_nothing(tmp_path, end):
    gaussians = some(4, 1)
    comments = ["the next line is end_header", "", "Gr\u00fc\u00dfe"]
    gaussians.means[0, 0] = np.frombuffer(b"\n\n\n\n", "<f4")[0]  # rows that begin like the end of a line
    head, _, body = binary({"vertex": columns(gaussians)}, "<", comments).rpartition(b"end_header\n")
    head += b"obj_info num_cols 4\ncomment end_header\n"
    same(read(tmp_path, (head + b"end_header\n").replace(b"\n", end) + body), gaussians)


def test_lists_before_the_vertices_are_skipped_by_their_lengths(tmp_path):
    gaussians = some(2, 1)
    rows = b"\x03" + np.arange(3, dtype="<i4").tobytes() + b"\x07" + b"\x00" + b"\x09"
    before = b"element face 2\nproperty list uchar int vertex_indices\nproperty uchar flag\nelement vertex"
    raw = binary({"vertex": columns(gaussians)}).replace(b"element vertex", before, 1)
    same(read(tmp_path, raw.replace(b"end_header\n", b"end_header\n" + rows, 1)), gaussians)
    listed = "element face 2\nproperty list uchar int vertex_indices\nproperty uchar flag"
    same(read(tmp_path, ascii_file(gaussians, listed, "3 0 1 2 7\n0 9")), gaussians)


def test_ascii_is_read_to_the_last_digit(tmp_path):
    gaussians = some(5, 1)
    gaussians.log_scales[0, 0] = -np.inf
    same(read(tmp_path, ascii_file(gaussians)), gaussians)
    same(read(tmp_path, ascii_file(some(0, 1))), some(0, 1))


def test_discs_of_2dgs_have_a_third_axis_without_length(tmp_path):
    gaussians = some(3, 1)
    table = columns(gaussians)
    del table["scale_2"]
    content = binary({"vertex": table}, "<", ["SplatRenderMode: mip"])
    loaded = read(tmp_path, content)
    np.testing.assert_array_equal(loaded.log_scales, np.c_[gaussians.log_scales[:, :2], np.full(3, -np.inf)])
    assert splat_render_mode(tmp_path / "c.ply") == "2dgs"


@pytest.mark.parametrize(("kind", "white"), [(np.uint8, 255), (np.uint16, 65535), (np.float32, 1), (np.float64, 1)])
def test_red_green_blue_in_place_of_harmonics(tmp_path, kind, white):
    gaussians = some(2, 1)
    table = {name: column for name, column in columns(gaussians).items() if not name.startswith("f_dc")}
    colors = np.array([[0, 1, 0.2], [1, 0.6, 0]])
    table |= {name: (colors[:, i] * white).astype(kind) for i, name in enumerate(("red", "green", "blue"))}
    loaded = read(tmp_path, binary({"vertex": table}))
    np.testing.assert_allclose(0.5 + SH_C0 * loaded.sh[:, 0], colors, atol=1e-6)
    same(loaded.quats, gaussians.quats)


def test_a_point_cloud_becomes_round_gaussians_as_large_as_the_points_are_apart(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5) * 0.25, np.arange(5) * 0.25))
    table = {"x": x, "y": y, "z": 0 * x} | {name: np.full(25, 51, np.uint8) for name in ("red", "green", "blue")}
    loaded = read(tmp_path, binary({"vertex": table}))
    check_gaussians(loaded)
    inner = (x > 0) & (x < 1) & (y > 0) & (y < 1)
    np.testing.assert_allclose(np.exp(loaded.log_scales[inner]), 0.25, rtol=1e-5)
    np.testing.assert_allclose(0.5 + SH_C0 * loaded.sh, 0.2, atol=1e-6)
    assert len(read(tmp_path, binary({"vertex": {name: column[:1] for name, column in table.items()}})).means) == 1


@pytest.mark.parametrize(
    ("comments", "mode"),
    [
        ([], "default"),
        (["SplatRenderMode: mip"], "mip"),
        (["  SPLATRENDERMODE:  MIP "], "mip"),
        (["antialiased 1"], "mip"),
        (["antialiased 0"], "default"),
        (["SplatRenderMode: mip", "SplatRenderMode: default"], "default"),
        (["SplatRenderMode: 2dgs"], "2dgs"),
        (["trained antialiased 1 day"], "default"),
    ],
)
def test_how_gaussians_were_trained_is_read_from_comments(tmp_path, comments, mode):
    (tmp_path / "c.ply").write_bytes(binary({"vertex": columns(some(2, 1))}, "<", comments))
    assert splat_render_mode(tmp_path / "c.ply") == mode


def good():
    return binary({"vertex": {"nx": np.zeros(3, np.float32), **columns(some(3, 1))}})


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda raw: raw[:-1], "truncated in vertex"),
        (lambda raw: raw[:40], "end_header"),
        (lambda raw: b"", "does not start with 'ply'"),
        (lambda raw: b"obj" + raw, "does not start with 'ply'"),
        (lambda raw: raw.replace(b"end_header\n", b"comment end_header\n"), "no line that is 'end_header'"),
        (lambda raw: raw.replace(b"binary_little_endian", b"ascii"), "vertex"),
        (lambda raw: raw.replace(b"binary_little_endian", b"binary"), "line 2: unknown format 'binary'"),
        (lambda raw: raw.replace(b"format binary_little_endian 1.0\n", b""), "no format"),
        (lambda raw: raw.replace(b"element", b"format ascii 1.0\nelement"), "second format"),
        (lambda raw: raw.replace(b" opacity", b" opaquely"), "no property opacity"),
        (lambda raw: raw.replace(b"float rot_0", b"quad rot_0"), "unknown type quad"),
        (lambda raw: raw.replace(b"float rot_0", b"float rot_1"), "rot_1 of vertex is declared twice"),
        (lambda raw: raw.replace(b"property float rot_0", b"property float"), "a type and a name"),
        (lambda raw: raw.replace(b"property float rot_0", b"propertyfloat rot_0"), "no line of a PLY header"),
        (lambda raw: raw.replace(b"element vertex 3\n", b""), "line 3: a property before any element"),
        (lambda raw: raw.replace(b"element vertex 3", b"element vertex 3\nelement vertex 3"), "vertex is declared twice"),
        (lambda raw: raw.replace(b"vertex 3", b"vertex -3"), "not a count"),
        (lambda raw: raw.replace(b"vertex 3", b"vertex " + b"9" * 5000), "not a count"),
        (lambda raw: raw.replace(b"vertex 3", b"vertex " + b"9" * 18), "truncated"),
        (lambda raw: raw.replace(b"element vertex", b"element splat"), "no element vertex"),
        (lambda raw: raw.replace(b"float nx", b"float f_rest_0"), "1 f_rest"),
        (lambda raw: raw.replace(b"float nx", b"list uchar float nx"), "has the list nx"),
        (lambda raw: raw.replace(b"float nx", b"uint packed_position"), "without an element chunk"),
        (lambda raw: b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999999999\nend_header\nabc", "no property"),
        (lambda raw: ascii_file(some(2, 1))[:-40], "truncated in vertex"),
        (lambda raw: ascii_file(some(2, 1))[:-4] + b"foo\n", "foo"),
    ],
)
def test_refusals_name_the_file_and_the_fault(tmp_path, change, says):
    with pytest.raises(PlyError, match=says) as caught:
        read(tmp_path, change(good()))
    assert "c.ply" in str(caught.value)


@pytest.mark.parametrize("k", [4, 9, 16, 25])
def test_what_is_read_can_be_rendered(tmp_path, k):
    save_ply(tmp_path / "a.ply", some(2, k))
    try:
        loaded = load_ply(tmp_path / "a.ply")
    except PlyError as error:
        assert k == 25 and "0, 9, 24, 45" in str(error)
    else:
        check_gaussians(loaded)


@settings(max_examples=300)
@given(st.integers(0, 10**6), st.binary(min_size=1, max_size=6), st.integers(0, 6))
def test_a_damaged_file_is_read_or_is_a_ply_error(tmp_path_factory, place, put, drop):
    raw = good()
    place %= raw.index(b"end_header") + 20
    with contextlib.suppress(PlyError):
        read(tmp_path_factory.getbasetemp(), raw[:place] + put + raw[place + drop :])
