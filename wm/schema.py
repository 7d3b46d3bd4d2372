"""Every knob, as kw_only dataclasses: the Hydra schema, and the settings records that functions take.

Nothing heavy is imported. Each field says beside its default what it is for, and what it may hold (`wm.bounds`). Angles are
degrees here and radians inside; lengths are metres, image sizes pixels. Hydra composes these from conf/ (unknown keys raise);
`hash` lets one be a static argument of a jitted function, so treat a record as read-only once made (`dataclasses.replace` makes a
changed copy).
"""

from dataclasses import dataclass, field
from typing import Any

from wm.bounds import choice, number, setting
from wm.services.prices import Price

STAGES = ("plan", "structure", "furnish", "cameras", "paint", "heldout", "reconstruct", "evaluate", "report")
"""The stages of a run, in order."""

BESIDE: dict[str, Any] = {"identity": False}
"""Metadata of a field that changes no stage's result: runs that differ in it alone are the same run."""

READ: dict[str, Any] = {"read": True}
"""Metadata of a backend's field that names a folder whose files shape its results: stages are made again when they change."""

LONGEST_ROOM_NAME = 200
"""Characters of a room's name: in a programme, in a plan, and in what a language model answers."""


@dataclass(kw_only=True, unsafe_hash=True)
class SceneConfig:
    """What is wanted, in words: conf/scene/*.yaml."""

    name: str = setting("unnamed", "Name of the scene, and of its run folder; by default the words of its theme.")
    theme: str = setting("", "What the scene should be, in words.")
    rooms: list[str] = field(
        default_factory=list, metadata={"help": "The room programme: hall, library, kitchen, bedroom, bathroom ..."}
    )


@dataclass(kw_only=True, unsafe_hash=True)
class PlanConfig:
    """Where the floor plan comes from."""

    file: str | None = setting(None, "A plan of the user's own; None asks the language backend.")
    storey: str | None = setting(None, "The storey of a file that holds several, its name or number; None for the lowest.")
    repair: bool = setting(
        False, "Mend a plan of the user's own: walls drawn as gaps, rooms that overlap, openings that do not fit their walls."
    )
    unreachable: str = choice(
        "warn", ("warn", "refuse"), "What to do with rooms of the user's own plan that no door or passage leads to."
    )
    seed: int | None = number(None, 0, 2**63 - 1, "Seed of the floor plan; None: that of the run.", null="seed")
    max_iterations: int = number(8, 1, 1000, "Propose - validate - correct rounds before giving up.")


@dataclass(kw_only=True, unsafe_hash=True)
class CameraSettings:
    """View planning (paper, "Camera Viewpoint Generation")."""

    width: int = number(688, 16, 16384, "Width of the images.", unit="px")
    height: int = number(384, 16, 16384, "Height of the images.", unit="px")
    fov: float = number(60.0, 5, 150, "Vertical field of view; the paper's 60 degrees is vertical in its code.", unit="degrees")
    eye_height: float = number(1.6, 0.2, 5, "Height of a standing viewer's eyes above the floor.", unit="m")
    perimeter: int = number(16, 0, 1000, "Views from along the walls of a room.")
    overhead: int = number(8, 0, 1000, "Views from below the ceiling of a room.")
    doorway: bool = setting(True, "One view through each doorway: ours, the paper has none.")
    wall_offset: float = number(0.4, 0.05, 5, "Distance of the perimeter views from the walls.", unit="m")
    prune_angle: float = number(10.0, 0, 180, "Perimeter views this close to a bootstrap view are dropped.", unit="degrees")
    clearance: float = number(0.3, 0, 2, "Free air around a camera.", unit="m")
    heldout_per_room: int = number(8, 0, 1000, "Views of each room that are kept from the fit, to judge it by.")


@dataclass(kw_only=True, unsafe_hash=True)
class FurnishConfig:
    enabled: bool = setting(True, "Put furniture into the rooms.")
    density: float = number(1.0, 0, 1, "Share of the optional pieces that are tried.")
    seed: int | None = number(None, 0, 2**63 - 1, "Seed of the furniture; None: that of the run.", null="seed")


@dataclass(kw_only=True, unsafe_hash=True)
class FinishConfig:
    """Surfaces of rooms and furniture, as the offline image model finishes them."""

    seed: int | None = number(None, 0, 2**63 - 1, "Seed of grain and stains; None: that of the run.", null="seed")


@dataclass(kw_only=True, unsafe_hash=True)
class LightConfig:
    """Light of the rooms, as the offline image model computes it."""

    seed: int | None = number(None, 0, 2**63 - 1, "Seed of the rays of light; None: that of the run.", null="seed")


