"""Shows the page of a study and stores what participants answer: python serve.py [--port 8765] [--host 0.0.0.0].

It needs Python's standard library only. It shows the folder `page` beside this file, and writes each participant's answers to the
folder `answers`, which it never shows. It logs no addresses.
"""

import argparse, collections, http.server, json, pathlib, re, threading  # noqa: E401  # one screen

LARGEST = 1 << 20  # bytes of one participant's answers


def server(study, host="127.0.0.1", port=8765):
    """A server of a study's folder; `serve_forever` runs it."""
    page, answers, issued, lock = study / "page", study / "answers", collections.Counter(), threading.Lock()
    plan = json.loads((page / "plan.js").read_text().partition("=")[2].rstrip().rstrip(";"))

    class Handler(http.server.SimpleHTTPRequestHandler):
        extensions_map = {"": "application/octet-stream", ".html": "text/html; charset=utf-8", ".css": "text/css",
                          ".js": "text/javascript; charset=utf-8", ".mp4": "video/mp4"}  # fmt: skip  # noqa: RUF012

        def do_GET(self):
            if self.path.partition("?")[0] == "/slot":  # the session that fewest participants have had
                with lock:
                    slot = min(range(len(plan["sessions"])), key=lambda number: (issued[number], number))
                    issued[slot] += 1
                return self.reply(200, {"slot": slot})
            asked = re.fullmatch(r"bytes=(\d+)-(\d*)", self.headers.get("Range", ""))
            path = pathlib.Path(self.translate_path(self.path))
            if not asked or not path.is_file():
                return super().do_GET()
            size = path.stat().st_size  # a part of a video: some browsers play nothing without it
            first, last = int(asked[1]), min(int(asked[2] or size - 1), size - 1)
            if first > last:
                return self.send_error(416)
            self.send_response(206)
            self.send_header("Content-Type", self.guess_type(str(path)))
            self.send_header("Content-Range", f"bytes {first}-{last}/{size}")
            self.send_header("Content-Length", str(last - first + 1))
            self.end_headers()
            with path.open("rb") as file:
                file.seek(first)
                self.wfile.write(file.read(last - first + 1))

        def do_POST(self):
            length = self.headers.get("Content-Length", "")
            if self.path != "/answers" or not re.fullmatch(r"\d{1,9}", length) or int(length) > LARGEST:
                return self.reply(400, {"error": "answers of at most 1 MiB go to /answers"})
            body = self.rfile.read(int(length))
            try:
                given = json.loads(body)
                name = re.fullmatch(r"[0-9a-f]{32}", given["participant"])[0] if given["study"] == plan["study"] else None
            except (ValueError, KeyError, TypeError, RecursionError):
                name = None
            if not name:
                return self.reply(400, {"error": "these are no answers to this study"})
            with lock:
                answers.mkdir(exist_ok=True)
                if not (answers / f"{name}.json").exists():  # the first answers of a participant stay
                    (answers / f"{name}.part").write_bytes(body)
                    (answers / f"{name}.part").replace(answers / f"{name}.json")
            return self.reply(200, {"stored": True})

        def reply(self, status, said):
            body = json.dumps(said).encode()
            self.send_response(status)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)

        def list_directory(self, path):
            self.send_error(404)

        def log_message(self, *said):
            pass

    for file in answers.glob("*.json"):
        try:
            issued[json.loads(file.read_bytes())["slot"]] += 1
        except (ValueError, KeyError, TypeError, RecursionError):
            pass
    return http.server.ThreadingHTTPServer((host, port), lambda *asked: Handler(*asked, directory=str(page)))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--port", type=int, default=8765)
    parser.add_argument("--host", default="127.0.0.1", help="0.0.0.0 for other machines too")
    options = parser.parse_args()
    with server(pathlib.Path(__file__).resolve().parent, options.host, options.port) as running:
        print(f"The study is at http://{options.host}:{running.server_address[1]}/ until Ctrl-C.", flush=True)
        try:
            running.serve_forever()
        except KeyboardInterrupt:
            pass
