"""What a run shows: the report, the fly-through, and the table that compares runs.

    page        `report.html`: what it shows (`ReportData`), and the page as text
    templating  the Jinja environment of the templates in `templates/`
    floorplan   the floor plan as an SVG
    plots       error against time, and time and memory of the stages, as SVG
    pictures    thumbnails as data URIs, and depth error as colour
    video       the fly-through, encoded as H.264
    paper       the paper's figures by the keys of `wm.metric_table`
    sweep       the table of several runs: `python -m wm.report.sweep FOLDER`
    labels      where each text on the floor plan stands, so that no two overlap
"""

from wm.report.page import ReportData as ReportData
from wm.report.page import SheetRow as SheetRow
from wm.report.page import render_page as render_page
from wm.report.video import write_video as write_video
