"""The side of a worker that runs in the model's own interpreter: Python 3.9 or later, the standard library, NumPy; nothing of wm.

    python serve.py SCRIPT FOLDER

SCRIPT is a Python file about one model, with three functions:

    describe(options) -> {"model": name, "version": text}    quick: no weights are loaded, nothing large is imported
    load(options) -> model                                    whatever `answer` needs; called once, before the first request
    answer(model, request, arrays) -> dict                    one request; called in turn

`options` and `request` hold JSON values, `arrays` NumPy arrays by name. The values of the answer may be JSON values, arrays and
bytes (the content of a file such as "mesh.glb"). {"refused": "why"} says that the model gave nothing that can be used.

Requests come as lines of JSON on the standard input, answers leave as lines of JSON on the standard output, arrays and bytes as
files in FOLDER. While the script runs, both streams are others: what libraries print goes to the standard error, and what they
read is empty. The end of the standard input means that whoever asked has closed the worker or was killed: FOLDER is removed and
the process ends, also in the middle of a request.

    {"id": 1, "call": "describe", "options": {...}}                      {"id": 1, "done": {"model": ..., "version": ...}}
    {"id": 2, "call": "load"}                                            {"id": 2, "done": {}}
    {"id": 3, "call": "answer", "request": {...}, "arrays": "3.npz"}     {"id": 3, "done": {"values": {...}, "files": [...]}}

instead of "done" also {"refused": "why"}, {"error": "ImportError: ..."}, and {"exhausted": "..."} where memory
ran out and a new process may succeed. File names are relative to FOLDER; "files" lists "arrays.npz" and the names of bytes.
"""

import importlib.util
import json
import os
import queue
import shutil
import signal
import sys
import threading
import traceback
from typing import Any

import numpy as np


def main(script, folder):
    """Serves requests until the standard input ends. Does not return."""
    own = os.path.dirname(os.path.realpath(__file__))
    sys.path[:] = [path for path in sys.path if os.path.realpath(path) != own]  # no module beside this one hides a package
    requests, answers = _take_streams()
    lines = queue.Queue()
    threading.Thread(target=_read, args=(requests, folder, lines), daemon=True).start()
    worker = _Worker(script, folder)
    while True:
        answers.write(worker.reply(json.loads(lines.get())))
        answers.flush()


def _take_streams():
    """(standard input, standard output), which are replaced by an empty input and by the standard error for all others."""
    requests, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")  # `dup` keeps them from child processes
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return requests, answers


def _read(requests, folder, lines):
    for line in requests:
        lines.put(line)
    shutil.rmtree(folder, ignore_errors=True)
    if os.getpgrp() == os.getpid():
        os.killpg(os.getpid(), signal.SIGKILL)  # child processes of the model end too
    os._exit(0)


class _Worker:
    """A script, and its model once it is loaded."""

    def __init__(self, script, folder):
        self.script, self.folder = script, folder
        self.module: Any = None
        self.options: Any = None
        self.model: Any = None

    def reply(self, asked):
        """The line that answers one line. No error of the script ends the process."""
        try:
            return _line({"id": asked["id"], **getattr(self, "_" + asked["call"])(asked)})
        except (Exception, SystemExit) as error:
            traceback.print_exc()
            kind = "exhausted" if isinstance(error, MemoryError) or "OutOfMemory" in type(error).__name__ else "error"
            text = traceback.format_exception_only(type(error), error)[-1].strip()
            return _line({"id": asked["id"], kind: text})

    def _describe(self, asked):
        self.options = asked["options"]
        sys.path.append(os.path.dirname(os.path.abspath(self.script)))  # last, so that no file beside it hides a package
        spec: Any = importlib.util.spec_from_file_location("worker_script", self.script)
        self.module = importlib.util.module_from_spec(spec)
        sys.modules["worker_script"] = self.module
        spec.loader.exec_module(self.module)
        return {"done": self.module.describe(self.options)}

    def _load(self, asked):
        self.model = self.module.load(self.options)
        return {"done": {}}

    def _answer(self, asked):
        with np.load(os.path.join(self.folder, asked["arrays"]), allow_pickle=False) as held:
            arrays = dict(held)
        result = self.module.answer(self.model, asked["request"], arrays)
        if "refused" in result:
            return {"refused": str(result["refused"])}
        return {"done": self._written(result)}

    def _written(self, result):
        """The arrays and bytes of an answer as files, the rest as it is."""
        arrays: Any = {name: value for name, value in result.items() if isinstance(value, np.ndarray) and value.ndim}
        content = {name: value for name, value in result.items() if isinstance(value, (bytes, bytearray))}
        for name, value in content.items():
            with open(os.path.join(self.folder, os.path.basename(name)), "wb") as file:
                file.write(value)
        files = [os.path.basename(name) for name in content]
        if arrays:
            np.savez(os.path.join(self.folder, "arrays.npz"), **arrays)
            files.append("arrays.npz")
        return {"values": {name: result[name] for name in result if name not in arrays and name not in content}, "files": files}


def _line(reply):
    return (json.dumps(reply, default=_plain) + "\n").encode()


def _plain(value):
    """NumPy's numbers as JSON values."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} of the answer is neither a JSON value nor an array nor bytes")


if __name__ == "__main__":
    main(*sys.argv[1:])