@dataclass(kw_only=True, unsafe_hash=True)
class TextureSettings:
    """Texture accumulation (paper, "Scaffold Mesh Texturing Details")."""

    texel_size: float = number(0.02, 0.001, 1, "Distance between texels of the scaffold's texture.", unit="m")
    # below 1, since the weight of a view divides by what is left to 1
    min_facing: float = number(
        0.15, 0, 1, "Cosine between normal and view below which nothing is projected; below 1.", below=True
    )
    occlusion_tolerance: float = number(
        0.02,
        0,
        1,
        "Depth beyond the local maximum at which a surface still counts as seen; the paper's 0.10 leaks (facts.md).",
        unit="m",
    )
    opaque_weight: float = number(0.5, 1e-6, 1e6, "Weight at which a texel counts as fully known.")


@dataclass(kw_only=True, unsafe_hash=True)
class ConditionConfig:
    """Which of the scaffold's signals the image model is shown (paper, ablation of conditioning modalities)."""

    wall_texture: bool = setting(True, "Show the texture that earlier views have left on the scaffold.")
    objects: str = choice("textured", ("textured", "boxes", "none"), "How the scaffold's objects are shown.")


@dataclass(kw_only=True, unsafe_hash=True)
class VerifySettings:
    """Depth-edge recall (paper, "Image Verification"), and ours: depth that disagrees."""

    enabled: bool = setting(True, "Refuse images that lose the scaffold's structure.")
    low: float = number(0.1, 0, 1, "Lower Canny threshold as a share of the normalised depth range; at most `high`.")
    high: float = number(0.3, 0, 1, "Upper Canny threshold as a share of the normalised depth range.")
    dilation: int = number(10, 0, 1000, "How far an edge may stray, in pixels at 1376 wide, scaled with the image.", unit="px")
    min_recall: float = number(
        0.35,
        0,
        1,
        "Least recall of an image; sound ones reach 0.40 and more in every view of the five scenes (experiments/verification).",
    )
    tolerance: float = number(0.1, 0, 10, "Share of the scaffold's depth beyond which an estimate disagrees with it.")
    field: int = number(
        0, 0, 8, "Degree of the smooth drift of an estimate's scale over the image that is no disagreement; 0: none."
    )
    max_disagreement: float = number(
        0.0012, 0, 1, "Share of the image that may disagree; 1: recall alone decides, as in the paper."
    )
    max_attempts: int = number(8, 1, 1000, "Images of a view that are tried before the best of them is taken.")


@dataclass(kw_only=True, unsafe_hash=True)
class RasterSettings:
    """The constants of the rasterizer (design.md section 5); static under jit."""

    blur: float = number(0.3, 0, 100, "Added to the diagonal of the projected covariance.", unit="px^2")
    alpha_min: float = number(1 / 255, 1e-30, 1, "Contributions below are dropped; below `alpha_max`.")
    alpha_max: float = number(0.99, 0, 1, "Contributions are clamped above, in value and gradient.")
    # below 1, or nothing would be rendered
    transmittance_min: float = number(1e-4, 0, 1, "A pixel is finished below this transmittance.", below=True)
    near: float = number(0.05, 1e-6, 10, "Gaussians nearer than this are not rendered.", unit="m")
    frustum_margin: float = number(1.3, 1, 10, "The EWA Jacobian is clamped at this multiple of tan(fov / 2).")
    depth: bool = setting(True, "False leaves depth out of the render (it is 0 then) and of its cost.")
    slanted: bool = setting(
        True, "Depth varies over a gaussian's ellipse as its surface does; False: that of its centre, as in 3DGS."
    )
    antialias: bool = setting(
        False, "Opacities fall by what the blur adds to the area, so that small gaussians do not grow brighter."
    )
    compositor: str = choice(
        "auto",
        ("auto", "loops", "kernels", "interpreted"),
        "What composites: kernels run on NVIDIA GPUs, interpreted ones and loops anywhere; auto is the fastest.",
    )
    planner: str = choice(
        "auto",
        ("auto", "host", "traced"),
        "Where tiles are planned; auto is on the host for a CPU, traced (in the graph) elsewhere.",
    )
    tile: int = number(8, 1, 64, "Side of a tile; kernels want a power of two.", unit="px")
    chunk: int = number(8, 1, 1024, "Gaussians that a tile composites in one iteration of the loops.")
    block: int = number(64, 1, 4096, "Tiles whose loops advance together.")


