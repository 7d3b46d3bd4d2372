"""The furnish stage with furniture lifted from images: objects keep who they are, and the stage resumes."""

import json

import pytest

from wm.artifacts.run_folder import open_run_folder
from wm.geometry.mesh.glb_nodes import object_nodes
from wm.meter import StageMeter
from wm.run import load_config
from wm.stages import scene as stage
from wm.stages.run_context import RunContext

CELL = (
    "scene.name=cell",
    "scene.theme='a plain cabin'",
    "scene.rooms=[bedroom]",
    "objects=lifted",
    "objects.image_width=160",
    "objects.image_height=120",
    "image.texel_size=0.1",
    "furnish.density=0.3",
)


@pytest.mark.slow
def test_lifted_objects_keep_their_identity(tmp_path):
    config = load_config(CELL)
    with open_run_folder(tmp_path, {"seed": 0}) as folder:
        context = RunContext(config=config, folder=folder, meter=StageMeter({}))
        built = stage.build_scene(context)
        table = json.loads((tmp_path / stage.OBJECTS).read_text())["objects"]
        assert len(table) == len(built.objects) >= 3
        assert {row["room"] for row in table} == set(built.rooms) and all(row["label"] and len(row["size"]) == 3 for row in table)
        assert set(range(len(built.objects))) == set(built.mesh.face_object[built.mesh.face_object >= 0].tolist())
        assert len(object_nodes(built.objects)) >= len(built.objects)

        before = (tmp_path / stage.OBJECT_ARRAYS).stat().st_mtime_ns
        again = stage.build_scene(context)
        assert (tmp_path / stage.OBJECT_ARRAYS).stat().st_mtime_ns == before
        assert [thing.vertices.tobytes() for thing in again.objects] == [thing.vertices.tobytes() for thing in built.objects]
