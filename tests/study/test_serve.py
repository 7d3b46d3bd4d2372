"""The server of a study: shows the page and nothing else, hands out sessions, stores answers once."""

import ast
import contextlib
import http.client
import json
import pathlib
import sys
import threading

import pytest

from tests.study.clips import answers
from wm.study import serve
from wm.study.answers import read_answers


@contextlib.contextmanager
def served(folder):
    with serve.server(folder, port=0) as running:
        thread = threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
        thread.start()
        try:
            yield running.server_address[1]
        finally:
            running.shutdown()
            thread.join()


def ask(port, method, path, body=None, headers=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request(method, path, body, headers or {})
    reply = connection.getresponse()
    with contextlib.closing(connection):
        return reply.status, reply.read(), reply.headers


@pytest.fixture
def folder(made_study, tmp_path):
    """The published part of the study in a folder of its own."""
    (tmp_path / "page").symlink_to(made_study.folder / "page")
    (tmp_path / "key.json").write_text((made_study.folder / "key.json").read_text())
    return tmp_path


def test_it_needs_the_standard_library_only():
    tree = ast.parse(pathlib.Path(serve.__file__).read_text())
    names = {alias.name.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    assert names <= sys.stdlib_module_names and not any(isinstance(node, ast.ImportFrom) for node in ast.walk(tree))


def test_the_copy_in_the_folder_is_the_module(made_study):
    assert (made_study.folder / "serve.py").read_bytes() == pathlib.Path(serve.__file__).read_bytes()


def test_it_shows_the_page_and_nothing_beside_it(folder):
    with served(folder) as port:
        status, body, headers = ask(port, "GET", "/?p=3")
        assert status == 200 and b"study.js" in body and headers["Content-Type"] == "text/html; charset=utf-8"
        for path in ("/key.json", "/../key.json", "/%2e%2e/key.json", "/answers/", "/serve.py", "/videos/", "/..%2fkey.json"):
            assert ask(port, "GET", path)[0] == 404, path


def test_parts_of_a_video_are_sent_as_asked_for(folder):
    file = next((folder / "page" / "videos").iterdir())
    whole, path = file.read_bytes(), f"/videos/{file.name}"
    with served(folder) as port:
        assert ask(port, "GET", path)[1] == whole
        for asked, first, last in (
            ("bytes=0-1", 0, 1),
            ("bytes=100-", 100, len(whole) - 1),
            ("bytes=5-99999999", 5, len(whole) - 1),
        ):
            status, body, headers = ask(port, "GET", path, headers={"Range": asked})
            assert (status, body) == (206, whole[first : last + 1])
            assert headers["Content-Range"] == f"bytes {first}-{last}/{len(whole)}" and headers["Content-Type"] == "video/mp4"
        assert ask(port, "GET", path, headers={"Range": f"bytes={len(whole)}-"})[0] == 416


def test_sessions_are_handed_out_in_turn_and_those_answered_count(folder, made_study):
    number = len(made_study.sessions)
    with served(folder) as port:
        slots = [json.loads(ask(port, "GET", "/slot")[1])["slot"] for _ in range(number + 2)]
    assert slots == [*range(number), 0, 1]
    (folder / "answers").mkdir()
    (folder / "answers" / "a.json").write_text(json.dumps({"slot": 0}))
    (folder / "answers" / "b.json").write_text("broken")
    with served(folder) as port:
        assert json.loads(ask(port, "GET", "/slot")[1]) == {"slot": 1}


def test_answers_are_stored_once_and_read_back(folder, made_study):
    given = answers(made_study, 0, 7)
    other = given | {"answers": []}
    with served(folder) as port:
        for body in (given, given, other):
            assert ask(port, "POST", "/answers", json.dumps(body))[:2] == (200, b'{"stored": true}')
    assert [file.name for file in (folder / "answers").iterdir()] == [f"{7:032x}.json"]
    read = read_answers(made_study, [folder / "answers"])
    assert read.refused == () and read.sheets[0].participant == f"{7:032x}"


@pytest.mark.parametrize(
    "change",
    [
        {"study": "another"},
        {"participant": "../../evil"},
        {"participant": 3},
        {"participant": "a" * 31},
        {"participant": "A" * 32},
    ],
)
def test_foreign_answers_are_refused_and_not_stored(folder, made_study, change):
    with served(folder) as port:
        assert ask(port, "POST", "/answers", json.dumps(answers(made_study, 0, 1) | change))[0] == 400
        assert ask(port, "POST", "/answers", "no json")[0] == 400
        assert ask(port, "POST", "/answers", "[" * 100_000)[0] == 400
        assert ask(port, "POST", "/answers", "{}", {"Content-Length": str(2 << 20)})[0] == 400
        assert ask(port, "POST", "/other", "{}")[0] == 400
    assert not (folder / "answers").exists() and not list(folder.rglob("evil*"))


def test_nobody_is_logged(folder, capfd):

    with served(folder) as port:
        for method, path in (("GET", "/"), ("GET", "/none"), ("POST", "/answers")):
            ask(port, method, path, "{}" if method == "POST" else None)
    assert capfd.readouterr() == ("", "")
