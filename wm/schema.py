"""Every knob, as kw_only dataclasses: the Hydra schema, and the settings records that functions take.

Standard library only. Angles are degrees here and radians inside; lengths are metres, image sizes pixels. Hydra composes
these from conf/ (unknown keys raise); `hash` lets one be a static argument of a jitted function, so treat a record as
read-only once made (`dataclasses.replace` makes a changed copy).
"""

from dataclasses import dataclass, field

BESIDE = {"identity": False}
"""Metadata of a field that changes no stage's result: runs that differ in it alone are the same run."""


@dataclass(kw_only=True, unsafe_hash=True)
class SceneConfig:
    """What is wanted, in words: conf/scene/*.yaml."""

    name: str = "unnamed"
    theme: str = ""
    rooms: list[str] = field(default_factory=list)  # the room programme: hall, library, kitchen, bedroom, bathroom ...


@dataclass(kw_only=True, unsafe_hash=True)
class PlanConfig:
    """Where the floor plan comes from."""

    file: str | None = None  # a plan of the user's own; None asks the language backend
    max_iterations: int = 8  # propose - validate - correct rounds before giving up


@dataclass(kw_only=True, unsafe_hash=True)
class CameraSettings:
    """View planning (paper, "Camera Viewpoint Generation")."""

    width: int = 688
    height: int = 384
    fov: float = 60.0  # vertical; the paper's 60 degrees is vertical in its code
    eye_height: float = 1.6
    perimeter: int = 16
    overhead: int = 8
    doorway: bool = True  # one view through each doorway: ours, the paper has none
    wall_offset: float = 0.4
    prune_angle: float = 10.0  # perimeter views this close to a bootstrap view are dropped
    clearance: float = 0.3  # free air around a camera
    heldout_per_room: int = 8


@dataclass(kw_only=True, unsafe_hash=True)
class FurnishConfig:
    enabled: bool = True
    density: float = 1.0  # 0..1: share of the optional pieces that are tried


@dataclass(kw_only=True, unsafe_hash=True)
class TextureSettings:
    """Texture accumulation (paper, "Scaffold Mesh Texturing Details")."""

    texel_size: float = 0.02
    min_facing: float = 0.15  # cosine between normal and view below which nothing is projected; below 1
    occlusion_tolerance: float = 0.02  # metres beyond the local depth maximum; the paper's 0.10 leaks (facts.md)
    opaque_weight: float = 0.5  # weight at which a texel counts as fully known


@dataclass(kw_only=True, unsafe_hash=True)
class ConditionConfig:
    """Which of the scaffold's signals the image model is shown (paper, ablation of conditioning modalities)."""

    wall_texture: bool = True
    objects: str = "textured"  # textured | boxes | none


@dataclass(kw_only=True, unsafe_hash=True)
class VerifySettings:
    """Depth-edge recall (paper, "Image Verification"), and ours: depth that disagrees."""

    enabled: bool = True
    low: float = 0.1  # Canny thresholds as shares of the normalised depth range
    high: float = 0.3
    dilation: int = 10  # pixels at 1376 wide, scaled with the image
    min_recall: float = 0.35  # sound images reach 0.40 and more in every view of the five scenes (experiments/verification)
    tolerance: float = 0.1  # of the scaffold's depth, beyond which an estimate disagrees with it
    max_disagreement: float = 0.0012  # share of the image that may; 1: recall alone decides, as in the paper
    max_attempts: int = 8


COMPOSITORS = ("auto", "loops", "kernels", "interpreted")
PLANNERS = ("auto", "host", "traced")


