"""The files of a run's page, what is said of the run, and what the server gives."""

import hashlib
import http.client
import json
import pathlib
import re
import shutil
import urllib.parse

import pytest
import shapely

import wm.view
from wm.finished import open_finished
from wm.geometry import interior_polygon
from wm.view.__main__ import main
from wm.view.server import serve
from wm.view.site import SiteError, build_site, write_site

VENDOR = pathlib.Path(wm.view.__file__).parent / "vendor"


@pytest.fixture(scope="module")
def folder(finished):
    return finished.folder


@pytest.fixture(scope="module")
def site(folder):
    return build_site(open_finished(folder))


def content(site, name):
    told = site[name]
    return told if isinstance(told, bytes) else told.read_bytes()


def answer(address, path, method="GET", **headers):
    connection = http.client.HTTPConnection(urllib.parse.urlsplit(address).netloc, timeout=10)
    try:
        connection.request(method, path, headers=headers)
        response = connection.getresponse()
        return response.status, response.headers, response.read()
    finally:
        connection.close()


def test_every_file_that_the_page_names_is_there(site):
    page = content(site, "index.html").decode()
    named = set(re.findall(r'(?:src|href)="([^"#]+)"', page)) - {"data:,"}
    named |= {
        path.removeprefix("./") for path in json.loads(re.search(r"importmap\">(.*?)</script>", page)[1])["imports"].values()
    }
    for name in [name for name in site if "/" not in name and name.endswith(".js")]:
        script = content(site, name).decode()
        named |= set(re.findall(r'from "\./([^"]+)"', script)) | set(re.findall(r'(?:fetched|json|Layer)\("([^"]+)"', script))
        named |= {f"vendor/three/addons/{path}" for path in re.findall(r'from "three/addons/([^"]+)"', script)}
    assert {"world.json", "navmesh.json", "splats.ply", "scaffold.glb", "page.css", "main.js"} <= named
    for name in named:
        assert name in site or (name.endswith("/") and any(other.startswith(name) for other in site)), name


def test_the_libraries_are_the_files_of_their_packages_and_come_with_licences():
    told = dict(re.findall(r"\| `([0-9a-f]{64})` \| `([^`]+)` \|", (VENDOR / "README.md").read_text()))
    found = {path.relative_to(VENDOR).as_posix(): path for path in VENDOR.rglob("*") if path.is_file()}
    assert set(told.values()) == set(found) - {"README.md"}
    for digest, name in told.items():
        assert hashlib.sha256(found[name].read_bytes()).hexdigest() == digest, name
    assert all((VENDOR / package / "LICENSE").is_file() for package in ("spark", "three"))


def test_a_visit_of_each_room_begins_inside_it_on_the_navmesh(folder, site):
    run = open_finished(folder)
    world, navmesh = json.loads(content(site, "world.json")), json.loads(content(site, "navmesh.json"))
    floor = shapely.union_all([shapely.Polygon([navmesh["vertices"][k][:2] for k in one]) for one in navmesh["triangles"]])
    assert [room["id"] for room in world["rooms"]] == run.rooms == navmesh["rooms"]
    for index, room in enumerate(world["rooms"]):
        spot = shapely.Point(room["spawn"]["position"])
        assert interior_polygon(run.plan, index).contains(spot)
        assert floor.buffer(1e-6).contains(spot)


def test_objects_and_cameras_are_those_of_the_run(folder, site):
    run, world = open_finished(folder), json.loads(content(site, "world.json"))
    assert [row["id"] for row in world["objects"]] == [thing.id for thing in run.objects]
    assert [row["name"] for row in world["cameras"]] == [view.name for view in run.views]
    assert world["raster"]["blur"] == run.raster.blur


def test_the_server_gives_the_files_of_the_site_and_nothing_else(site):
    with serve(site) as address:
        for name in ("", "main.js", "vendor/three/three.core.min.js", "splats.ply"):
            status, headers, body = answer(address, f"/{name}")
            assert (status, body) == (200, content(site, name or "index.html"))
            assert int(headers["Content-Length"]) == len(body)
        assert answer(address, "/main.js")[1]["Content-Type"].startswith("text/javascript")
        assert answer(address, "/splats.ply", "HEAD")[2] == b""
        for path in ("/../site.py", "/vendor/../../site.py", "/%2e%2e/site.py", "//etc/passwd", "/nothing"):
            assert answer(address, path)[0] == 404
        assert answer(address, "/", Host="elsewhere.example")[0] == 403


def test_a_folder_holds_the_same_and_another_folder_s_files_are_kept(folder, site, tmp_path, capsys):
    out = tmp_path / "page"
    assert main([str(folder), f"folder={out}"]) == 0
    assert str(out) in capsys.readouterr().out
    assert {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()} == {
        name: content(site, name) for name in site
    }
    write_site(site, out)  # over itself
    (out / "letter.txt").write_text("mine")
    with pytest.raises(SiteError, match=r"letter\.txt"):
        write_site(site, out)


@pytest.mark.parametrize("missing", ["splats.ply", "scaffold.glb", "cameras.json"])
def test_an_unfinished_run_is_refused_in_one_line(folder, tmp_path, capsys, missing):
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    (copy / missing).unlink()
    assert main([str(copy), "browser=false"]) == 2
    told = capsys.readouterr().err
    assert missing in told and told.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "says"),
    [([], "folder of one run"), (["RUN", "size=3"], "size"), (["RUN", "port=x"], "port"), (["RUN", "browser=no"], "browser")],
)
def test_a_wrong_word_is_one_line(folder, capsys, words, says):
    assert main([str(folder) if word == "RUN" else word for word in words]) == 2
    told = capsys.readouterr().err
    assert says in told and told.count("\n") == 1
