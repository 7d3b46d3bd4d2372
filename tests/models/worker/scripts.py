"""Small models that workers of tests serve: real processes of this interpreter, which import NumPy and nothing of wm."""

import pathlib
import sys
import textwrap

SUM = '''
    """Adds up an array."""
    import os
    import numpy as np

    def describe(options):
        return {"model": "sum", "version": "1.0"}

    def load(options):
        return options.get("offset", 0)

    def answer(model, request, arrays):
        return {
            "total": arrays["x"].sum() + model, "said": request["say"], "doubled": 2 * arrays["x"], "note.bin": b"\\x00\\x01",
            "pid": os.getpid(), "alone": "wm" not in __import__("sys").modules,
        }
'''


def script(folder: pathlib.Path, text: str, name: str = "model.py") -> pathlib.Path:
    """A script with this text."""
    path = folder / name
    path.write_text(textwrap.dedent(text))
    return path


def changed(old: str, new: str, text: str = SUM) -> str:
    """A text with one part replaced, which must be in it."""
    assert old in text
    return text.replace(old, new)


PYTHON = sys.executable
