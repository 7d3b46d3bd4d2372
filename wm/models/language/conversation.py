"""What a language model is told, in turns, and the schema that its answer should have."""

import base64
import dataclasses
import io
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import PIL.Image
from jaxtyping import Float, UInt8

from wm.geometry.plan.layout_schema import layout_schema
from wm.models.language.thing_names import MOST_THINGS, things_schema
from wm.models.prompt_files import Prompts


@dataclasses.dataclass(frozen=True)
class Turn:
    role: Literal["user", "assistant"]
    text: str


@dataclasses.dataclass(frozen=True, eq=False)
class Conversation:
    """One request to a language model: it is to write the next turn, as JSON."""

    system: str  # what it is told before all turns
    turns: tuple[Turn, ...]  # the last one is the user's
    name: str  # of the schema
    schema: Mapping[str, Any]  # JSON schema of the answer
    image: UInt8[np.ndarray, "h w 3"] | None = None  # goes with the first turn

    @property
    def content(self) -> dict[str, Any]:
        """All of it by name, as `wm.services.records.ServiceRequest` wants it."""
        turns = [[turn.role, turn.text] for turn in self.turns]
        told = {"system": self.system, "turns": turns, "schema": {"name": self.name, **self.schema}}
        return told if self.image is None else {**told, "image": self.image}


def plan_conversation(
    prompts: Prompts, theme: str, rooms: Sequence[str], violations: Sequence[str], previous: str | None
) -> Conversation:
    """The request for a floor plan; with `previous`, for a corrected one, as the third turn of a conversation.

    Args:
      prompts: of the model's family: plan_system, plan, plan_correction.
      theme: the scene in words.
      rooms: the names of the wanted rooms.
      violations: the rules that the last proposal broke.
      previous: the last proposal; None for none.
    """
    turns = [Turn("user", prompts.write("plan", theme=theme, rooms=list(rooms)))]
    if previous is not None:
        turns += [Turn("assistant", previous), Turn("user", prompts.write("plan_correction", violations=list(violations)))]
    return Conversation(prompts.write("plan_system"), tuple(turns), "floor_plan", layout_schema())


def things_conversation(prompts: Prompts, theme: str, room: str, rgb: Float[np.ndarray, "h w 3"] | None) -> Conversation:
    """The question what stands in a room, with an image of it in sRGB within [0, 1] where there is one.

    Args:
      prompts: of the model's family: things_system, things.
      theme: the scene in words.
      room: the name of the room.
      rgb: the image; None for none.
    """
    question = prompts.write("things", theme=theme, room=room, pictured=rgb is not None)
    image = None if rgb is None else np.round(np.clip(rgb, 0.0, 1.0) * 255).astype(np.uint8)
    system = prompts.write("things_system", most=MOST_THINGS)
    return Conversation(system, (Turn("user", question),), "things", things_schema(), image)


def png_text(image: UInt8[np.ndarray, "h w 3"]) -> str:
    """The image as a PNG file in base64, as services take it."""
    buffer = io.BytesIO()
    PIL.Image.fromarray(image).save(buffer, format="PNG")
    return base64.b64encode(buffer.getvalue()).decode()
