"""DXF drawings made by ezdxf."""

import pytest

ezdxf = pytest.importorskip("ezdxf", reason="the extra `dxf` is not installed")

from wm.geometry.plan.loading import read_plan_file  # noqa: E402
from wm.geometry.plan.openings import portals  # noqa: E402
from wm.geometry.plan.records import PlanError  # noqa: E402


def drawn(path, units=4):
    """Two rooms in millimetres, 100 apart, with a door block that has a swing, and a window line."""
    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    space = document.modelspace()
    for x0, x1, name in ((0, 3900, "Kitchen"), (4000, 8000, "Bedroom")):
        space.add_lwpolyline([(x0, 0), (x1, 0), (x1, 3000), (x0, 3000)], close=True, dxfattribs={"layer": "A-ROOMS"})
        space.add_text(name, dxfattribs={"insert": (x0 + 1000, 1500), "height": 200})
    block = document.blocks.new("DOOR-90")
    block.add_line((0, 0), (900, 0))
    block.add_arc((0, 0), 900, 0, 90)
    space.add_blockref("DOOR-90", (3950, 1000), dxfattribs={"rotation": 90})
    space.add_line((1000, 0), (2500, 0), dxfattribs={"layer": "A-WINDOWS"})
    space.add_lwpolyline([(0, 0), (1, 1)], dxfattribs={"layer": "A-ROOMS"})
    document.saveas(path)
    return path


def test_rooms_are_named_and_openings_lie_on_their_walls(tmp_path):
    reading = read_plan_file(drawn(tmp_path / "house.dxf"), repair=True)
    assert [room.name for room in reading.plan.rooms] == ["Kitchen", "Bedroom"]
    door, window = sorted(portals(reading.plan), key=lambda portal: portal.kind)
    assert door.is_way and door.opening.segment.mean(axis=0) == pytest.approx([3.95, 1.45], abs=1e-6)
    assert window.kind == "window" and window.opening.width == pytest.approx(1.5)
    assert any("is no closed simple polygon" in note for note in reading.notes)


def test_a_drawing_without_a_unit_or_rooms_or_that_is_none_is_refused(tmp_path):
    with pytest.raises(PlanError, match="INSUNITS is 0"):
        read_plan_file(drawn(tmp_path / "house.dxf", units=0))
    document = ezdxf.new()
    document.modelspace().add_line((0, 0), (1, 1), dxfattribs={"layer": "WALLS"})
    document.saveas(tmp_path / "walls.dxf")
    with pytest.raises(PlanError, match="its layers are WALLS"):
        read_plan_file(tmp_path / "walls.dxf")
    (tmp_path / "text.dxf").write_text("hello")
    with pytest.raises(PlanError, match="not a DXF file"):
        read_plan_file(tmp_path / "text.dxf")
