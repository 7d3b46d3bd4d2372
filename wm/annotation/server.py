"""The page's server: the standard library's, for this machine only.

It listens on 127.0.0.1. Every path begins with a random token, which only who has read the address knows; the Host must be this
server's, so that a page of another site that takes its name for this address is refused (DNS rebinding). Files are chosen from a
list, and drawings by their names in the run's list: no path of a request is ever opened.
"""

import hmac
import http.server
import importlib.resources
import json
import secrets
import threading
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from wm.annotation.session import Session
from wm.errors import InputError
from wm.services.faults import RefusedError, ServiceError

_FILES = {"": ("page.html", "text/html"), "page.css": ("page.css", "text/css"), "page.js": ("page.js", "text/javascript")}
_ACTIONS = ("things", "mask", "confirm", "delete", "finish")
_LONGEST_BODY = 1 << 16
_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; img-src 'self' data:; style-src 'self'; script-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


@contextmanager
def serve(session: Session, port: int = 0) -> Iterator[str]:
    """The page of a session, at the address that is given, until the block ends.

    Args:
      session: what the page shows and changes.
      port: of the server; 0 for one that is free.

    Raises:
      OSError: the port is taken.
    """
    token = secrets.token_urlsafe(24)
    with http.server.ThreadingHTTPServer(("127.0.0.1", port), _handler(session, token)) as server:
        server.daemon_threads = True
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}/{token}/"
        finally:
            server.shutdown()
            thread.join()


def _handler(session: Session, token: str) -> type[http.server.BaseHTTPRequestHandler]:
    class AnnotationHandler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        timeout = 60  # seconds that a connection may say nothing

        def do_GET(self) -> None:
            path = self._path()
            if path is None:
                return
            if path in _FILES:
                name, kind = _FILES[path]
                content = (importlib.resources.files("wm.annotation") / "page" / name).read_bytes()
                self._send(200, content, f"{kind}; charset=utf-8")
            elif path == "images":
                self._answer(session.images)
            elif path.startswith("picture/"):
                self._answer(lambda: session.picture(path.removeprefix("picture/")))
            else:
                self._refuse(404, "there is no such page")

        def do_POST(self) -> None:
            path = self._path()
            if path is None:
                return
            if path not in _ACTIONS:
                self._refuse(404, "there is no such request")
            elif (asked := self._json()) is not None:
                self._answer(lambda: getattr(session, path)(asked))

        def _path(self) -> str | None:
            """What stands after the token; None once the request is refused."""
            port = self.connection.getsockname()[1]
            if self.headers.get("Host") not in (f"127.0.0.1:{port}", f"localhost:{port}"):
                self._refuse(403, "another host than this server")
                return None
            given, _, rest = urllib.parse.unquote(urllib.parse.urlsplit(self.path).path).lstrip("/").partition("/")
            if not hmac.compare_digest(given.encode(), token.encode()):
                self._refuse(404, "the address begins with the token that wm.annotate printed")
                return None
            return rest

        def _json(self) -> dict[str, Any] | None:
            """The body; None once the request is refused."""
            length = self.headers.get("Content-Length", "")
            if not (length.isascii() and length.isdigit()) or int(length) > _LONGEST_BODY:
                self._refuse(413, "a request has a length, and at most 64 KiB")
                return None
            try:
                asked = json.loads(self.rfile.read(int(length)))
            except (ValueError, RecursionError):
                asked = None
            if self.headers.get_content_type() != "application/json" or not isinstance(asked, dict):
                self._refuse(400, "a request is a JSON object")
                return None
            return asked

        def _answer(self, answer: Any) -> None:
            try:
                content = answer()
            except (InputError, ServiceError, RefusedError, OSError) as error:
                self._refuse(400, str(error))
                return
            if isinstance(content, bytes):
                self._send(200, content, "image/png")
            else:
                self._send(200, json.dumps(content).encode(), "application/json")

        def _refuse(self, status: int, why: str) -> None:
            self.close_connection = True  # the body of the request may not have been read
            self._send(status, json.dumps({"error": why}).encode(), "application/json")

        def _send(self, status: int, content: bytes, kind: str) -> None:
            self.send_response(status)
            for name, value in {**_HEADERS, "Content-Type": kind, "Content-Length": str(len(content))}.items():
                self.send_header(name, value)
            if self.close_connection:
                self.send_header("Connection", "close")
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *args: object) -> None:
            """Says nothing: the address holds the token."""

    return AnnotationHandler
