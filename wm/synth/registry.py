"""The registry of backends: a settings record names the module of its backend, and only that module is imported.

A backend is a module with

    make(settings, context) -> a backend that implements the protocol of its group (wm.synth.backends)
    Settings                -> its settings: a dataclass that extends wm.schema.BackendSettings; `backend` is the module's path
    VERSION                 -> a string that changes whenever its results change

and a YAML file with `backend: <path>` in the folder of its group: conf/image/, or image/ in the folder that `--config-dir` names.
The key of a stage whose result depends on a backend contains its path, its settings and its version. A module may also have

    PROVIDES                -> of an image backend: what its results contain beyond the protocol, such as DRAWN
    REQUIRES                -> what it needs from PROVIDES of the selected image backend
    USES                    -> the other groups of backends that it uses
    SERVED                  -> True if its backends ask a model through the run's services (ServedBackend); `make` then needs no
                               scene to say what a request costs
    secrets(settings)       -> names of the environment variables that its requests need; a run says at once which are not set
    heard(theme)            -> which words of a theme it uses and which it does not know (HeardTheme)
    reads(folder)           -> JSON values that stand for the files of a run folder that it reads, for the key of its stage
"""

import dataclasses
import importlib
import os
import pathlib
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Any

from wm.artifacts.digests import file_digest
from wm.errors import InputError
from wm.schema import BackendSettings, RunConfig
from wm.services.services import Services
from wm.synth.backends import (
    ClosableBackend,
    DepthBackend,
    HeardTheme,
    HearingModule,
    ImageBackend,
    LanguageBackend,
    ModelSettings,
    ObjectsBackend,
    ReconstructionBackend,
    SceneContext,
    SegmentationBackend,
    ServedBackend,
)

GROUPS: Mapping[str, type] = {
    "language": LanguageBackend,
    "image": ImageBackend,
    "objects": ObjectsBackend,
    "depth": DepthBackend,
    "segmentation": SegmentationBackend,
    "reconstruction": ReconstructionBackend,
}
"""Each group of backends with its protocol. Each group is a field of wm.schema.RunConfig and a folder of conf/."""

DRAWN = "drawn"
"""What an image backend provides whose results say what they show (`ImageResult.drawn_*`). Real models do not provide it."""


class BackendError(InputError):
    """A backend that cannot be used; the message names its path and what is expected."""


def backend_module(path: str) -> ModuleType:
    """The module of a backend, imported.

    Raises:
      BackendError: there is no such module, importing it fails, or it is not a backend.
    """
    if not path:
        raise BackendError("no backend is selected; a settings record of a backend module, or GROUP=NAME of conf/, selects one")
    try:
        module = importlib.import_module(path)
    except Exception as error:  # a foreign module may raise any exception while it is imported
        raise BackendError(f"backend {path!r} cannot be imported: {type(error).__name__}: {error}") from error
    missing = [name for name in ("make", "Settings", "VERSION") if not hasattr(module, name)]
    if missing:
        lacks = ", ".join(missing)
        raise BackendError(f"module {path!r} is no backend: it has no {lacks} (help('wm.synth.registry') says what they are)")
    settings = module.Settings
    if not (isinstance(settings, type) and issubclass(settings, BackendSettings) and settings().backend == path):
        wanted = f"with {path!r} as the default of its `backend`"
        raise BackendError(f"{path}.Settings must be a dataclass that extends wm.schema.BackendSettings, {wanted}")
    return module


def make_backend(
    group: str, settings: BackendSettings, context: SceneContext | None = None, services: Services | None = None
) -> Any:
    """The selected backend of a group.

    Args:
      group: one of GROUPS.
      settings: the Settings of the backend's module. A plain BackendSettings selects the defaults of that module.
      context: the scene; None for the language backend, which runs before there is a scene.
      services: what a ServedBackend asks through; None: kept nowhere and without limits.

    Raises:
      ValueError: there is no such group.
      BackendError: the module cannot be imported, the settings belong to another module, or `make` does not return a backend
        of the group.
    """
    if group not in GROUPS:
        raise ValueError(f"no group of backends is called {group!r}; groups: {', '.join(GROUPS)}")
    module = backend_module(settings.backend)
    backend = module.make(_own(settings, module), context)
    if not isinstance(backend, GROUPS[group]):
        wanted = sorted(name for name in vars(GROUPS[group]) if not name.startswith("_"))
        raise BackendError(
            f"{group} backend {settings.backend!r}: make() returned a {type(backend).__name__}, which has not all methods of "
            f"{GROUPS[group].__name__}: {', '.join(wanted)}"
        )
    return backend.with_services(services) if services is not None and isinstance(backend, ServedBackend) else backend


def backend_key(settings: BackendSettings, folder: pathlib.Path | None = None) -> tuple[Any, ...]:
    """The entries of a stage's key for a backend: its settings, which contain its path, its version, and what it reads: in the
    run folder, and in folders that its settings name."""
    module = backend_module(settings.backend)
    reads = [module.reads(folder)] if folder is not None and hasattr(module, "reads") else []
    return settings, module.VERSION, *reads, *_files_read(settings)


def is_served(settings: BackendSettings) -> bool:
    """Whether a backend asks a model through the run's services."""
    return getattr(backend_module(settings.backend), "SERVED", False)