@dataclass(kw_only=True, unsafe_hash=True)
class FitSettings:
    """Initialisation and optimisation of the gaussians (paper, "Geometry-Regularized 3DGS Scene Reconstruction")."""

    init: str = choice("flat", ("flat", "isotropic", "random"), "How gaussians start: flat on surfaces, round there, anywhere.")
    spacing: float = number(0.055, 0.001, 1, "Distance between gaussians of the initial cloud.", unit="m")
    detail_spacing: float = number(0.0275, 0.001, 1, "The same on objects and beside silhouettes.", unit="m")
    opacity: float = number(0.9, 0.001, 0.999, "Initial opacity.")
    steps: int = number(100, 0, 10_000_000, "Optimiser steps per room.")
    batch: int = number(1, 1, 1000, "Views a step, whose gradients are averaged.")
    rounds: int = number(1, 1, 1000, "Rooms see their neighbours' latest gaussians this many times.")
    ssim_weight: float = number(0.2, 0, 1, "Share of the structural similarity in the loss of the colours.")
    normal_weight: float = number(
        0.5, 0, 1000, "Weight of the angle between the surface of the splat depth and the scaffold's; the paper has none."
    )
    depth_weight: float = number(
        1.5,
        0,
        1000,
        "Weight of the depth loss; the paper's 0.7 leaves depth and normals a little worse (experiments/fit_defaults).",
        unit="1/m",
    )
    lr_means: float = number(1.7e-3, 0, 1000, "Learning rate of the centres.")
    lr_quats: float = number(2.8e-2, 0, 1000, "Learning rate of the orientations.")
    lr_scales: float = number(8.4e-2, 0, 1000, "Learning rate of the logarithms of the extents.")
    lr_opacities: float = number(0.28, 0, 1000, "Learning rate of the opacities, as logits.")
    lr_sh: float = number(5.6e-2, 0, 1000, "Learning rate of the colours.")
    lr_final: float = number(0.1, 1e-9, 1e4, "Learning rates change geometrically to this share; above 1 they grow.")
    exposure: bool = setting(False, "Fit a gain and an offset for each view and channel, for image models that drift.")
    lr_exposure: float = number(0.035, 0, 1000, "What gain and offset move by in a step if all pixels of a view are too bright.")
    refine_every: int = number(
        0, 0, 10_000_000, "Steps between refinements, which give faint gaussians to where the residual stays; 0: none."
    )
    refine_share: float = number(0.05, 0, 0.5, "Share of all gaussians that move at most in one refinement.")
    refine_spare: float = number(0.15, 0, 10, "Share of the initial cloud that is added unseen, to be given away first.")
    refine_dead: float = number(0.05, 1e-6, 0.5, "Opacity up to which a gaussian counts as faint.")
    sh_degree: int = number(0, 0, 3, "Degree of the spherical harmonics that colours are made of.")
    curve_points: int = number(6, 0, 1000, "Held-out evaluations along the fit.")


@dataclass(kw_only=True, unsafe_hash=True)
class NavigationSettings:
    """Occupancy grid (paper, "Navigability")."""

    cell: float = number(0.15, 0.01, 1, "Side of a cell of the grid.", unit="m")
    body_radius: float = number(0.25, 0, 2, "Radius of the body that walks.", unit="m")
    obstacle_height: float = number(1.8, 0, 10, "Floor-standing things below this block a body.", unit="m")


@dataclass(kw_only=True, unsafe_hash=True)
class EvaluateConfig:
    min_overlap: float = number(0.3, 0, 1, "Share of shared surface for a reprojection pair.")
    quality: str | None = setting(
        None, "Folder with the weights of CLIP-IQA+ and the aesthetic score; null: they are not measured.", **READ, **BESIDE
    )


@dataclass(kw_only=True, unsafe_hash=True)
class ReportConfig:
    enabled: bool = setting(True, "Write the report page.")
    video: bool = setting(True, "Write the fly-through.")
    fps: int = number(24, 1, 240, "Frames of the fly-through a second.", unit="1/s")
    walking_speed: float = number(2.4, 0.05, 50, "Speed along the fly-through.", unit="m/s")


@dataclass(kw_only=True, unsafe_hash=True)
class AnswersConfig:
    """What models have answered, kept so that nothing is asked or paid twice."""

    folder: str = setting("outputs/answers", "Folder of the answers; runs and machines can share it. It holds no secret.")
    replay: str = choice(
        "auto", ("auto", "only", "off"), "Kept answers: auto uses them and keeps new ones, only sends nothing, off asks anew."
    )
    patience: float = number(900.0, 0, 86400, "How long a request is tried again while its service fails.", unit="s")


