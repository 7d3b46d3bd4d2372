"""Plans of other programs' files, as the project's layout JSON in metres.

    drawing    DrawnPlan: outlines of rooms and shapes of openings, which every reader gives, and its layout
    procthor   houses of ProcTHOR and AI2-THOR, JSON
    infinigen  predefined floor plans of Infinigen Indoors, JSON
    polygons   polygons by kind of room as in ResPlan, as GeoJSON or WKT in JSON
    ifc        buildings, by ifcopenshell (extra `ifc`)
    dxf        drawings, by ezdxf (extra `dxf`)
    choosing   drawn_file, drawn_document: the reader that a file's suffix and content ask for

The libraries of the extras are imported only when such a file is read.
"""
