"""An HTTP client for SDKs on top of httpx2 whose time limit holds for a whole request."""

import importlib
import time
from collections.abc import Iterator
from typing import Any


def http_client(seconds: float) -> Any:
    """An httpx2.Client whose requests, replies included, end after these seconds: with httpx2.ReadTimeout, if not by themselves.

    The limits of httpx2 itself are of single reads, which a reply that trickles in never exceeds. Proxies of the environment are
    used. Whoever makes the client closes it.
    """
    httpx2: Any = importlib.import_module("httpx2")

    class Limited(httpx2.SyncByteStream):
        """The body of a reply, read piece by piece until its time is over."""

        def __init__(self, response: Any):
            self._request, self._stream = response.request, response.stream

        def __iter__(self) -> Iterator[bytes]:
            for piece in self._stream:
                if time.monotonic() > self._request.extensions["wm_end"]:
                    raise httpx2.ReadTimeout(f"the reply took longer than {seconds:g} s", request=self._request)
                yield piece

        def close(self) -> None:
            self._stream.close()

    def began(request: Any) -> None:
        request.extensions["wm_end"] = time.monotonic() + seconds

    def limit(response: Any) -> None:
        response.stream = Limited(response)

    timeout = httpx2.Timeout(seconds, connect=min(seconds, 30.0))
    return httpx2.Client(timeout=timeout, follow_redirects=True, event_hooks={"request": [began], "response": [limit]})
