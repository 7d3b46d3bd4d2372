"""The page's server: this machine only, only with the token, and only what the page needs."""

import concurrent.futures
import http.client
import json
import socket
import urllib.parse

import pytest

from tests.annotation.discs import NAMES, Discs, drawn_run, picture
from wm.annotation.server import serve
from wm.annotation.session import Session
from wm.codecs import decode_png
from wm.synth.lifting.clicks import load_clicks


class Page:
    """The address of a session, and what is asked there."""

    def __init__(self, address):
        parts = urllib.parse.urlsplit(address)
        self.host, self.port, self.base = parts.hostname, parts.port, parts.path

    def ask(self, method, path, body=None, *, base=None, **headers):
        connection = http.client.HTTPConnection(self.host, self.port, timeout=30)
        try:
            connection.putrequest(method, (self.base if base is None else base) + path, skip_host="Host" in headers)
            content = body if isinstance(body, bytes | None) else json.dumps(body).encode()
            told = {} if content is None else {"Content-Type": "application/json", "Content-Length": str(len(content))}
            for name, value in {**told, **{name.replace("_", "-"): value for name, value in headers.items()}}.items():
                connection.putheader(name, value)
            connection.endheaders(content)
            reply = connection.getresponse()
            return reply.status, reply.read(), reply.headers
        finally:
            connection.close()


@pytest.fixture
def drawings(tmp_path):
    return drawn_run(tmp_path / "run")


@pytest.fixture
def page(tmp_path, drawings):
    with serve(Session(tmp_path / "run", Discs(), min_area=2e-4)) as address:
        yield Page(address)


def test_the_page_and_its_parts_are_there_and_load_nothing_from_elsewhere(page):
    for path, kind in (("", "text/html"), ("page.css", "text/css"), ("page.js", "text/javascript")):
        status, body, headers = page.ask("GET", path)
        assert status == 200 and headers.get_content_type() == kind
        assert b"http://" not in body and b"https://" not in body and b"//cdn" not in body
        assert "default-src 'none'" in headers["Content-Security-Policy"] and "unsafe" not in headers["Content-Security-Policy"]
        assert headers["Referrer-Policy"] == "no-referrer" and headers["Cache-Control"] == "no-store"


def test_images_come_as_they_were_drawn(page):
    images = json.loads(page.ask("GET", "images")[1])["images"]
    assert [one["name"] for one in images] == list(NAMES)
    for k, name in enumerate(NAMES):
        status, body, headers = page.ask("GET", f"picture/{name}?{images[k]['digest']}")
        assert status == 200 and headers.get_content_type() == "image/png" and (decode_png(body) == picture(k)).all()


def test_requests_reach_the_session_and_its_errors_the_page(tmp_path, page, drawings):
    asked = {"image": drawings[0].name, "digest": drawings[0].digest, "clicks": [[5.5, 6.25, "+"]], "label": "sofa"}
    status, body, _ = page.ask("POST", "confirm", asked)
    assert status == 200 and json.loads(body)["things"][0]["label"] == "sofa"
    assert load_clicks(tmp_path / "run", drawings[0]).things[0].clicks[0].x == 5.5
    status, body, _ = page.ask("POST", "confirm", asked | {"clicks": []})
    assert status == 400 and "at least one click" in json.loads(body)["error"]


@pytest.mark.parametrize("base", ["/", "/wrong/", "/" + "a" * 32 + "/", "//", "/%00/"])
def test_without_the_token_there_is_nothing(page, base):
    for method, path in (("GET", ""), ("GET", "images"), ("GET", "page.js"), ("POST", "finish")):
        body = {} if method == "POST" else None
        assert page.ask(method, path, body, base=base)[0] == 404


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1", "127.0.0.1:1", "", "0.0.0.0"])
def test_another_host_is_refused_with_the_token_too(page, host):
    assert page.ask("GET", "images", Host=host)[0] == 403
    assert page.ask("POST", "things", {"image": NAMES[0]}, Host=host)[0] == 403
    assert page.ask("GET", "images", Host=f"localhost:{page.port}")[0] == 200


@pytest.mark.parametrize(
    "path",
    ["picture/../manifest.json", "picture/%2e%2e/manifest.json", "picture//etc/passwd", "../page.js", "page.html",
     "manifest.json", "picture/", "session.py", "%2e%2e/session.py", "picture/bath%2f..%2f..%2fmanifest"],
)  # fmt: skip
def test_no_path_leads_to_another_file(page, path):
    status, body, _ = page.ask("GET", path)
    assert status in (400, 404) and set(json.loads(body)) == {"error"}


def test_requests_of_another_form_are_refused(page):
    for method in ("mask", "things", "confirm", "delete", "finish"):
        for body in (b"", b"[]", b"{", b"\xff", b"[" * 5000):
            assert page.ask("POST", method, body)[0] == 400
    assert page.ask("POST", "things", b"x" * 70_000)[0] == 413
    assert page.ask("POST", "things")[0] == 413
    for name in ("images", "__init__", "_saved", "picture", "folder"):
        assert page.ask("POST", name, {})[0] == 404
    status, _, _ = page.ask("POST", "things", b"image=x", Content_Type="text/plain")
    assert status == 400


def test_it_listens_on_this_machine_alone_and_ends(tmp_path, drawings):
    with serve(Session(tmp_path / "run", Discs(), min_area=2e-4)) as address:
        assert address.startswith("http://127.0.0.1:") and len(Page(address).base) > 30
        port = Page(address).port
        with serve(Session(tmp_path / "run", Discs(), min_area=2e-4)) as other:
            assert Page(other).base != Page(address).base
        with pytest.raises(OSError), serve(Session(tmp_path / "run", Discs(), min_area=2e-4), port):
            pass
    with pytest.raises(OSError), socket.create_connection(("127.0.0.1", port), timeout=5):
        pass


def test_many_at_once_lose_nothing(tmp_path, page, drawings):
    asked = {"image": drawings[0].name, "digest": drawings[0].digest}

    def confirm(k):
        return page.ask("POST", "confirm", asked | {"clicks": [[float(k), 5.0, "+"]], "label": f"thing {k}"})[0]

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert set(pool.map(confirm, range(24))) == {200}
    things = load_clicks(tmp_path / "run", drawings[0]).things
    assert sorted(thing.clicks[0].x for thing in things) == list(range(24))