def missing_secrets(settings: BackendSettings) -> list[str]:
    """Names of the environment variables that a backend's requests need and that are not set."""
    module = backend_module(settings.backend)
    needed = module.secrets(_own(settings, module)) if hasattr(module, "secrets") else []
    return [name for name in needed if not os.environ.get(name, "").strip()]


def close_backend(backend: Any) -> None:
    """Frees the resources of a backend, if it holds any."""
    if isinstance(backend, ClosableBackend):
        backend.close()


def model_settings(config: RunConfig, services: Services | None = None, folder: pathlib.Path | None = None) -> ModelSettings:
    """The settings of the models of a run, for an image-driven objects backend, and what these models ask through."""
    return ModelSettings(
        image=config.image, depth=config.depth, segmentation=config.segmentation, reconstruction=config.reconstruction,
        language=config.language, services=services, folder=folder,
    )  # fmt: skip


def heard_theme(config: RunConfig) -> HeardTheme | None:
    """What the backends that a run asks make of its theme, all of them together; None if none of them can tell.

    A word is unknown if it is to every backend that can tell.
    """
    theme = config.scene.theme
    asked = [config.image] + [config.objects] * config.furnish.enabled + [config.language] * (config.plan.file is None)
    modules = [backend_module(settings.backend) for settings in asked]
    answers = [module.heard(theme) for module in modules if isinstance(module, HearingModule)]
    if not answers:
        return None
    used, idle, unknown = (
        sorted({word for answer in answers for word in getattr(answer, kind)}, key=lambda word: (theme.lower().find(word), word))
        for kind in ("used", "idle", "unknown")
    )
    words = {word for phrase in used for word in phrase.split()}
    return HeardTheme(
        used=tuple(phrase for phrase in used if not any(phrase != other and f" {phrase} " in f" {other} " for other in used)),
        idle=tuple(word for word in idle if word not in words),
        unknown=tuple(word for word in unknown if all(word in answer.unknown for answer in answers)),
    )


def mismatch(group: str, settings: BackendSettings, image: BackendSettings) -> list[str]:
    """A list with an error message if a backend of this group needs more than the image backend provides, else an empty one."""
    needed = set(getattr(backend_module(settings.backend), "REQUIRES", ()))
    missing = needed - set(getattr(backend_module(image.backend), "PROVIDES", ()))
    if not missing:
        return []
    needs = f"{group} backend {settings.backend!r} needs what image backend {image.backend!r} does not tell"
    others = f"choose another {group}=NAME (wm --help {group} lists them), or an image=NAME that tells it"
    return [f"{needs} ({', '.join(sorted(missing))}): {others}"]


def unasked(config: RunConfig) -> list[str]:
    """A line for each group of models that lift furniture of which one was chosen that the run will not ask."""
    asked = _asked(config)
    idle = [group for group in ("depth", "segmentation", "reconstruction") if group not in asked]
    served = [group for group in idle if is_served(getattr(config, group))]
    return [f"the {group} model that is chosen is not asked in this run; objects=lifted asks it" for group in served]


def mismatches(config: RunConfig) -> list[str]:
    """Error messages for the backends, among those that the run will use, that do not suit the selected image backend."""
    asked = _asked(config)
    without = {"depth": "; verify.enabled=false paints without one"} if "depth" not in _furnishing(config) else {}
    return [
        fault + without.get(group, "")
        for group in GROUPS
        if group in asked
        for fault in mismatch(group, getattr(config, group), config.image)
    ]


def misplaced(config: RunConfig) -> Iterator[str]:
    """Error messages for the groups whose settings do not belong to the backend that they name."""
    for group in GROUPS:
        settings: BackendSettings = getattr(config, group)
        try:
            _own(settings, backend_module(settings.backend))
        except BackendError as error:
            yield f"{group}: {error}"


def _asked(config: RunConfig) -> set[str]:
    """The groups of backends beside language and image that a run asks: those of the furnish stage, and depth to verify by."""
    return _furnishing(config) | ({"depth"} if config.verify.enabled else set())


def _furnishing(config: RunConfig) -> set[str]:
    """The groups of backends that the furnish stage asks."""
    return {"objects", *getattr(backend_module(config.objects.backend), "USES", ())} if config.furnish.enabled else set()


def _files_read(settings: BackendSettings) -> Iterator[list[str]]:
    """Names and digests of the files in each folder that a field marked by `wm.schema.READ` names."""
    for field in dataclasses.fields(settings):
        folder = getattr(settings, field.name)
        if field.metadata.get("read") and folder is not None:
            root = pathlib.Path(folder).expanduser()
            yield [f"{path.relative_to(root)} {file_digest(path)}" for path in sorted(root.rglob("*")) if path.is_file()]


def _own(settings: BackendSettings, module: ModuleType) -> BackendSettings:
    """The settings as an instance of the module's own `Settings`."""
    if type(settings) is BackendSettings:
        return module.Settings()
    if not isinstance(settings, module.Settings):
        raise BackendError(
            f"settings of {type(settings).__module__} do not suit backend {settings.backend!r}; a YAML's `backend` chooses both, "
            "so GROUP=NAME is changed and not GROUP.backend"
        )
    return settings
