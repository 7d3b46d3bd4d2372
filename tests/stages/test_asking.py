"""What a run asks of a model that is paid: said before it costs, stopped at a limit, never asked twice, counted by stage."""

import base64
import collections
import dataclasses
import json
import sys
import types
import urllib.request

import numpy as np
import pytest

from tests.models.loopback import Asked, Loopback, Reply
from tests.test_pipeline import SMALL
from wm import pipeline
from wm.bounds import setting
from wm.cli.composition import load_config
from wm.codecs import decode_png, encode_png
from wm.color import to_bytes
from wm.errors import ArtifactError
from wm.schema import BackendSettings, BudgetConfig, PricesConfig
from wm.services.faults import BudgetError, ReplayError
from wm.services.prices import Price
from wm.services.records import ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.stages.asking import announcement, expected, open_services
from wm.synth.backends import ImageResult


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    backend: str = setting("paid_image", "A model behind a loopback server.")
    url: str = setting("", "Where it is.")


class PaidImage:
    """Sends its condition, and gets it back in another tint."""

    def __init__(self, config, services=None):
        self.config, self.services = config, services or Services()

    def with_services(self, services):
        return PaidImage(self.config, services)

    def quote(self):
        return self.services.quote("tint-1", at_once=2)

    def generate(self, request):
        picture = to_bytes(request.condition.rgb)
        content = {"prompt": request.prompt, "seed": request.seed, "condition": picture}

        def send():
            body = json.dumps({"seed": request.seed, "image": base64.b64encode(encode_png(picture)).decode()}).encode()
            with urllib.request.urlopen(self.config.url, data=body) as reply:
                return ServiceAnswer(files={"image.png": reply.read()}, model_version="tint-1.2", usage={"images": 1})

        answer = self.services.ask(ServiceRequest(backend="paid_image", model="tint-1", content=content), send)
        rgb = decode_png(answer.files["image.png"]).astype(np.float32) / np.float32(255)
        return ImageResult(rgb=rgb, record={"model": "tint-1", **answer.record})


@pytest.fixture
def paid_image(monkeypatch):
    module = types.ModuleType("paid_image")
    vars(module).update(make=lambda config, context: PaidImage(config), Settings=Settings, VERSION="1", SERVED=True)
    monkeypatch.setitem(sys.modules, "paid_image", module)


