"""What other systems start from: views, layouts and panoramas that agree with the house they are of."""

import io
import json

import numpy as np
import pytest
import shapely
from PIL import Image

from tests.compare.test_consistency import room
from wm.compare.__main__ import main
from wm.compare.inputs.classes import FLOOR, OTHER, class_of
from wm.compare.inputs.image import write_image
from wm.compare.inputs.layout import box_of, room_layout
from wm.compare.inputs.panorama import directions, panorama
from wm.compare.inputs.spatialgen import FOV, SIDE, VIEWS, circle, millimetres, write_spatialgen
from wm.compare.painted_mesh import see
from wm.geometry import cast, cast_rays
from wm.geometry.cameras.air import free
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.rays.pinhole import camera_center, camera_rotation


def test_views_stand_on_a_circle_of_free_places_and_look_outwards(finished):
    cameras = circle(finished, 0)
    eyes = np.array([camera_center(camera) for camera in cameras])
    looks = np.array([camera_rotation(camera)[2] for camera in cameras])
    middle = eyes.mean(axis=0)
    radius = np.linalg.norm(eyes - middle, axis=1)
    assert len(cameras) == VIEWS and np.allclose(radius, radius[0], atol=1e-9)
    assert free(finished.rays, eyes, 0.15).all()
    np.testing.assert_allclose(np.sum(looks[0] * looks[1]), np.cos(2 * np.pi / VIEWS), atol=1e-9)
    assert (np.sum((eyes - middle) * looks, axis=1) >= -1e-9).all()
    assert np.degrees(2 * np.arctan(SIDE / 2 / cameras[0].focal[0])) == pytest.approx(FOV)


def test_the_folder_is_what_spatialgens_loader_reads(finished, tmp_path, monkeypatch):
    monkeypatch.setattr("wm.compare.inputs.spatialgen.SIDE", 64)
    folders = write_spatialgen(finished, tmp_path)
    assert (tmp_path / "test_split.txt").read_text().split() == finished.rooms == [folder.name for folder in folders]
    captions = [json.loads(line) for line in (tmp_path / "captions.jsonl").read_text().splitlines()]
    assert [row["room_uid"] for row in captions] == finished.rooms and captions[0]["prompt"] == finished.theme
    meta = json.loads((folders[0] / "cameras.json").read_text())
    assert list(meta["cameras"]) == [f"{k:02d}" for k in range(VIEWS)]
    assert np.reshape(meta["intrinsic"], (3, 3))[0, 0] == pytest.approx(32)
    for kind, suffix in (
        ("rgb", "jpg"),
        ("semantic", "jpg"),
        ("layout_semantic", "jpg"),
        ("depth", "png"),
        ("layout_depth", "png"),
    ):
        with Image.open(folders[0] / kind / f"frame_03.{suffix}") as image:
            assert image.size == (64, 64) and (suffix == "jpg" or image.mode.startswith("I"))
    camera = circle(finished, 0)[3]
    np.testing.assert_allclose(np.reshape(meta["cameras"]["03"], (4, 4))[:3, 3], camera_center(camera), atol=1e-6)
    with Image.open(folders[0] / "depth" / "frame_03.png") as image:
        np.testing.assert_allclose(np.asarray(image) / 1000, cast(finished.rays, camera).depth, atol=6e-4)


def test_a_layout_is_closed_and_has_a_box_for_each_thing(finished):
    layout = room_layout(finished, 0)
    things = [thing for thing in finished.objects if thing.room == 0]
    assert len(layout.boxes) == len(things)
    middle = shapely.get_coordinates(interior_polygon(finished.plan, 0).representative_point())[0]
    random = np.random.default_rng(0).normal(size=(500, 3))
    assert cast_rays(layout.rays, np.tile([*middle, 2.2], (500, 1)), random).hit.all()
    below = cast_rays(layout.rays, np.array([[*middle, 2.2]]), np.array([[0.0, 0, -1]])).face
    assert tuple(layout.face_color[below[0]]) in {FLOOR, *(box.color for box in layout.boxes)}
    inside = [box.T_world_box[:3, 3] for box in layout.boxes[:1]]
    assert len(room_layout(finished, 0, around=np.array(inside)).boxes) < len(layout.boxes)


def test_a_box_holds_its_thing_and_no_more(finished):
    for thing in finished.objects:
        box = box_of(thing)
        local = (thing.vertices - box.T_world_box[:3, 3]) @ box.T_world_box[:3, :3]
        np.testing.assert_allclose(np.ptp(local, axis=0), np.where(box.size > 0.01, box.size, np.ptp(local, axis=0)), atol=1e-6)
        np.testing.assert_allclose(box.T_world_box[:3, :3] @ box.T_world_box[:3, :3].T, np.eye(3), atol=1e-9)


@pytest.mark.parametrize(
    ("label", "name"), [("table lamp", "street lamp"), ("Curtains", "curtain"), ("armchair", "armchair"), ("bed", "bed")]
)
def test_things_have_spatialgens_classes(label, name):
    assert class_of(label)[0] == name
    assert class_of("orrery") == OTHER


def test_a_panorama_tells_colours_and_distances_of_every_direction():
    mesh = room()
    eye = np.array([0.3, -0.4, 1.4])
    rgb, distance = panorama(lambda camera: see(mesh, camera), eye, 64)
    rays = directions(64)
    hits = cast_rays(mesh.rays, np.broadcast_to(eye, (64 * 128, 3)).copy(), rays.reshape(-1, 3))
    np.testing.assert_allclose(distance.reshape(-1), hits.t, rtol=0.06)
    assert np.median(np.abs(distance.reshape(-1) - hits.t) / hits.t) < 1e-3
    assert rgb.shape == (64, 128, 3)
    np.testing.assert_allclose(rays[32, 64], [1, 0, 0], atol=0.05)
    assert rays[32, 80, 1] < 0 and rays[0, 0, 2] > 0.99  # right is clockwise; the first row is up


def test_depths_of_sixteen_bits_saturate():
    with Image.open(io.BytesIO(millimetres(np.array([[0.0, 1.2345, 70.0]])))) as image:
        assert np.asarray(image).tolist() == [[0, 1234, 65535]] or np.asarray(image).tolist() == [[0, 1235, 65535]]


def test_an_image_of_each_room_and_the_prompt(finished, tmp_path):
    pictures = write_image(finished, tmp_path)
    assert [path.stem for path in pictures] == finished.rooms
    assert (tmp_path / "prompt.txt").read_text().strip() == finished.theme


@pytest.mark.parametrize("words", [["--help"], ["inputs", "--help"]])
def test_help_says_how(words, capsys):
    assert main(words) == 0
    assert "inputs RUN" in capsys.readouterr().out


@pytest.mark.parametrize("words", [["inputs"], ["inputs", "a", "b"], ["inputs", "a", "to=[video]"], ["inputs", "a", "size=3"]])
def test_wrong_words_are_one_line(words, capsys):
    assert main(words) == 2
    told = capsys.readouterr().err
    assert "would be right" in told and told.count("\n") == 1
