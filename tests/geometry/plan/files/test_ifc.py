"""IFC buildings made by ifcopenshell.api."""

import numpy as np
import pytest

ifcopenshell = pytest.importorskip("ifcopenshell", reason="the extra `ifc` is not installed")

import ifcopenshell.api.aggregate as aggregate  # noqa: E402
import ifcopenshell.api.context as context  # noqa: E402
import ifcopenshell.api.feature as feature  # noqa: E402
import ifcopenshell.api.geometry as geometry  # noqa: E402
import ifcopenshell.api.project as project  # noqa: E402
import ifcopenshell.api.root as root  # noqa: E402
import ifcopenshell.api.spatial as spatial  # noqa: E402
import ifcopenshell.api.unit as unit  # noqa: E402

from wm.geometry.plan.loading import read_plan_file  # noqa: E402
from wm.geometry.plan.openings import portals  # noqa: E402
from wm.geometry.plan.records import PlanError  # noqa: E402


class Building:
    """A file in millimetres whose bodies are boxes, lowest corner and size in metres."""

    def __init__(self):
        self.model = project.create_file()
        self.top = root.create_entity(self.model, ifc_class="IfcProject", name="house")
        unit.assign_unit(self.model)
        model = context.add_context(self.model, context_type="Model")
        self.body = context.add_context(
            self.model, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=model
        )
        self.building = self.made("IfcBuilding", "house")
        aggregate.assign_object(self.model, products=[self.building], relating_object=self.top)

    def made(self, kind, name):
        return root.create_entity(self.model, ifc_class=kind, name=name)

    def storey(self, name, elevation):
        storey = self.made("IfcBuildingStorey", name)
        storey.Elevation = elevation * 1000
        aggregate.assign_object(self.model, products=[storey], relating_object=self.building)
        at = np.eye(4)
        at[2, 3] = elevation
        geometry.edit_object_placement(self.model, product=storey, matrix=at)
        return storey

    def box(self, kind, name, low, size):
        product = self.made(kind, name)
        at = np.eye(4)
        at[:3, 3] = low
        geometry.edit_object_placement(self.model, product=product, matrix=at)
        shape = geometry.add_wall_representation(self.model, context=self.body, length=size[0], height=size[2], thickness=size[1])
        geometry.assign_representation(self.model, product=product, representation=shape)
        return product


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    building = Building()
    model = building.model
    ground, upper = building.storey("Ground", 0.0), building.storey("Upper", 3.0)
    rooms = [building.box("IfcSpace", name, (x, 0, 0), (3.9, 3, 2.6)) for x, name in ((0, "Kitchen"), (4, "Bedroom"))]
    aggregate.assign_object(model, products=rooms, relating_object=ground)
    aggregate.assign_object(model, products=[building.box("IfcSpace", "Loft", (0, 0, 3), (7, 3, 2.4))], relating_object=upper)
    wall = building.box("IfcWall", "wall", (3.9, 0, 0), (0.1, 3, 2.6))
    opening = building.box("IfcOpeningElement", "hole", (3.85, 1, 0), (0.2, 0.9, 2.1))
    door, window = building.made("IfcDoor", "D1"), building.box("IfcWindow", "W1", (1, -0.1, 0.8), (1.5, 0.1, 1.2))
    feature.add_feature(model, feature=opening, element=wall)
    feature.add_filling(model, opening=opening, element=door)
    spatial.assign_container(model, products=[wall, door, window], relating_structure=ground)
    file = tmp_path_factory.mktemp("ifc") / "house.ifc"
    model.write(str(file))
    return file


def test_spaces_doors_and_windows_of_the_lowest_storey(path):
    reading = read_plan_file(path, repair=True)
    assert [room.name for room in reading.plan.rooms] == ["Kitchen", "Bedroom"]
    assert [room.ceiling_height for room in reading.plan.rooms] == pytest.approx([2.6, 2.6])
    door, window = sorted(portals(reading.plan), key=lambda portal: portal.kind)
    assert door.is_way and door.opening.segment.mean(axis=0) == pytest.approx([3.95, 1.45], abs=1e-5)
    assert (door.opening.width, door.opening.height) == pytest.approx((0.9, 2.1))
    assert (window.opening.width, window.opening.height, window.opening.sill_height) == pytest.approx((1.5, 1.2, 0.8))
    assert any("storey 'Ground' is read, of 'Ground', 'Upper'" in note for note in reading.notes)


@pytest.mark.parametrize("storey", ["Upper", "1"])
def test_another_storey(path, storey):
    assert [room.name for room in read_plan_file(path, storey=storey).plan.rooms] == ["Loft"]


def test_what_is_no_ifc_file_is_refused(tmp_path):
    (tmp_path / "text.ifc").write_text("hello")
    with pytest.raises(PlanError, match="not an IFC file"):
        read_plan_file(tmp_path / "text.ifc")
