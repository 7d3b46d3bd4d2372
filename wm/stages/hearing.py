"""What the selected backends make of the theme's words: one line, and `theme.json`."""

import dataclasses

from wm.artifacts.digests import json_text
from wm.stages.run_context import RunContext
from wm.synth.backends import HeardTheme
from wm.synth.registry import heard_theme

THEME = "theme.json"


def hear(run: RunContext) -> str:
    """Says which words of the theme are used and which are not known, and stores it; "" if no backend of the run can tell."""
    heard = heard_theme(run.config)
    if heard is None:
        return ""
    record = dataclasses.asdict(heard)
    key = run.key("theme", run.config.scene.theme, json_text(record))
    if not run.folder.has("theme", key):
        run.folder.save("theme", key, {THEME: json_text({"theme": run.config.scene.theme, **record})})
    return told(heard)


def told(heard: HeardTheme) -> str:
    """One line of prose."""
    parts = [f"used {', '.join(heard.used)}" if heard.used else "no word used"]
    parts += [f"without effect: {', '.join(heard.idle)}"] if heard.idle else []
    parts += [f"not known: {', '.join(heard.unknown)}"] if heard.unknown else []
    return "; ".join(parts)
