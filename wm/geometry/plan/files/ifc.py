"""Buildings of IFC: spaces are rooms, doors and windows lie where their openings do, by storey and in metres (extra `ifc`)."""

import importlib
from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.files.drawing import DrawnOpening, DrawnPlan, Outline, refused


def read_ifc(path: str) -> DrawnPlan:
    """The spaces, doors and windows of all storeys, lowest first.

    Raises:
      PlanError: ifcopenshell is missing, or the file cannot be read.
    """
    try:
        ifcopenshell: Any = importlib.import_module("ifcopenshell")
        geom: Any = importlib.import_module("ifcopenshell.geom")
        element, placement, unit = (
            importlib.import_module(f"ifcopenshell.util.{name}") for name in ("element", "placement", "unit")
        )
    except ImportError:
        raise refused(path, "IFC is read by ifcopenshell: pip install 'wm[ifc]'") from None
    try:
        model: Any = ifcopenshell.open(path)
    except Exception as error:
        raise refused(path, f"is not an IFC file that can be read: {error}") from None
    settings = geom.settings()
    settings.set("use-world-coords", True)

    def mesh(product: Any) -> tuple[np.ndarray, np.ndarray] | None:
        try:
            shape: Any = geom.create_shape(settings, product)
        except RuntimeError:
            return None
        return np.reshape(shape.geometry.verts, (-1, 3)), np.reshape(shape.geometry.faces, (-1, 3))

    def floor(product: Any) -> tuple[str, float]:
        one = element.get_container(product, ifc_class="IfcBuildingStorey") or element.get_aggregate(product)
        return (one.Name or f"#{one.id()}", float(placement.get_storey_elevation(one))) if one else ("no storey", 0.0)

    rooms: list[tuple[float, Outline]] = []
    notes, holes = [], []
    for space in model.by_type("IfcSpace"):
        found = mesh(space)
        name = space.LongName or space.Name or f"#{space.id()}"
        area = None if found is None else _footprint(*found)
        if found is None or area is None:
            notes.append(f"IfcSpace #{space.id()} {name!r} is left out: it has no body whose footprint is one polygon")
            continue
        storey, elevation = floor(space)
        rooms.append((elevation, Outline(name, area, storey, float(np.ptp(found[0][:, 2])))))
    scale = float(unit.calculate_unit_scale(model))
    bases = {outline.storey: base for base, outline in rooms}
    for product in (*model.by_type("IfcDoor"), *model.by_type("IfcWindow")):
        kind = "door" if product.is_a("IfcDoor") else "window"
        found = next(
            (m for one in (*(fill.RelatingOpeningElement for fill in product.FillsVoids), product) if (m := mesh(one))), None
        )
        storey = floor(product)[0]
        if found is None:
            notes.append(f"{product.is_a()} #{product.id()} is left out: neither it nor its opening has a body")
            continue
        base = bases.get(storey, 0.0) * scale
        low, high = float(found[0][:, 2].min()), float(found[0][:, 2].max())
        holes.append(
            DrawnOpening(
                kind,
                product.Name or f"#{product.id()}",
                found[0][:, :2],
                high - low,
                0.0 if kind == "door" else low - base,
                storey,
            )
        )
    return DrawnPlan(tuple(outline for _, outline in sorted(rooms, key=lambda row: row[0])), tuple(holes), tuple(notes))


def _footprint(points: np.ndarray, faces: np.ndarray) -> shapely.Polygon | None:
    """The union of the faces from above; None where that is not one polygon."""
    triangles = np.asarray(shapely.polygons(points[faces][:, :, :2]))
    area: Any = shapely.union_all(triangles[shapely.area(triangles) > 1e-9], grid_size=1e-6)
    area = shapely.simplify(area, 1e-5)
    return area if isinstance(area, shapely.Polygon) and not area.is_empty else None
