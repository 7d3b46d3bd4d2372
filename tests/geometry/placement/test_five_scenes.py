"""Every scene's navmesh is one piece through every door, for a body of 0.25 m and for one of 0.30 m."""

import numpy as np
import pytest

from tests.geometry.placement.test_navmesh import pieces
from wm.artifacts.run_folder import open_run_folder
from wm.cli.composition import load_config
from wm.geometry.placement.navigation import body_area
from wm.geometry.placement.navmesh import build_navmesh
from wm.geometry.plan.openings import portals
from wm.meter import StageMeter
from wm.schema import NavigationSettings
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene


@pytest.mark.slow
@pytest.mark.parametrize("name", ["beach_house", "clockwork_garden", "gothic", "roman_estate", "scandinavian"])
def test_it_is_one_piece_through_every_door(tmp_path, name):
    config = load_config([f"+scene={name}", "preset=draft"])
    with open_run_folder(tmp_path, {"seed": 0}) as folder:
        scene = build_scene(RunContext(config=config, folder=folder, meter=StageMeter({})))
    for radius in (0.25, 0.30):
        settings = NavigationSettings(body_radius=radius)
        mesh = build_navmesh(scene.plan, scene.objects, settings)
        assert pieces(mesh.triangles) == 1 and set(mesh.room[mesh.room >= 0].tolist()) == set(range(len(scene.rooms)))
        assert len([portal for portal in portals(scene.plan) if portal.is_way]) >= len(scene.rooms) - 1
        assert mesh.areas.sum() == pytest.approx(body_area(scene.plan, scene.objects, settings).area, rel=0.05)
        assert np.ptp(mesh.vertices[:, 2]) == 0
