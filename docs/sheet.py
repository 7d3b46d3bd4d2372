"""Held-out splat renders of runs as one picture: python docs/sheet.py OUT.jpg COLUMNS RUN_FOLDER/heldout/ROOM/VIEW.png ...

The README's pictures were made by it.
"""

import sys
from pathlib import Path

from PIL import Image

WIDTH = 458


def main() -> None:
    out, columns, *files = sys.argv[1:]
    views = [Image.open(file).convert("RGB") for file in files]
    height = round(WIDTH * views[0].height / views[0].width)
    rows = -(-len(views) // int(columns))
    sheet = Image.new("RGB", (WIDTH * int(columns), height * rows))
    for k, view in enumerate(views):
        row, column = divmod(k, int(columns))
        sheet.paste(view.resize((WIDTH, height), Image.Resampling.LANCZOS), (column * WIDTH, row * height))
    sheet.save(Path(out), quality=88)


if __name__ == "__main__":
    main()
