"""Which reader a file asks for, by its suffix, and for JSON by its content."""

import os
from pathlib import Path
from typing import Any

from shapely.errors import ShapelyError

from wm.geometry.plan.files.drawing import DrawnPlan, layout, refused
from wm.geometry.plan.files.dxf import read_dxf
from wm.geometry.plan.files.ifc import read_ifc
from wm.geometry.plan.files.infinigen import is_infinigen, read_infinigen
from wm.geometry.plan.files.polygons import is_polygons, read_polygons
from wm.geometry.plan.files.procthor import is_procthor, read_procthor

BINARY = {".ifc": read_ifc, ".dxf": read_dxf}
"""Readers of files that are no JSON."""
JSON = (
    ("ProcTHOR", is_procthor, read_procthor),
    ("Infinigen", is_infinigen, read_infinigen),
    ("polygons", is_polygons, read_polygons),
)


def drawn_file(path: str | os.PathLike[str], storey: str | None = None) -> tuple[dict[str, Any], tuple[str, ...]] | None:
    """The layout of an IFC or DXF file, and what is to be said of it; None for a file of another suffix.

    Raises:
      PlanError: it cannot be read, or a pickle is given.
    """
    suffix, source = Path(path).suffix.lower(), os.fspath(path)
    if suffix in (".pkl", ".pickle"):
        raise refused(
            source, "a pickle runs code when it is read; write its polygons as WKT or GeoJSON into a .json (docs/plans.md)"
        )
    if suffix not in BINARY:
        return None
    if not Path(path).is_file():
        raise refused(source, "cannot be read: there is no such file")
    return layout(BINARY[suffix](source), source, storey)


def drawn_document(document: Any, source: str, storey: str | None = None) -> tuple[Any, tuple[str, ...]]:
    """The layout of a decoded JSON document of another program, and what is to be said of it; a layout as it is.

    Raises:
      PlanError: it is of a format that is known, and cannot be read.
    """
    for name, fits, read in JSON:
        if not fits(document):
            continue
        try:
            drawing: DrawnPlan = read(document)
        except (KeyError, TypeError, ValueError, AttributeError, ShapelyError) as error:
            what = f"key {error} is missing" if isinstance(error, KeyError) else str(error)
            raise refused(source, f"cannot be read as {name} JSON: {what}") from None
        return layout(drawing, source, storey)
    return document, ()
