"""Plans of other programs in JSON: two rooms of 4 x 3 m side by side, a door between them and a window outside."""

import json
import warnings

import pytest
import shapely

from wm.geometry import load_plan
from wm.geometry.plan.loading import read_plan_file
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import PlanError


def wall(room, name, x0, z0, x1, z1, **more):
    points = [{"x": x, "y": y, "z": z} for y in (0, 2.6) for x, z in ((x0, z0), (x1, z1))]
    return {"id": name, "roomId": room, "polygon": points, **more}


def hole(name, on, start, end, low, high):
    return {"id": name, "wall0": on, "holePolygon": [{"x": start, "y": low, "z": 0}, {"x": end, "y": high, "z": 0}]}


def floor(x0, x1):
    return [{"x": x, "y": 0, "z": z} for x, z in ((x0, 0), (x0, 3), (x1, 3), (x1, 0))]


PROCTHOR = {
    "rooms": [
        {"id": "room|2", "roomType": "Kitchen", "floorPolygon": floor(0, 4)},
        {"id": "room|3", "roomType": "Bedroom", "floorPolygon": floor(4, 8)},
    ],
    "walls": [wall("room|2", "shared", 4, 3, 4, 0), wall("room|2", "south", 0, 0, 4, 0)],
    "doors": [hole("door|2|3", "shared", 0.5, 1.5, 0, 2.1)],
    "windows": [hole("window|2", "south", 1, 2.5, 0.9, 2.0)],
    "objects": [{"id": "chair"}],
}
INFINIGEN = {
    "rooms": {
        "kitchen_0/0": {"operation": "shapely.box", "args": [0, 0, 4, 3]},
        "bedroom_0/0": {"operation": "shapely.Polygon", "args": [[[4, 0], [8, 0], [8, 3], [4, 3]]]},
        "attic_1/0": {"operation": "shapely.box", "kwargs": {"xmin": 0, "ymin": 0, "xmax": 8, "ymax": 3}},
    },
    "doors": {"d0": {"operation": "shapely.box", "args": [3.9, 1.5, 4.1, 2.5]}},
    "windows": {"w0": {"operation": "shapely.LineString", "args": [[[1, 0], [2.5, 0]]]}},
}
POLYGONS = {
    "kitchen": json.loads(shapely.to_geojson(shapely.box(0, 0, 390, 300))),
    "bedroom": "MULTIPOLYGON (((410 0, 800 0, 800 300, 410 300, 410 0)))",
    "door": "POLYGON ((390 150, 410 150, 410 250, 390 250, 390 150))",
    "window": "POLYGON ((100 -10, 250 -10, 250 0, 100 0, 100 -10))",
    "meters_per_unit": 0.01,
}


def written(folder, document):
    path = folder / "house.json"
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize("document", [PROCTHOR, INFINIGEN, POLYGONS], ids=["procthor", "infinigen", "polygons"])
def test_rooms_and_openings_lie_where_the_file_says(tmp_path, document):
    plan = read_plan_file(written(tmp_path, document), repair=True).plan
    assert [room.id for room in plan.rooms] == ["kitchen", "bedroom"]
    for room, low in zip(plan.rooms, (0, 4)):
        assert shapely.Polygon(room.polygon).symmetric_difference(shapely.box(low, 0, low + 4, 3)).area < 0.01
    door, window = sorted(portals(plan), key=lambda portal: portal.kind)
    assert (door.kind, window.kind) == ("door", "window")
    assert door.wall.room != door.behind.room and door.is_way
    assert window.behind is None
    assert door.opening.segment.mean(axis=0) == pytest.approx([4, 2], abs=1e-6) and door.opening.width == pytest.approx(1.0)
    assert window.opening.segment.mean(axis=0) == pytest.approx([1.75, 0], abs=1e-6) and window.opening.width == pytest.approx(
        1.5
    )


def test_an_empty_wall_of_procthor_is_one_passage(tmp_path):
    walls = [wall("room|2", "a", 4, 3, 4, 0, empty=True), wall("room|3", "b", 4, 0, 4, 3, empty=True)]
    plan = read_plan_file(written(tmp_path, {**PROCTHOR, "walls": walls, "doors": [], "windows": []}), repair=True).plan
    assert [portal.kind for portal in portals(plan)] == ["passage"]


def test_what_is_left_out_is_said(tmp_path):
    notes = read_plan_file(written(tmp_path, PROCTHOR)).notes
    assert "2 rooms and 2 of 2 openings are read" in notes and any("objects are left out" in note for note in notes)


def test_a_storey_is_chosen_by_name_or_number_and_others_are_refused(tmp_path):
    path = written(tmp_path, INFINIGEN)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert [room.id for room in load_plan(path, storey="1").rooms] == ["attic"]
    with pytest.raises(PlanError, match=r"plan\.storey is one of 0, 1"):
        read_plan_file(path, storey="cellar")


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"rooms": {"a_0/0": {"operation": "os.system", "args": ["true"]}}}, "'os.system' is not read; choices: box"),
        ({"rooms": [{"id": "room|1", "floorPolygon": [{"x": 0}]}]}, "key 'z' is missing"),
        ({"bedroom": "POLYGON ((0 0, 400 0, 400 400, 0 0))"}, "say 'meters_per_unit'"),
        ({"bedroom": "nonsense"}, "cannot be read as polygons JSON"),
    ],
)
def test_what_cannot_be_read_is_one_clear_error(tmp_path, document, message):
    with pytest.raises(PlanError, match=message):
        read_plan_file(written(tmp_path, document))


def test_a_pickle_is_not_read(tmp_path):
    with pytest.raises(PlanError, match="runs code"):
        read_plan_file(tmp_path / "ResPlan.pkl")
