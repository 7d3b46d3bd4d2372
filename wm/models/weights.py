"""Weights of local models: a folder, or a repository of the Hugging Face hub at one commit.

They are named by what they contain and not by where they lie, so that answers can be shared between machines. What is on this
machine is loaded without a request to the hub. Files are safetensors; pickles are not read.
"""

import contextlib
import dataclasses
import functools
import hashlib
import importlib
import pathlib
import re
import sys
from collections.abc import Iterator
from typing import Any

from wm.errors import InputError
from wm.models.access import optional_module
from wm.services.faults import ServiceError

_REPOSITORY = re.compile(r"[\w.-]+/[\w.-]+(@[\w.-]+)?")
_INDEX = ("model_index.json", "config.json")
"""Files of which a repository has at least one: that of a pipeline, that of a model."""


@dataclasses.dataclass(frozen=True)
class Weights:
    """Where weights come from, and which they are."""

    source: str  # a folder, or "owner/name" on the hub
    revision: str  # commit of the hub's repository; of a folder, 12 hex digits of a SHA-256 of all its files
    local: bool  # whether the source is a folder

    @property
    def name(self) -> str:
        """The same on every machine: "owner/name@commit", or the name of the folder and its digest."""
        return f"{pathlib.Path(self.source).name if self.local else self.source}@{self.revision}"


def find_weights(model: str, extra: str) -> Weights:
    """The weights that a setting `model` names: a folder, "owner/name@commit", or "owner/name" for the commit that this machine
    got last or, if it has none, the newest of the hub.

    Args:
      model: the setting.
      extra: the extra of wm that installs what looks the newest commit up.

    Raises:
      MissingExtraError: no commit is named, and it cannot be looked up.
      InputError: it is neither a folder nor the name of a repository.
      ServiceError: no commit is named, and the hub cannot tell the newest.
    """
    folder = pathlib.Path(model).expanduser()
    if model and folder.is_dir():
        return Weights(source=str(folder), revision=_folder_digest(folder.resolve()), local=True)
    if not _REPOSITORY.fullmatch(model):
        raise InputError(f"{model!r} is no folder here; a folder with weights, or OWNER/NAME@COMMIT of the hub, would be right")
    source, _, revision = model.partition("@")
    return Weights(source=source, revision=revision or _newest(source, extra), local=False)


def load_whole(kind: Any, weights: Weights, **options: Any) -> Any:
    """A model of class `kind` (of transformers, or a part of a pipeline of diffusers) in evaluation mode, with all its weights.

    Raises:
      ServiceError: the files cannot be loaded, or lack weights of the model, which would stay random.
    """
    model, told = load(kind, weights, output_loading_info=True, use_safetensors=True, **options)
    lacking = sorted(str(key) for key in [*told["missing_keys"], *told.get("mismatched_keys", ())])
    if lacking:
        raise ServiceError(
            f"{weights.name}: {len(lacking)} weights are missing, such as {lacking[0]}; a checkpoint of {kind.__name__} that was "
            "saved from the whole model would be right"
        )
    return model.eval()


def load(kind: Any, weights: Weights, **options: Any) -> Any:
    """`kind.from_pretrained`, from this machine if it has the files, else from the hub.

    Raises:
      ServiceError: the files are nowhere, cannot be read, or do not belong to `kind`.
    """
    _quiet()
    try:
        if not weights.local:
            return _from_hub(kind, weights, **options)
        with _offline():
            return kind.from_pretrained(weights.source, local_files_only=True, **options)
    except Exception as error:  # readers of files raise errors of many kinds
        hint = "" if weights.local else "; if the repository asks to accept its licence, do so on the hub and set HF_TOKEN"
        raise ServiceError(f"{weights.name} cannot be loaded as {kind.__name__}: {_first_line(error)}{hint}") from error


def _from_hub(kind: Any, weights: Weights, **options: Any) -> Any:
    """From the hub's cache on this machine, without a request; what is not there from the hub."""
    try:
        with _offline():
            return kind.from_pretrained(weights.source, revision=weights.revision, local_files_only=True, **options)
    except OSError:
        return kind.from_pretrained(weights.source, revision=weights.revision, **options)


@contextlib.contextmanager
def _offline() -> Iterator[None]:
    """No requests to the hub: `local_files_only` does not keep its library from asking what the calling program may be."""
    constants: Any = importlib.import_module("huggingface_hub.constants")
    before, constants.HF_HUB_OFFLINE = constants.HF_HUB_OFFLINE, True
    try:
        yield
    finally:
        constants.HF_HUB_OFFLINE = before


def _quiet() -> None:
    """No progress bars of loading, and no tables of what was loaded: `load_whole` says what is wrong. Downloads show theirs."""
    for name in ("transformers", "diffusers"):
        if name in sys.modules:
            sys.modules[name].logging.set_verbosity_error()
            sys.modules[name].logging.disable_progress_bar()


def _first_line(error: Exception) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]


def _newest(source: str, extra: str) -> str:
    """The commit of a repository that this machine got last; if it has none, that of the branch main on the hub."""
    hub, constants = (optional_module(name, extra) for name in ("huggingface_hub", "huggingface_hub.constants"))
    snapshots = pathlib.Path(constants.HF_HUB_CACHE, f"models--{source.replace('/', '--')}", "snapshots")
    here = [folder for folder in snapshots.glob("*") if any((folder / name).is_file() for name in _INDEX)]
    if here:
        return max(here, key=lambda folder: folder.stat().st_mtime).name
    try:
        return str(hub.HfApi().model_info(source, revision="main").sha)
    except Exception as error:  # of the hub, of its HTTP client, of the network
        raise ServiceError(
            f"{source} is not on this machine, and the hub cannot be asked for it ({_first_line(error)}); a folder with the "
            "weights, or a connection, is needed"
        ) from error


@functools.cache
def _folder_digest(folder: pathlib.Path) -> str:
    """12 hex digits, from the names and contents of all files but hidden ones."""
    sha = hashlib.sha256()
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = file.relative_to(folder)
        if any(part.startswith(".") for part in name.parts):
            continue
        with file.open("rb") as content:
            sha.update(f"{name.as_posix()}\0{hashlib.file_digest(content, 'sha256').hexdigest()}\n".encode())
    return sha.hexdigest()[:12]