@dataclass(kw_only=True, unsafe_hash=True)
class RasterSettings:
    """The constants of the rasterizer (design.md section 5); static under jit."""

    blur: float = 0.3  # px^2 added to the diagonal of the projected covariance
    alpha_min: float = 1 / 255  # contributions below are dropped
    alpha_max: float = 0.99  # and clamped above, in value and gradient
    transmittance_min: float = 1e-4  # a pixel is finished below
    near: float = 0.05  # metres
    frustum_margin: float = 1.3  # EWA Jacobian clamped at this multiple of tan(fov / 2)
    depth: bool = True  # False leaves depth out of the render (it is 0 then) and of its cost
    slanted: bool = True  # depth varies over a gaussian's ellipse as its surface does; False: that of its centre, as in 3DGS
    antialias: bool = False  # opacities fall by what the blur adds to the area, so that small gaussians do not grow brighter
    compositor: str = "auto"  # COMPOSITORS: kernels run on NVIDIA GPUs, interpreted ones and loops anywhere; auto is the fastest
    planner: str = "auto"  # PLANNERS: where tiles are planned; auto is on the host for a CPU, traced (in the graph) elsewhere
    tile: int = 8
    chunk: int = 8
    block: int = 64


@dataclass(kw_only=True, unsafe_hash=True)
class FitSettings:
    """Initialisation and optimisation of the gaussians (paper, "Geometry-Regularized 3DGS Scene Reconstruction")."""

    init: str = "flat"  # flat | isotropic | random
    spacing: float = 0.055  # metres between gaussians of the initial cloud
    detail_spacing: float = 0.0275  # the same on objects and beside silhouettes
    opacity: float = 0.9  # initial
    steps: int = 120  # optimiser steps per room
    batch: int = 1  # views a step, whose gradients are averaged
    rounds: int = 1  # rooms see their neighbours' latest gaussians this many times
    ssim_weight: float = 0.2
    normal_weight: float = 0.5  # of the angle between the surface of the splat depth and the scaffold's; the paper has none
    depth_weight: float = 1.5  # per metre; the paper's 0.7 leaves depth and normals a little worse (experiments/fit_defaults)
    lr_means: float = 1.2e-3
    lr_quats: float = 2e-2
    lr_scales: float = 6e-2
    lr_opacities: float = 0.2
    lr_sh: float = 4e-2
    lr_final: float = 0.1  # learning rates decay to this share
    exposure: bool = False  # a gain and an offset for each view and channel, for image models that drift
    lr_exposure: float = 0.05  # what they move by in a step if all pixels of a view are too bright
    refine_every: int = 0  # steps between refinements, which give faint gaussians to where the residual stays; 0: none
    refine_share: float = 0.05  # of all gaussians that move at most in one of them
    refine_spare: float = 0.15  # of the initial cloud that are added unseen, to be given away first
    refine_dead: float = 0.05  # opacity up to which a gaussian counts as faint
    sh_degree: int = 0
    curve_points: int = 6  # held-out evaluations along the fit


@dataclass(kw_only=True, unsafe_hash=True)
class NavigationSettings:
    """Occupancy grid (paper, "Navigability")."""

    cell: float = 0.15
    body_radius: float = 0.25
    obstacle_height: float = 1.8  # floor-standing things below this block a body


@dataclass(kw_only=True, unsafe_hash=True)
class EvaluateConfig:
    min_overlap: float = 0.3  # share of shared surface for a reprojection pair


@dataclass(kw_only=True, unsafe_hash=True)
class ReportConfig:
    enabled: bool = True
    video: bool = True
    fps: int = 10
    walking_speed: float = 2.4  # metres a second along the fly-through


@dataclass(kw_only=True, unsafe_hash=True)
class LanguageConfig:
    name: str = "grammar"


