"""`SpeakingModel`: a language backend that asks a service. What a service's own dialect is, its `Dialect` knows."""

import dataclasses
from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

from wm.models.language.conversation import Conversation, plan_conversation, things_conversation
from wm.models.language.spoken_text import spoken_text
from wm.models.language.thing_names import ThingNamesError, thing_names
from wm.models.prompt_files import Prompts
from wm.services.faults import RefusedError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.services import Services
from wm.synth.backends import LanguageResult


@runtime_checkable
class Dialect(Protocol):
    """How one kind of service is asked."""

    @property
    def deciding(self) -> Mapping[str, Any]:
        """The settings that the answer depends on, by name."""
        ...

    def send(self, conversation: Conversation, *, seed: int) -> ServiceAnswer:
        """Sends a request once; as `Services.ask` wants it."""
        ...

    def text(self, answer: ServiceAnswer) -> str:
        """The text in an answer without refusal."""
        ...

    def close(self) -> None:
        """Closes connections."""
        ...


@dataclasses.dataclass(frozen=True, eq=False)
class SpeakingModel:
    """The backend. Several threads may ask at the same time.

    Args:
      backend: dotted path of the module that made it.
      model: as the service names it.
      dialect: of the service.
      prompts: of the model's family.
      paid: whether requests cost money.
      sees: whether the model takes images.
      at_once: requests that should be under way.
      services: what it asks through.
    """

    backend: str
    model: str
    dialect: Dialect
    prompts: Prompts
    paid: bool
    sees: bool
    at_once: int
    services: Services = dataclasses.field(default_factory=Services)

    def propose(self, theme: str, rooms: list[str], *, seed: int, violations: list[str], previous: str | None) -> LanguageResult:
        """A floor plan as text, as `wm.synth.backends.LanguageBackend` wants it."""
        answer = self._ask(plan_conversation(self.prompts, theme, rooms, violations, previous), seed)
        return LanguageResult(self._text(answer), {"model": self.model, **answer.record})

    def name_things(self, theme: str, room: str, rgb: np.ndarray | None, *, seed: int) -> list[str]:
        """Names of what stands in a room, as `wm.synth.backends.NamingBackend` wants them; a model that cannot see guesses.

        Raises:
          RefusedError: the model gave no list of names.
          ServiceError: it cannot be reached, or must not be asked any more.
        """
        answer = self._ask(things_conversation(self.prompts, theme, room, rgb if self.sees else None), seed)
        try:
            return thing_names(self._text(answer))
        except ThingNamesError as error:
            raise RefusedError(f"{self.model}: {error}") from error

    def with_services(self, services: Services) -> "SpeakingModel":
        """The same backend, which asks through these; they share connections."""
        return dataclasses.replace(self, services=services)

    def quote(self) -> Quote:
        """What one request is expected to cost."""
        return self.services.quote(self.model, at_once=self.at_once, paid=self.paid)

    def close(self) -> None:
        """Closes connections; the next request would open new ones."""
        self.dialect.close()

    def _ask(self, conversation: Conversation, seed: int) -> ServiceAnswer:
        content = {**conversation.content, **self.dialect.deciding, "seed": seed}
        request = ServiceRequest(backend=self.backend, model=self.model, content=content, paid=self.paid)
        return self.services.ask(request, lambda: self.dialect.send(conversation, seed=seed))

    def _text(self, answer: ServiceAnswer) -> str:
        return spoken_text(self.dialect.text(answer))
