"""Models in this process: loaded once, asked one call at a time, freed by the last that uses them."""

import gc
import threading
import time
import weakref

import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("transformers")

from wm.errors import InputError  # noqa: E402 - after what it needs
from wm.models.local_model import LocalModel, LocalSettings  # noqa: E402
from wm.services.faults import MissingExtraError, ServiceError  # noqa: E402


class Weighty:
    """A model. It holds itself, as models do."""

    loads = 0

    def __init__(self, weights, device, dtype, *options):
        Weighty.loads += 1
        self.told = (weights.name, device, dtype, options)
        self.itself = self


@pytest.fixture
def model(tmp_path):
    (tmp_path / "rooms").mkdir()
    (tmp_path / "rooms" / "config.json").write_text("{}")
    Weighty.loads = 0
    made = []

    def make(load=Weighty, options=(), packages=(), **settings):
        chosen = {"model": str(tmp_path / "rooms"), "device": "cpu", **settings}
        made.append(LocalModel(LocalSettings(**chosen), load, extra="depth", options=options, packages=packages))
        return made[-1]

    yield make
    for each in made:
        each.close()


def test_nothing_is_loaded_before_it_is_asked_and_then_once(model):
    rooms = model(options=("a", 1), dtype="bfloat16")
    assert rooms.name.startswith("rooms@") and Weighty.loads == 0
    assert rooms.run(lambda held: held.told) == (rooms.name, "cpu", torch.bfloat16, ("a", 1))
    rooms.run(lambda held: held)
    assert Weighty.loads == 1


def test_equal_models_share_a_copy_until_the_last_is_closed(model):
    first, second, other = model(), model(), model(dtype="float16")
    held = weakref.ref(first.run(lambda held: held))
    assert second.run(lambda held: held) is held()
    assert other.run(lambda held: held) is not held()
    first.close()
    first.close()
    gc.collect()
    assert held() is not None
    second.close()
    assert held() is None
    assert second.run(lambda held: held.told) and Weighty.loads == 3


def test_all_models_are_asked_one_call_at_a_time(model):
    under_way, most = [], []

    def work(held):
        under_way.append(held)
        most.append(len(under_way))
        time.sleep(0.01)
        under_way.pop()

    models = [model(), model(dtype="float16")]
    threads = [threading.Thread(target=models[k % 2].run, args=(work,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 8 and Weighty.loads == 2


def test_no_gradients_are_kept(model):
    assert not model().run(lambda held: torch.ones(2, requires_grad=True) * 2).requires_grad


def test_memory_that_does_not_suffice_is_one_error(model):
    def work(held):
        raise torch.OutOfMemoryError("CUDA out of memory")

    with pytest.raises(ServiceError, match=r"rooms@\w{12}: the memory of the device does not suffice; dtype=bfloat16"):
        model().run(work)


def test_what_cannot_be_loaded_is_tried_again(model):
    failures = [ServiceError("gone")]

    def load(*told):
        if failures:
            raise failures.pop()
        return told

    rooms = model(load)
    with pytest.raises(ServiceError, match="gone"):
        rooms.run(len)
    rooms.close()
    assert rooms.run(len) == 3


@pytest.mark.parametrize("device", [name for name in ("cuda", "mps") if not getattr(torch, name).is_available()])
def test_a_device_that_is_not_there_is_named(model, device):
    with pytest.raises(InputError, match=f"device={device}: torch sees no such device here; it sees: .*cpu"):
        model(device=device).run(len)


def test_a_missing_package_is_named_with_what_installs_it(model):
    with pytest.raises(MissingExtraError, match=r"no_such_package is not installed: pip install 'wm\[depth\]'"):
        model(packages=("no_such_package",)).run(len)
