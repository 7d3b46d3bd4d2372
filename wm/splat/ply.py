"""Gaussians on disk, in the layout that every splat viewer opens.

One `vertex` element, binary little endian, float32 each: x y z, nx ny nz (zero), f_dc_0..2, f_rest_0..3(k-1)-1 channel-major (all
of red's higher coefficients, then green's, then blue's), opacity (the logit), scale_0..2 (logs), rot_0..3 (wxyz). Colour is
0.5 + C0 f_dc + ..., which is our `Gaussians.sh` as it stands.

Source: Kerbl et al. 2023, reference implementation, `GaussianModel.save_ply`.
"""

from pathlib import Path

import numpy as np

from wm.types import Gaussians

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_MAX_HEADER = 1 << 16
_SH_COUNTS = (1, 4, 9, 16, 25)


class PlyError(ValueError):
    """A file that is not a PLY of gaussians; the message names the file and what is wrong with it."""


def save_ply(path: str | Path, gaussians: Gaussians) -> None:
    """Write gaussians as a PLY file; equal gaussians give equal bytes.

    Args:
        path: where; an existing file is overwritten.
        gaussians: leaves on host or device, written as float32.
    """
    sh = np.asarray(gaussians.sh, np.float32)
    n, k = sh.shape[:2]
    rest = np.swapaxes(sh[:, 1:], 1, 2).reshape(n, 3 * (k - 1))
    columns = [
        np.asarray(gaussians.means), np.zeros((n, 3)), sh[:, 0], rest,
        np.asarray(gaussians.opacity_logits)[:, None], np.asarray(gaussians.log_scales), np.asarray(gaussians.quats),
    ]  # fmt: skip
    table = np.concatenate([column.astype("<f4") for column in columns], axis=1)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {n}"]
    header += [f"property float {name}" for name in _field_names(k)] + ["end_header\n"]
    Path(path).write_bytes("\n".join(header).encode("ascii") + table.tobytes())


def load_ply(path: str | Path) -> Gaussians:
    """Read gaussians (NumPy float32 leaves) from a PLY file, ours or any other trainer's.

    Properties may come in any order and of any scalar type, and there may be more of them; normals are not needed.

    Raises:
        PlyError: the file is no PLY, not binary little endian, shorter than its header says, or lacks a field.
    """
    path = Path(path)
    raw = path.read_bytes()
    count, dtype, start = _parse_header(path, raw)
    need = start + count * dtype.itemsize
    if len(raw) < need:
        raise PlyError(f"{path}: truncated: {count} vertices need {need} bytes, the file has {len(raw)}")
    table = np.frombuffer(raw, dtype, count, start)
    names = set(dtype.names or ())
    rest = len([name for name in names if name.startswith("f_rest_")])
    k = 1 + rest // 3
    if rest % 3 or k not in _SH_COUNTS:
        right = ", ".join(str(3 * (count - 1)) for count in _SH_COUNTS)
        raise PlyError(f"{path}: {rest} f_rest_* properties; one of {right} would be right")
    wanted = [name for name in _field_names(k) if name not in ("nx", "ny", "nz")]
    missing = [name for name in wanted if name not in names]
    if missing:
        raise PlyError(f"{path}: no property {', '.join(missing)}: not a file of gaussians")

    def columns(*fields: str) -> np.ndarray:
        return np.stack([table[field].astype(np.float32) for field in fields], axis=-1)

    dc = columns("f_dc_0", "f_dc_1", "f_dc_2")[:, None]
    higher = np.zeros((count, 3, k - 1), np.float32)
    for i in range(rest):
        higher[:, i // (k - 1), i % (k - 1)] = table[f"f_rest_{i}"]
    return Gaussians(
        means=columns("x", "y", "z"),
        quats=columns(*(f"rot_{i}" for i in range(4))),
        log_scales=columns(*(f"scale_{i}" for i in range(3))),
        opacity_logits=columns("opacity")[:, 0],
        sh=np.concatenate([dc, np.swapaxes(higher, 1, 2)], axis=1),
    )


def _field_names(k: int) -> list[str]:
    """The properties of one gaussian with k SH coefficients, in the order in which they are written."""
    names = ["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"]
    names += [f"f_rest_{i}" for i in range(3 * (k - 1))]
    return [*names, "opacity", *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]


def _parse_header(path: Path, raw: bytes) -> tuple[int, np.dtype, int]:
    """Number of vertices, the record type of one, and the offset of the first."""
    if not raw.startswith(b"ply"):
        raise PlyError(f"{path}: does not start with 'ply'")
    end = raw.find(b"end_header", 0, _MAX_HEADER)
    newline = raw.find(b"\n", end) if end >= 0 else -1
    if newline < 0:
        raise PlyError(f"{path}: no end_header line in the first {_MAX_HEADER} bytes")
    count, fields, elements, formats = -1, [], [], []
    for line in raw[:end].decode("ascii", "replace").splitlines()[1:]:
        match line.split():
            case ["format", kind, *_]:
                formats.append(kind)
            case ["element", name, size]:
                elements.append(name)
                if name == "vertex":
                    if not size.isdigit():
                        raise PlyError(f"{path}: element vertex {size}: not a count")
                    count = int(size)
            case ["property", kind, name] if elements and elements[-1] == "vertex":
                if kind not in _TYPES:
                    raise PlyError(f"{path}: property {name} has the unknown type {kind}")
                fields.append((name, "<" + _TYPES[kind]))
            case ["property", "list", *_] if elements and elements[-1] == "vertex":
                raise PlyError(f"{path}: a list property in element vertex: not a file of gaussians")
    if formats != ["binary_little_endian"]:
        raise PlyError(f"{path}: {'format ' + formats[0] if formats else 'no format'}; binary_little_endian would be right")
    if not elements or elements[0] != "vertex":
        raise PlyError(f"{path}: the first element must be vertex, found {elements[:1] or 'none'}")
    if len({name for name, _ in fields}) != len(fields):
        raise PlyError(f"{path}: a property is declared twice")
    return count, np.dtype(fields), newline + 1
