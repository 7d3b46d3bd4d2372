"""An HTTP client for SDKs on top of httpx2 whose time limit holds for a whole request, and a client that is made when needed."""

import importlib
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any


class LazyClient:
    """A client of an SDK that is made by the first request and shared by threads.

    Args:
      make: makes it; it has a `close`.
    """

    def __init__(self, make: Callable[[], Any]):
        self._make, self._lock, self._client = make, threading.Lock(), None

    def get(self) -> Any:
        """The client. Raises what `make` raises."""
        with self._lock:
            if self._client is None:
                self._client = self._make()
            return self._client

    def close(self) -> None:
        """Closes the client, if there is one; the next `get` makes another."""
        with self._lock:
            client, self._client = self._client, None
        if client is not None:
            client.close()


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
