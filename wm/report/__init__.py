"""What a run shows of itself: `report.html` and the fly-through."""

from wm.report.page import ReportData as ReportData
from wm.report.page import SheetRow as SheetRow
from wm.report.page import render_page as render_page
from wm.report.video import write_video as write_video
