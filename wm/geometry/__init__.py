"""Plans, structure, cameras, raycasts and texture on the host, in NumPy float64. Nothing heavy is imported before its use."""

from wm.geometry.footprint import Portal as Portal
from wm.geometry.footprint import interior_polygon as interior_polygon
from wm.geometry.footprint import portals as portals
from wm.geometry.glb import GlbNode as GlbNode
from wm.geometry.glb import object_nodes as object_nodes
from wm.geometry.glb import save_glb as save_glb
from wm.geometry.mesh import assemble_scene as assemble_scene
from wm.geometry.mesh import check_mesh as check_mesh
from wm.geometry.mesh import face_normals as face_normals
from wm.geometry.mesh import object_boxes as object_boxes
from wm.geometry.plan import FloorPlan as FloorPlan
from wm.geometry.plan import Opening as Opening
from wm.geometry.plan import PlanError as PlanError
from wm.geometry.plan import Room as Room
from wm.geometry.plan import Violation as Violation
from wm.geometry.plan import load_plan as load_plan
from wm.geometry.plan import parse_plan as parse_plan
from wm.geometry.plan import plan_to_json as plan_to_json
from wm.geometry.structure import build_structure as build_structure