def tinted(asked: Asked) -> Reply:
    image = decode_png(base64.b64decode(asked.json["image"]))
    return Reply(body=encode_png(image // 2 + 60))


def configured(tmp_path, url: str, **changes):
    prices = PricesConfig(as_of="2026-11-30", models={"tint": Price(image=0.25, usage={"images": 1.0}, seconds=4.0)})
    small = [argument for argument in SMALL if not argument.startswith("image.")]
    config = load_config([*small, f"answers.folder={tmp_path / 'answers'}", "verify.enabled=false", "until=paint"])
    return dataclasses.replace(config, image=Settings(url=url), prices=prices, **changes)


def test_a_run_stops_at_its_budget_and_goes_on_without_asking_twice(tmp_path, paid_image, capsys):
    with Loopback(tinted) as server:
        with pytest.raises(BudgetError, match=r"budget\.requests=2 is reached"):
            pipeline.run(configured(tmp_path, server.url, budget=BudgetConfig(requests=2)), tmp_path / "run")
        assert len(server.asked) == 2
        pipeline.run(configured(tmp_path, server.url), tmp_path / "run")
        said = capsys.readouterr().out
        views = sorted((tmp_path / "run/views").rglob("*[0-9].json"))
        asked = collections.Counter(request.body for request in server.asked)
        assert len(asked) == len(views) > 2 and set(asked.values()) == {1}
        replayed = configured(tmp_path, server.url)
        replayed.answers.replay = "only"
        pipeline.run(replayed, tmp_path / "elsewhere")
        assert len(server.asked) == len(views)
    for view in views:
        assert (tmp_path / "elsewhere" / view.relative_to(tmp_path / "run")).read_bytes() == view.read_bytes()
    made_by = json.loads(views[0].read_text())["painted"]["made_by"]
    assert made_by["model_version"] == "tint-1.2" and made_by["prompt"].startswith("A photograph") and "seed" in made_by
    entries = json.loads((tmp_path / "run/manifest.json").read_text())["entries"]
    notes = [entry["note"] for name, entry in entries.items() if name.startswith("paint/")]
    assert all(note["model"] == "tint-1" and note["backend"] == "paid_image" for note in notes) and len(notes) == len(views)
    row = json.loads((tmp_path / "run/timings.json").read_text())["paint"]
    assert row["paid_requests"] == len(views) and row["usd"] == 0.25 * len(views)
    assert said.count("before models are paid (prices of 2026-11-30") == 2  # of the run that stopped, and of the one that went on
    assert f"paint  tint-1  {len(views)} requests" in said and "limited by budget.requests=2" in said
    assert f"paid to models: {len(views)} requests, {0.25 * len(views):.2f} USD: paint {len(views)} for" in said


def test_nothing_is_sent_where_only_kept_answers_may_be_used(tmp_path, paid_image):
    with Loopback(tinted) as server:
        config = configured(tmp_path, server.url)
        config.answers.replay = "only"
        with pytest.raises(ReplayError):
            pipeline.run(config, tmp_path / "run")
        assert not server.asked


def test_the_estimate_counts_attempts_and_what_is_side_by_side(tmp_path, paid_image):
    config = configured(tmp_path, "http://127.0.0.1:9")
    services = Services(prices=pipeline.open_services(config, tmp_path).prices, stage="plan")
    (row,) = expected(config, services)
    assert (row.stage, row.requests, row.usd, row.seconds) == ("paint", 5, 1.25, 20.0)  # one room: one request after the other
    config.scene.rooms = ["bedroom", "hall", "study"]
    (row,) = expected(config, services)
    assert (row.requests, row.seconds) == (3 * 5 + 2 * 2, 40.0)  # two doors, and two of the three rooms at the same time
    config.verify.enabled = True
    services.views = 10
    (row,) = expected(config, services)
    assert row.requests == 15
    assert "3.75 USD in all; no limit is set (budget.usd, budget.requests)" in announcement(config, services)
    services.stage = "report"
    assert not [line for line in announcement(config, services).splitlines() if line.startswith("paint")]


def test_plans_follow_one_another_so_their_time_adds_up(tmp_path, paid_image, monkeypatch):
    monkeypatch.setattr(PaidImage, "propose", PaidImage.generate, raising=False)  # it may then pass for a language model
    config = configured(tmp_path, "http://127.0.0.1:9")
    config.language = config.image
    services = Services(prices=pipeline.open_services(config, tmp_path).prices, stage="plan")
    plan, _ = expected(config, services)
    assert (plan.stage, plan.requests, plan.seconds) == ("plan", 2, 8.0)


def test_the_cost_is_said_again_only_where_it_is_known_better(tmp_path, paid_image, capsys):
    services = pipeline.open_services(configured(tmp_path, "http://127.0.0.1:9"), tmp_path)
    for services.stage in ("plan", "furnish", "paint"):
        services.announce()
    assert capsys.readouterr().out.count("before models are paid") == 1
    services.views = 3
    services.announce()
    assert "paint  tint-1  3 requests" in capsys.readouterr().out


def test_a_run_that_goes_on_says_how_much_of_its_budget_is_spent(tmp_path, paid_image):
    config = configured(tmp_path, "http://127.0.0.1:9", budget=BudgetConfig(usd=2.0, requests=9))
    services = pipeline.open_services(config, tmp_path)
    services.stage = "paint"
    assert "limited by budget.usd=2 and budget.requests=9" in announcement(config, services)
    row = {"key": "k", "stage": "plan", "backend": "lab", "model": "m", "usd": 0.001, "paid": True, "seconds": 1.0}
    services.ledger.add(row)
    said = "limited by budget.usd=2 (less than 0.01 USD spent) and budget.requests=9 (1 spent)"
    assert said in announcement(config, services)


def test_keys_that_are_not_set_are_named_before_anything_is_paid(tmp_path, paid_image, monkeypatch):
    vars(sys.modules["paid_image"])["secrets"] = lambda config: ["PAINTERS_KEY", "OTHER_KEY"]
    monkeypatch.setenv("OTHER_KEY", "a key")
    config = configured(tmp_path, "http://127.0.0.1:9")
    services = pipeline.open_services(config, tmp_path)
    services.stage = "plan"
    said = announcement(config, services)
    assert said.endswith("\npaint will stop: the environment variable PAINTERS_KEY is not set") and "OTHER_KEY" not in said
    monkeypatch.setenv("PAINTERS_KEY", "another")
    assert "will stop" not in announcement(config, services) and "another" not in announcement(config, services)


def test_an_offline_run_asks_nothing_and_leaves_nothing(tmp_path):
    config = load_config([*SMALL, f"answers.folder={tmp_path / 'answers'}", "until=paint"])
    pipeline.run(config, tmp_path / "run")
    assert not (tmp_path / "answers").exists() and not (tmp_path / "run/requests.jsonl").exists()
    assert not list(expected(config, Services(stage="plan")))


def test_what_is_paid_is_not_written_through_a_link(tmp_path):
    """The file grows and is not replaced: a folder from elsewhere must not choose which file it is."""
    run, outside = tmp_path / "run", tmp_path / "outside.txt"
    run.mkdir()
    outside.write_text("mine\n")
    (run / "requests.jsonl").symlink_to(outside)
    with pytest.raises(ArtifactError, match="link"):
        open_services(load_config(["+scene=gothic"]), run)
    assert outside.read_text() == "mine\n"
