"""Servers on this machine that stand for a model's service: they answer what a test scripts, and keep what they were asked."""

import json
import threading
import time
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, NamedTuple


class Asked(NamedTuple):
    """A request that a server got."""

    method: str
    path: str
    headers: dict[str, str]  # names in lower case
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


class Reply(NamedTuple):
    """What a server answers."""

    status: int = 200
    body: Any = b""  # bytes, or a value that becomes JSON
    headers: dict[str, str] = {}  # noqa: RUF012 - nobody changes it
    wait: float = 0.0  # seconds before the first byte
    cut: int | None = None  # bytes of the body after which the connection is closed
    drip: float = 0.0  # seconds between pieces of 64 bytes


class Loopback:
    """A server of one test. `answer` gives the reply to a request; it is called by several threads at the same time.

    with Loopback(lambda asked: Reply(body={"text": "hello"})) as server:
        client = SomeSDK(base_url=server.url)
    """

    def __init__(self, answer: Callable[[Asked], Reply]):
        self.asked: list[Asked] = []
        self.delivered: list[Asked] = []
        """Requests whose whole reply was sent."""
        self._answer = answer
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}"

    def __enter__(self) -> "Loopback":
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._server.shutdown()
        self._server.server_close()

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        outer = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def _answer(self) -> None:
                body = self.rfile.read(int(self.headers.get("content-length") or 0))
                asked = Asked(self.command, self.path, {name.lower(): value for name, value in self.headers.items()}, body)
                outer.asked.append(asked)
                reply = outer._answer(asked)
                time.sleep(reply.wait)
                try:
                    self._send(reply)
                    outer.delivered.append(asked)
                except OSError:
                    pass  # the client gave up

            def _send(self, reply: Reply) -> None:
                content, headers = reply.body, dict(reply.headers)
                if not isinstance(content, bytes):
                    content, headers = json.dumps(content).encode(), {"content-type": "application/json", **headers}
                self.send_response(reply.status)
                for name, value in {**headers, "content-length": str(len(content))}.items():
                    self.send_header(name, value)
                self.end_headers()
                sent = b"" if self.command == "HEAD" else content[: reply.cut] if reply.cut is not None else content
                for start in range(0, len(sent), 64) if reply.drip else [0]:
                    self.wfile.write(sent[start : start + 64] if reply.drip else sent)
                    self.wfile.flush()
                    time.sleep(reply.drip)
                if reply.cut is not None:
                    self.close_connection = True

            do_GET = do_POST = do_HEAD = _answer

            def log_message(self, *arguments: object) -> None:
                pass

        return Handler


def in_turn(*replies: Reply) -> Callable[[Asked], Reply]:
    """Answers these in turn, the last one for ever."""
    lock, left = threading.Lock(), list(replies)

    def answer(asked: Asked) -> Reply:
        with lock:
            return left.pop(0) if len(left) > 1 else left[0]

    return answer
