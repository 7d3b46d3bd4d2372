"""Shows the page of a study and stores what participants answer: python serve.py [--port 8765] [--host 0.0.0.0].

It needs Python's standard library only. It shows the folder `page` beside this file, and writes each participant's answers to the
folder `answers`, which it never shows. It logs no addresses.
"""

import argparse
import collections
import contextlib
import http.server
import json
import pathlib
import re
import threading

LARGEST = 1 << 20  # bytes of one participant's answers
BROKEN = (ValueError, KeyError, TypeError, RecursionError)  # what JSON of another shape raises


def server(study: pathlib.Path, host: str = "127.0.0.1", port: int = 8765) -> http.server.ThreadingHTTPServer:
    """A server of a study's folder; `serve_forever` runs it."""
    page, answers, issued, lock = study / "page", study / "answers", collections.Counter(), threading.Lock()
    plan = json.loads((page / "plan.js").read_text(encoding="utf-8").partition("=")[2].rstrip().rstrip(";"))
    for file in answers.glob("*.json"):
        with contextlib.suppress(*BROKEN):
            issued[json.loads(file.read_bytes())["slot"]] += 1

    class StudyHandler(http.server.SimpleHTTPRequestHandler):
        def do_GET(self):
            asked = re.fullmatch(r"bytes=(\d+)-(\d*)", self.headers.get("Range", ""))
            path = pathlib.Path(self.translate_path(self.path))
            if self.path.partition("?")[0] == "/slot":  # the session that fewest participants have had
                with lock:
                    slot = min(range(len(plan["sessions"])), key=lambda number: issued[number])
                    issued[slot] += 1
                self.reply(200, {"slot": slot})
            elif asked and path.is_file():
                self.send_part(path, int(asked[1]), asked[2])
            else:
                super().do_GET()

        def send_part(self, path, first, last):
            """A part of a video, without which some browsers play nothing."""
            size = path.stat().st_size
            last = min(int(last or size - 1), size - 1)
            if first > last:
                self.send_error(416)
                return
            with path.open("rb") as file:
                file.seek(first)
                part = file.read(last - first + 1)
            self.reply(206, part, self.guess_type(str(path)), {"Content-Range": f"bytes {first}-{last}/{size}"})

        def do_POST(self):
            length = self.headers.get("Content-Length", "")
            if self.path != "/answers" or not re.fullmatch(r"\d{1,9}", length) or int(length) > LARGEST:
                self.reply(400, {"error": "answers of at most 1 MiB go to /answers"})
                return
            body, name = self.rfile.read(int(length)), None
            with contextlib.suppress(*BROKEN):
                given = json.loads(body)
                name = re.fullmatch(r"[0-9a-f]{32}", given["participant"]) if given["study"] == plan["study"] else None
            if name is None:
                self.reply(400, {"error": "these are no answers to this study"})
                return
            with lock:
                answers.mkdir(exist_ok=True)
                if not (answers / f"{name[0]}.json").exists():  # the first answers of a participant stay
                    (answers / f"{name[0]}.part").write_bytes(body)
                    (answers / f"{name[0]}.part").replace(answers / f"{name[0]}.json")
            self.reply(200, {"stored": True})

        def reply(self, status, said, kind="application/json", headers=None):
            body = said if isinstance(said, bytes) else json.dumps(said).encode()
            self.send_response(status)
            lines = {"Content-Type": kind, "Content-Length": str(len(body)), "Cache-Control": "no-store", **(headers or {})}
            for key, value in lines.items():
                self.send_header(key, value)
            self.end_headers()
            self.wfile.write(body)

        def list_directory(self, path):
            self.send_error(404)

        def log_message(self, format, *args):
            pass

    text = {f".{end}": f"text/{kind}; charset=utf-8" for end, kind in (("html", "html"), ("css", "css"), ("js", "javascript"))}
    StudyHandler.extensions_map = {"": "application/octet-stream", ".mp4": "video/mp4", **text}
    return http.server.ThreadingHTTPServer((host, port), lambda *asked: StudyHandler(*asked, directory=str(page)))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Shows the page of a study and stores what participants answer.")
    parser.add_argument("--port", type=int, default=8765)
    parser.add_argument("--host", default="127.0.0.1", help="0.0.0.0 for other machines too")
    options = parser.parse_args()
    with server(pathlib.Path(__file__).resolve().parent, options.host, options.port) as running:
        print(f"The study is at http://{options.host}:{running.server_address[1]}/ until Ctrl-C.", flush=True)
        with contextlib.suppress(KeyboardInterrupt):
            running.serve_forever()