@dataclass(kw_only=True, unsafe_hash=True)
class ImageConfig:
    name: str = "procedural"
    drift: float = 0.02  # standard deviation of the tone a view invents where its condition shows only depth
    imaginations: int = 3  # worlds that a view's seed picks from for what its condition leaves open; 0: always the scene's own
    exposure: float = 0.0  # standard deviation of a view's brightness, also where its condition shows the tone
    phase: float = 0.0  # pixels at 1376 wide by which fine detail strays
    softness: float = 0.0  # pixels at 1376 wide by which the image is blurred
    closed: float = 0.0  # share of the images in which a doorway is shut
    missing: float = 0.0  # in which a thing is not drawn
    added: float = 0.0  # in which one is drawn twice
    moved: float = 0.0  # in which one stands elsewhere
    supersampling: int = 2  # geometry samples per pixel side
    texel_size: float = 0.01  # metres between texels of the offline world's surfaces; its light is as much coarser or finer
    worker: bool = field(default=True, metadata=BESIDE)  # shade in a process of its own, where there is a core for it


@dataclass(kw_only=True, unsafe_hash=True)
class ObjectsConfig:
    name: str = "procedural"  # procedural: straight from the generator | lifted: from images of the room
    segmentation: str = "drawn"  # what finds things in those images; drawn: offline, by what the offline image model drew
    reconstruction: str = "templates"  # what makes a mesh of each
    image_width: int = 640  # of the images that rooms are lifted from
    image_height: int = 480
    fov: float = 90.0  # vertical
    min_area: float = 2e-4  # share of the image below which a segment is discarded
    ragged: float = 1.0  # pixels by which the offline segmentation's borders stray
    merged: float = 0.1  # share of touching neighbours of one kind that it takes for one thing
    missed: float = 0.25  # share of small things that it misses


@dataclass(kw_only=True, unsafe_hash=True)
class DepthConfig:
    name: str = "procedural"
    noise: float = 0.01  # relative, of the offline depth model
    softness: float = 0.35  # pixels by which it blurs edges


BACKEND_KEYS = {
    "language": "language.name",
    "image": "image.name",
    "objects": "objects.name",
    "depth": "depth.name",
    "segmentation": "objects.segmentation",
    "reconstruction": "objects.reconstruction",
}
"""The key that selects the backend of each group."""


EXECUTORS = ("threads",)
"""What rooms can be fitted by, side by side."""


@dataclass(kw_only=True, unsafe_hash=True)
class RunConfig:
    """The whole of a run; conf/config.yaml and what the command line says."""

    scene: SceneConfig = field(default_factory=SceneConfig)
    plan: PlanConfig = field(default_factory=PlanConfig)
    cameras: CameraSettings = field(default_factory=CameraSettings)
    furnish: FurnishConfig = field(default_factory=FurnishConfig)
    texture: TextureSettings = field(default_factory=TextureSettings)
    condition: ConditionConfig = field(default_factory=ConditionConfig)
    verify: VerifySettings = field(default_factory=VerifySettings)
    raster: RasterSettings = field(default_factory=RasterSettings)
    fit: FitSettings = field(default_factory=FitSettings)
    navigation: NavigationSettings = field(default_factory=NavigationSettings)
    evaluate: EvaluateConfig = field(default_factory=EvaluateConfig)
    report: ReportConfig = field(default_factory=ReportConfig, metadata=BESIDE)
    language: LanguageConfig = field(default_factory=LanguageConfig)
    image: ImageConfig = field(default_factory=ImageConfig)
    objects: ObjectsConfig = field(default_factory=ObjectsConfig)
    depth: DepthConfig = field(default_factory=DepthConfig)
    variant: str = "full"
    preset: str = "standard"
    seed: int = 0
    output: str | None = field(default=None, metadata=BESIDE)  # run folder; None: Hydra's outputs/<scene>/<variant>/<seed>
    # take finished stages over from runs of other variants beside this one, where they are the same
    reuse: bool = field(default=True, metadata=BESIDE)
    # a folder made by another configuration is refused unless this is true
    overwrite: bool = field(default=False, metadata=BESIDE)
    executor: str = field(default="threads", metadata=BESIDE)  # what rooms are fitted by, one of EXECUTORS
    workers: int | None = field(default=None, metadata=BESIDE)  # how many rooms are fitted at once; None: one per core
    debug: bool = field(default=False, metadata=BESIDE)  # tracebacks instead of one-line errors
