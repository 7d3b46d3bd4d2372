"""wm: a theme in words becomes a navigable multi-room 3D scene.

The parts are used alone from Python: `wm.geometry` (plan, structure, cameras, raycasts, texture atlas), `wm.splat` (the
gaussian rasterizer, its fit and its metrics), `wm.synth` (language, image, object and depth backends). `python -m wm.run`
wires them. Importing `wm` itself loads none of them.
"""

__version__ = "0.1.0"
