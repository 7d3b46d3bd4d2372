"""An image model on a server of this machine: it gets condition, style reference and prompt over HTTP, and tints the condition.

The client is a backend of the group `image` as wm/models holds them: it asks through `Services`, so answers are kept, and several
threads may call it. The server waits before each reply, as a model that computes elsewhere does.
"""

import base64
import dataclasses
import http.client
import json
import threading
import urllib.parse

import numpy as np

from tests.models.loopback import Asked, Loopback, Reply
from wm.bounds import number, setting
from wm.codecs import decode_png, encode_png, to_bytes
from wm.schema import BackendSettings
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import ImageRequest, ImageResult, SceneContext

VERSION = "1"
MODEL = "tinting-1"


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """Where the server is, and how much it is asked at once."""

    backend: str = setting(__name__, "The tinting model.")
    url: str = setting("", "Address of the server.", identity=False)
    requests_at_once: int = number(8, 1, 1000, "Requests under way at the same time.", identity=False)


@dataclasses.dataclass(frozen=True)
class TintedImages:
    """The client."""

    config: Settings
    services: Services = dataclasses.field(default_factory=Services)

    @property
    def at_once(self) -> int:
        return self.config.requests_at_once

    def with_services(self, services: Services) -> "TintedImages":
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        return self.services.quote(MODEL, at_once=self.at_once)

    def generate(self, request: ImageRequest) -> ImageResult:
        """The tinted condition. `drawn_depth` is what TrueDepth knows."""
        images = {"condition": encode_png(to_bytes(request.condition.rgb))}
        if request.reference is not None:
            images["reference"] = encode_png(to_bytes(request.reference))
        told = {"prompt": request.prompt, "seed": request.seed, "view": request.view.name}
        asked = ServiceRequest(backend=__name__, model=MODEL, content={**told, **images})
        answer = self.services.ask(asked, lambda: self._send(asked.key, told, images))
        rgb = decode_png(answer.files["image.png"]).astype(np.float32) / 255
        return ImageResult(rgb=rgb, drawn_depth=request.condition.depth, record=answer.record)

    def _send(self, key: str, told: dict, images: dict[str, bytes]) -> ServiceAnswer:
        body = json.dumps({"key": key, **told, **{name: base64.b64encode(data).decode() for name, data in images.items()}})
        connection = http.client.HTTPConnection(urllib.parse.urlsplit(self.config.url).netloc, timeout=120)
        try:
            connection.request("POST", "/images", body, {"content-type": "application/json"})
            reply = json.loads(connection.getresponse().read())
        finally:
            connection.close()
        return ServiceAnswer(files={"image.png": base64.b64decode(reply["image"])}, response_id=key, usage={"images": 1})


@dataclasses.dataclass(frozen=True)
class TrueDepth:
    """A depth model on a device of its own, which costs the host nothing: the drawn depth in another unit."""

    at_once: int = 8

    def estimate(self, result: ImageResult, *, camera: object, seed: int) -> np.ndarray | None:
        return None if result.drawn_depth is None else 2 * result.drawn_depth + np.float32(0.1)


def make(config: Settings, context: SceneContext) -> TintedImages:
    """The image backend."""
    return TintedImages(config)


class TintingServer(Loopback):
    """The model. It counts the requests under way, and those of which it has sent the last byte, by their key."""

    def __init__(self, seconds: float):
        super().__init__(self._tinted)
        self._server.handle_error = lambda request, client: None  # a client that was killed
        self.seconds = seconds
        self.under_way = self.most = 0
        self._guard = threading.Lock()

    def _tinted(self, asked: Asked) -> Reply:
        told = asked.json
        with self._guard:
            self.under_way += 1
            self.most = max(self.most, self.under_way)
        rgb = decode_png(base64.b64decode(told["condition"])).astype(np.float32) / 255
        tint = np.random.default_rng(told["seed"]).uniform(0.9, 1.1, 3)
        body = {"image": base64.b64encode(encode_png(to_bytes(rgb * tint))).decode()}
        threading.Timer(self.seconds, self._ended).start()
        return Reply(body=body, wait=self.seconds)

    def _ended(self) -> None:
        with self._guard:
            self.under_way -= 1

    def keys(self) -> list[str]:
        """Of the requests whose whole reply was sent, in that order."""
        return [asked.json["key"] for asked in self.delivered]
