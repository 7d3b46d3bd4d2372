"""The loopback server itself, by the standard library's client."""

import http.client
import urllib.error
import urllib.request

import pytest

from tests.models.loopback import Loopback, Reply, in_turn


def test_replies_come_in_turn_and_requests_are_kept():
    with Loopback(in_turn(Reply(status=503), Reply(body={"a": 1}))) as server:
        with pytest.raises(urllib.error.HTTPError, match="503") as caught:
            urllib.request.urlopen(server.url + "/x", data=b'{"q": 2}')
        caught.value.close()
        with urllib.request.urlopen(server.url + "/y") as reply:
            assert reply.read() == b'{"a": 1}'
    assert [(asked.method, asked.path) for asked in server.asked] == [("POST", "/x"), ("GET", "/y")]
    assert server.asked[0].json == {"q": 2}


def test_a_cut_reply_ends_before_its_length():
    with (
        Loopback(lambda asked: Reply(body=b"x" * 1000, cut=300)) as server,
        urllib.request.urlopen(server.url) as reply,
        pytest.raises(http.client.IncompleteRead),
    ):
        reply.read()
