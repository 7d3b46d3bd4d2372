"""What servers need that stand for image services: the images of a request, and replies in the services' own form."""

import base64
import email
import email.policy
import io
from collections.abc import Callable
from typing import Any

import numpy as np
from PIL import Image
from skimage.transform import resize

from tests.models.loopback import Asked, Reply


def sent_images(asked: Asked) -> list[np.ndarray]:
    """The images of a request to either service, [h, w, 3] uint8."""
    if asked.path.endswith("/images/edits"):
        files = [part.get_payload(decode=True) for part in sent_fields(asked) if part.get_filename()]
    else:
        parts = [part["inlineData"] for part in asked.json["contents"][0]["parts"] if "inlineData" in part]
        files = [base64.urlsafe_b64decode(part["data"]) for part in parts]
    return [np.asarray(Image.open(io.BytesIO(file))) for file in files]


def sent_fields(asked: Asked) -> list[Any]:
    """The fields of a form."""
    head = f"content-type: {asked.headers['content-type']}\r\n\r\n".encode()
    return list(email.message_from_bytes(head + asked.body, policy=email.policy.HTTP).iter_parts())


def redrawn(image: np.ndarray, width: int, height: int) -> np.ndarray:
    """The same image in another size, by another library than the one that wm resamples with."""
    if image.shape[:2] == (height, width):
        return image
    drawn = resize(image, (height, width), order=1, anti_aliasing=True, preserve_range=True)
    return np.clip(np.round(drawn), 0, 255).astype(np.uint8)


def encoded(image: np.ndarray, kind: str = "PNG") -> bytes:
    file = io.BytesIO()
    Image.fromarray(image).save(file, kind, **({"quality": 95} if kind == "JPEG" else {"compress_level": 1}))
    return file.getvalue()


def gemini_reply(content: bytes, mime: str = "image/png") -> Reply:
    """An image as Gemini answers it, after a thought with an interim image."""
    interim = {"inlineData": {"mimeType": "image/png", "data": _text(encoded(np.zeros((8, 8, 3), np.uint8)))}, "thought": True}
    parts = [interim, {"inlineData": {"mimeType": mime, "data": _text(content)}}]
    usage = {"promptTokenCount": 2500, "candidatesTokenCount": 1120, "thoughtsTokenCount": 300}
    usage["candidatesTokensDetails"] = [{"modality": "IMAGE", "tokenCount": 1120}]
    candidate = {"content": {"role": "model", "parts": parts}, "finishReason": "STOP"}
    return Reply(
        body={"candidates": [candidate], "usageMetadata": usage, "modelVersion": "gemini-3-pro-image", "responseId": "answer-1"}
    )


def openai_reply(content: bytes) -> Reply:
    """An image as the images endpoint answers it."""
    details = {"input_tokens_details": {"image_tokens": 2400, "text_tokens": 300}}
    usage = {"input_tokens": 2700, "output_tokens": 1756, "total_tokens": 4456, **details}
    return Reply(
        body={"created": 1, "data": [{"b64_json": _text(content)}], "usage": usage}, headers={"x-request-id": "answer-1"}
    )


def drawing(reply: Callable[[bytes], Reply], size: Callable[[int, int], tuple[int, int]] = lambda w, h: (w, h)):
    """What a server answers that draws what it is sent, in the size that `size` makes of the guide's."""

    def answer(asked: Asked) -> Reply:
        guide = sent_images(asked)[0]
        return reply(encoded(redrawn(guide, *size(guide.shape[1], guide.shape[0]))))

    return answer


def _text(content: bytes) -> str:
    return base64.b64encode(content).decode()
