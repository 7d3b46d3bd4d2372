"""The page's server: the standard library's, for this machine only.

It listens on 127.0.0.1 and answers GET and HEAD for the names of a `Site`: no path of a request is ever opened. The Host must be
this server's, so that a page of another site that takes its name for this address is refused (DNS rebinding).
"""

import http.server
import pathlib
import shutil
import sys
import threading
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from wm.view.site import Site

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".glb": "model/gltf-binary",
}
_HEADERS = {
    "Cache-Control": "no-cache",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "DENY",
}


class PageServer(http.server.ThreadingHTTPServer):
    """One thread a connection; a browser that closes one in the middle is no error."""

    daemon_threads = True

    def handle_error(self, request: Any, client_address: Any) -> None:
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


@contextmanager
def serve(site: Site, port: int = 0) -> Iterator[str]:
    """A site at the address that is given, until the block ends.

    Args:
      site: its files.
      port: of the server; 0 for one that is free.

    Raises:
      OSError: the port is taken.
    """
    with PageServer(("127.0.0.1", port), _handler(site)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}/"
        finally:
            server.shutdown()
            thread.join()


def _handler(site: Site) -> type[http.server.BaseHTTPRequestHandler]:
    class PageHandler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        timeout = 60  # seconds that a connection may say nothing

        def do_GET(self) -> None:
            self._answer(with_content=True)

        def do_HEAD(self) -> None:
            self._answer(with_content=False)

        def _answer(self, *, with_content: bool) -> None:
            port = self.connection.getsockname()[1]
            if self.headers.get("Host") not in (f"127.0.0.1:{port}", f"localhost:{port}"):
                self.send_error(403, "another host than this server")
                return
            name = urllib.parse.unquote(urllib.parse.urlsplit(self.path).path).lstrip("/") or "index.html"
            content = site.get(name)
            if content is None:
                self.send_error(404, "there is no such file")
                return
            self._head(name, content.stat().st_size if isinstance(content, pathlib.Path) else len(content))
            if with_content:
                self._body(content)

        def _head(self, name: str, length: int) -> None:
            kind = _TYPES.get(pathlib.PurePosixPath(name).suffix, "application/octet-stream")
            self.send_response(200)
            for key, value in {**_HEADERS, "Content-Type": kind, "Content-Length": str(length)}.items():
                self.send_header(key, value)
            self.end_headers()

        def _body(self, content: bytes | pathlib.Path) -> None:
            if isinstance(content, bytes):
                self.wfile.write(content)
                return
            with content.open("rb") as file:
                shutil.copyfileobj(file, self.wfile, 1 << 20)

        def log_message(self, format: str, *args: object) -> None:
            """Says nothing: a page asks for twenty files."""

    return PageHandler
