"""The time limit of a whole request, with a server that answers a little at a time."""

import pytest

from tests.models.loopback import Loopback, Reply

httpx2 = pytest.importorskip("httpx2")


class Client:
    def close(self):
        self.closed = True


def test_a_client_is_made_once_and_again_after_it_was_closed():
    from wm.models.http_client import LazyClient

    lazy = LazyClient(Client)
    lazy.close()
    first = lazy.get()
    assert lazy.get() is first
    lazy.close()
    assert first.closed and lazy.get() is not first


def ask(seconds, reply):
    from wm.models.http_client import http_client

    with Loopback(lambda asked: reply) as server, http_client(seconds) as client:
        return client.get(server.url).content


def test_a_reply_in_time_is_read_whole():
    assert ask(5.0, Reply(body=b"x" * 200, drip=0.01)) == b"x" * 200


@pytest.mark.parametrize("reply", [Reply(body=b"x" * 6400, drip=0.05), Reply(body=b"x", wait=1.0)], ids=["drip", "silence"])
def test_a_reply_that_takes_too_long_is_given_up(reply):
    with pytest.raises(httpx2.ReadTimeout):
        ask(0.3, reply)
