"""Geometry on the host, in NumPy float64. Each package imports only those listed above it.

    plan       floor plans: reading, rules, walls, openings, the free floor
    mesh       triangle meshes: the building carved from a plan, objects, GLB
    rays       pinhole cameras, raycasts and G-buffers
    texture    the texture atlas: images projected into it, its colours read and exported
    placement  where furniture may stand, what it rests on, where people can walk
    cameras    where views stand, what they see, the walk of the video
    exchange   objects read from mesh files of others, and given to trimesh

embreex is imported when the first ray scene is built and trimesh when the first mesh file is read, not before.
"""

from wm.geometry.cameras.camera_file import CameraFileError as CameraFileError
from wm.geometry.cameras.camera_file import load_cameras as load_cameras
from wm.geometry.cameras.colmap import save_colmap as save_colmap
from wm.geometry.cameras.heldout import place_heldout as place_heldout
from wm.geometry.cameras.sightlines import visible_rooms as visible_rooms
from wm.geometry.cameras.views import place_cameras as place_cameras
from wm.geometry.cameras.visibility import Coverage as Coverage
from wm.geometry.cameras.visibility import coverage as coverage
from wm.geometry.cameras.walk import walkthrough as walkthrough
from wm.geometry.exchange.mesh_error import MeshError as MeshError
from wm.geometry.exchange.object_file import load_object as load_object
from wm.geometry.exchange.trimeshes import object_to_trimesh as object_to_trimesh
from wm.geometry.mesh.axes import opengl_pose as opengl_pose
from wm.geometry.mesh.glb import save_glb as save_glb
from wm.geometry.mesh.glb_lights import house_lights as house_lights
from wm.geometry.mesh.glb_nodes import GlbLight as GlbLight
from wm.geometry.mesh.glb_nodes import GlbNode as GlbNode
from wm.geometry.mesh.glb_nodes import object_nodes as object_nodes
from wm.geometry.mesh.scene_mesh import assemble_scene as assemble_scene
from wm.geometry.mesh.scene_mesh import check_mesh as check_mesh
from wm.geometry.mesh.scene_mesh import face_normals as face_normals
from wm.geometry.mesh.scene_mesh import object_boxes as object_boxes
from wm.geometry.mesh.structure import build_structure as build_structure
from wm.geometry.placement.navigation import Navigability as Navigability
from wm.geometry.placement.navigation import navigability as navigability
from wm.geometry.plan.footprint import interior_polygon as interior_polygon
from wm.geometry.plan.loading import FloorPlan as FloorPlan
from wm.geometry.plan.loading import Opening as Opening
from wm.geometry.plan.loading import PlanError as PlanError
from wm.geometry.plan.loading import PlanWarning as PlanWarning
from wm.geometry.plan.loading import Room as Room
from wm.geometry.plan.loading import Violation as Violation
from wm.geometry.plan.loading import load_plan as load_plan
from wm.geometry.plan.loading import parse_plan as parse_plan
from wm.geometry.plan.loading import plan_to_json as plan_to_json
from wm.geometry.plan.openings import portals as portals
from wm.geometry.plan.portal import Portal as Portal
from wm.geometry.rays.pinhole import camera_center as camera_center
from wm.geometry.rays.pinhole import camera_quat as camera_quat
from wm.geometry.rays.pinhole import camera_rays as camera_rays
from wm.geometry.rays.pinhole import make_camera as make_camera
from wm.geometry.rays.pinhole import project_points as project_points
from wm.geometry.rays.pinhole import scale_camera as scale_camera
from wm.geometry.rays.pinhole import unproject_depth as unproject_depth
from wm.geometry.rays.raycast import RayHits as RayHits
from wm.geometry.rays.raycast import RayScene as RayScene
from wm.geometry.rays.raycast import build_ray_scene as build_ray_scene
from wm.geometry.rays.raycast import cast as cast
from wm.geometry.rays.raycast import cast_rays as cast_rays
from wm.geometry.rays.raycast import occluded as occluded
from wm.geometry.texture.accumulation import accumulate as accumulate
from wm.geometry.texture.atlas import build_atlas as build_atlas
from wm.geometry.texture.atlas import texel_positions as texel_positions
from wm.geometry.texture.atlas_export import atlas_nodes as atlas_nodes
from wm.geometry.texture.sampling import sample_atlas as sample_atlas
