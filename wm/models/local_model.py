"""`LocalModel`: a PyTorch model in this process, loaded when it is first asked and freed when nobody needs it any more.

Backends with the same weights and options share one copy. All local models are asked one call at a time, since they share one
device and its memory. Runs of the same code on the same device give equal results: nothing is drawn but from the seeds of
requests, and cuDNN is held to deterministic kernels.
"""

import dataclasses
import functools
import gc
import threading
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from wm.bounds import choice, setting
from wm.errors import InputError
from wm.models.access import optional_module
from wm.models.weights import Weights, find_weights
from wm.schema import BESIDE, BackendSettings
from wm.services.faults import ServiceError

T = TypeVar("T")
R = TypeVar("R")
WEIGHTS = "Weights: a folder, or OWNER/NAME@COMMIT of the Hugging Face hub."
"""What every setting `model` of a local model says of itself."""
_WHERE = "Device that computes; auto: a CUDA GPU, else Apple's, else the CPU."


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class LocalSettings(BackendSettings):
    """What every backend of a local model has, beside its own knobs."""

    model: str = setting("", WEIGHTS)
    device: str = choice("auto", ("auto", "cuda", "mps", "cpu"), _WHERE, **BESIDE)
    dtype: str = choice("float32", ("float32", "bfloat16", "float16"), "Type of the weights and of the arithmetic.")


@dataclasses.dataclass
class _Loaded:
    model: Any
    users: int


_ONE_AT_A_TIME = threading.RLock()
_LOADED: dict[tuple[Any, ...], _Loaded] = {}


class LocalModel(Generic[T]):
    """A model by its settings. Nothing is imported, read or loaded before it is asked.

    Args:
      settings: weights, device and type.
      load: loads it, given the weights, the device (such as "cuda"), the torch.dtype, and `options`.
      extra: the extra of wm that installs what it needs.
      packages: what it needs, beside torch and transformers.
      options: what else `load` is given, hashable.
    """

    def __init__(
        self,
        settings: LocalSettings,
        load: Callable[..., T],
        *,
        extra: str,
        packages: tuple[str, ...] = (),
        options: tuple[Any, ...] = (),
    ):
        self.settings, self._load, self._extra = settings, load, extra
        self._packages, self._options = ("torch", "transformers", *packages), options
        self._key: tuple[Any, ...] | None = None  # of the copy that this one uses

    @functools.cached_property
    def weights(self) -> Weights:
        """Which weights these are. A folder is read once for it; a commit that is named is not looked up.

        Raises:
          InputError, MissingExtraError, ServiceError: see `find_weights`.
        """
        return find_weights(self.settings.model, self._extra)

    @property
    def name(self) -> str:
        """The model in requests: the same on every machine that has these weights."""
        return self.weights.name

    @property
    def title(self) -> str:
        """The model for a reader, without its commit. Nothing is looked up."""
        return self.settings.model.partition("@")[0]

    def run(self, work: Callable[[T], R]) -> R:
        """What `work` returns of the model, while no other local model works.

        Raises:
          MissingExtraError: a package is not installed.
          InputError: the device is not there.
          ServiceError: the weights cannot be loaded, or the memory of the device does not suffice.
        """
        torch = self._import()
        with _ONE_AT_A_TIME, torch.no_grad(), torch.backends.cudnn.flags(enabled=True, benchmark=False, deterministic=True):
            try:
                return work(self._held(torch).model)
            except torch.OutOfMemoryError as error:
                raise ServiceError(
                    f"{self.name}: the memory of the device does not suffice; dtype=bfloat16, offload=model where a backend has "
                    "it, smaller images, or device=cpu need less"
                ) from error

    def _import(self) -> Any:
        """torch, once everything that is needed has been found."""
        modules = [optional_module(name, self._extra) for name in self._packages]
        return modules[0]

    def _held(self, torch: Any) -> _Loaded:
        if self._key is None:
            device, dtype = device_of(self.settings.device, torch), getattr(torch, self.settings.dtype)
            key = (self._load, self.name, device, dtype, self._options)
            if key not in _LOADED:
                _LOADED[key] = _Loaded(self._load(self.weights, device, dtype, *self._options), 0)
            _LOADED[key].users += 1
            self._key = key
        return _LOADED[self._key]

    def close(self) -> None:
        """Frees the model, unless another backend uses it as well. Asking again loads it again."""
        with _ONE_AT_A_TIME:
            key, self._key = self._key, None
            if key is None:
                return
            _LOADED[key].users -= 1
            if not _LOADED[key].users:
                del _LOADED[key]
                _give_memory_back(self._import())


def device_of(wanted: str, torch: Any) -> str:
    """The device that a setting `device` means on this machine.

    Args:
      wanted: auto | cuda | mps | cpu.
      torch: the module.

    Raises:
      InputError: it is not there.
    """
    there = {"cuda": torch.cuda.is_available(), "mps": torch.backends.mps.is_available(), "cpu": True}
    if wanted == "auto":
        return next(name for name, available in there.items() if available)
    if not there[wanted]:
        names = ", ".join(name for name, available in there.items() if available)
        raise InputError(f"device={wanted}: torch sees no such device here; it sees: {names}")
    return wanted


def _give_memory_back(torch: Any) -> None:
    gc.collect()  # models hold themselves in cycles
    if torch.cuda.is_available():
        torch.cuda.empty_cache()
    if torch.backends.mps.is_available():
        torch.mps.empty_cache()
