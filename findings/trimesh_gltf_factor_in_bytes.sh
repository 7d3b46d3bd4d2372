#!/usr/bin/env bash
# trimesh reads a glTF base colour factor into bytes, although glTF gives it as floats in linear light.
# Guess: a factor goes through load and export unchanged, or off by half a step of what a screen shows.
# Seen: it is rounded to 1/255 of linear light, where dark colours lie far apart: 0.002 comes back as 0.0039, which is 13/255 of sRGB
# where 6.6/255 was written. Who wants the colour that a file says reads the factor from the file's JSON.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
"$work/venv/bin/python" - <<'PY'
import io
import json
import struct

import trimesh

FACTOR = [0.002, 0.01, 0.05, 1.0]


def split(glb):
    length = struct.unpack("<I", glb[12:16])[0]
    return json.loads(glb[20 : 20 + length]), glb[20 + length :]


def joined(document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) + struct.pack("<I4s", len(text), b"JSON") + text + rest


def srgb(x):
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


box = trimesh.creation.box()
material = trimesh.visual.material.PBRMaterial(name="m", baseColorFactor=[0.5, 0.5, 0.5, 1.0])
box.visual = trimesh.visual.TextureVisuals(material=material)
document, rest = split(trimesh.Scene(box).export(file_type="glb"))
document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = FACTOR
scene = trimesh.load(io.BytesIO(joined(document, rest)), file_type="glb")
held = next(iter(scene.geometry.values())).visual.material.baseColorFactor
again = split(scene.export(file_type="glb"))[0]["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"]
worst = max(abs(srgb(a) - srgb(b)) for a, b in zip(FACTOR, again)) * 255
print("trimesh", trimesh.__version__)
print("guess: the factor comes back as it was written,", FACTOR)
print("seen: held as", held.tolist(), held.dtype, "and written as", [round(x, 4) for x in again])
print(f"worst: {worst:.1f}/255 of sRGB")
assert held.dtype == "uint8" and 5 < worst < 8, "this has changed"
PY