@dataclass(kw_only=True, unsafe_hash=True)
class BudgetConfig:
    """Limits of what a run may spend on models, its earlier parts included."""

    usd: float | None = number(None, 0.0, 1e6, "US dollars.", unit="USD", null="no limit")
    requests: int | None = number(None, 0, 10**9, "Paid requests.", null="no limit")


@dataclass(kw_only=True, unsafe_hash=True)
class PricesConfig:
    """What models cost: conf/prices/*.yaml."""

    as_of: str = setting("", "Day on which the prices were read.")
    models: dict[str, Price] = field(
        default_factory=dict, hash=False, metadata={"help": "By model; a price holds for all names that begin with its own."}
    )


@dataclass(kw_only=True, unsafe_hash=True)
class BackendSettings:
    """What selects a backend. The `Settings` of a backend's module extends it with the knobs of that backend alone.

    A plain one, with nothing but the path, selects that backend with the defaults of its settings.
    """

    backend: str = setting("", "Dotted path of the module that has `make` and `Settings` (wm.synth.registry).")


@dataclass(kw_only=True, unsafe_hash=True)
class ObjectsSettings(BackendSettings):
    """What every backend that furnishes rooms has, beside its own knobs."""

    file: str | None = setting(None, "An objects.json with furniture removed, moved or turned; None: as furnished.")


@dataclass(kw_only=True, unsafe_hash=True)
class RunConfig:
    """The whole of a run; conf/config.yaml and what the command line says.

    The groups of backends (wm.synth.registry) hold the Settings of the module that is selected; none is by default here.
    """

    scene: SceneConfig = field(default_factory=SceneConfig)
    plan: PlanConfig = field(default_factory=PlanConfig)
    cameras: CameraSettings = field(default_factory=CameraSettings)
    furnish: FurnishConfig = field(default_factory=FurnishConfig)
    finish: FinishConfig = field(default_factory=FinishConfig)
    light: LightConfig = field(default_factory=LightConfig)
    texture: TextureSettings = field(default_factory=TextureSettings)
    condition: ConditionConfig = field(default_factory=ConditionConfig)
    verify: VerifySettings = field(default_factory=VerifySettings)
    raster: RasterSettings = field(default_factory=RasterSettings)
    fit: FitSettings = field(default_factory=FitSettings)
    navigation: NavigationSettings = field(default_factory=NavigationSettings)
    evaluate: EvaluateConfig = field(default_factory=EvaluateConfig)
    report: ReportConfig = field(default_factory=ReportConfig, metadata=BESIDE)
    language: BackendSettings = field(default_factory=BackendSettings)
    image: BackendSettings = field(default_factory=BackendSettings)
    objects: BackendSettings = field(default_factory=BackendSettings)
    depth: BackendSettings = field(default_factory=BackendSettings)
    segmentation: BackendSettings = field(default_factory=BackendSettings)
    reconstruction: BackendSettings = field(default_factory=BackendSettings)
    answers: AnswersConfig = field(default_factory=AnswersConfig, metadata=BESIDE)
    budget: BudgetConfig = field(default_factory=BudgetConfig, metadata=BESIDE)
    prices: PricesConfig = field(default_factory=PricesConfig, metadata=BESIDE)
    variant: str = setting("full", "Name of the ablation, and of its part of the run folder: conf/variant/*.yaml.")
    preset: str = setting("standard", "Name of the size of the run: conf/preset/*.yaml.")
    seed: int = number(0, 0, 2**63 - 1, "Seed of everything random.")
    output: str | None = setting(None, "Run folder; None: Hydra's outputs/<scene>/<variant>/<seed>.", **BESIDE)
    reuse: bool = setting(
        True, "Take finished stages over from runs of other variants beside this one, where they are the same.", **BESIDE
    )
    overwrite: bool = setting(False, "A folder made by another configuration is refused unless this is true.", **BESIDE)
    export: list[str] = field(
        default_factory=list, metadata={"help": "What to write for other programs: python -m wm.export --help.", **BESIDE}
    )
    until: str = choice(STAGES[-1], STAGES, "Stage after which the run stops; the same command without it goes on.", **BESIDE)
    executor: str = choice("threads", ("threads",), "What rooms are fitted by, side by side.", **BESIDE)
    workers: int | None = number(
        None, 1, 1000, "Rooms fitted at once; None: one room per core.", null="one room per core", **BESIDE
    )
    debug: bool = setting(False, "Tracebacks instead of one-line errors.", **BESIDE)
