"""Anthropic's service: floor plans and names by Claude, as JSON that a schema constrains.

Answers are streamed, since a long one would otherwise leave the connection silent for minutes, and only what the service itself
calls complete (`end_turn`) is taken. The models draw their own samples and know no seed: another seed is another request.

Source: the SDK (anthropic 2.14), and https://platform.claude.com/docs/en/build-with-claude/structured-outputs.
"""

import dataclasses
import json
from collections.abc import Mapping
from typing import Any

from wm.bounds import choice, number, setting
from wm.models.access import optional_module, secret
from wm.models.http_client import LazyClient, http_client
from wm.models.http_faults import body_fault, sdk_fault
from wm.models.language.conversation import Conversation, png_text
from wm.models.language.speaking_model import SpeakingModel
from wm.models.prompt_files import Prompts, prompts_setting
from wm.schema import BESIDE, BackendSettings
from wm.services.faults import TransientError
from wm.services.records import ServiceAnswer
from wm.synth.backends import SceneContext

VERSION = "1"
SERVED = True
_EXTRA = "anthropic"
_KEY = "ANTHROPIC_API_KEY"
_DEFAULT = "default"
_MESSAGE = "message.json"


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """How Claude is asked. The key is read from ANTHROPIC_API_KEY."""

    backend: str = setting(__name__, "Claude, by Anthropic's service.")
    model: str = setting("claude-opus-5-5", "Name of the model, as the service knows it.")
    effort: str = choice(
        _DEFAULT, (_DEFAULT, "low", "medium", "high", "xhigh", "max"), "How much the model thinks; default: as it does by itself."
    )
    thinking: str = choice(
        _DEFAULT,
        (_DEFAULT, "adaptive", "between_tools", "disabled"),
        "When the model thinks; default: as it does by itself. Not every model takes each of these.",
    )
    max_tokens: int = number(64000, 256, 128000, "Tokens of an answer, thinking included; a longer one is cut, and of no use.")
    constrained: bool = setting(True, "Have the service keep to the JSON schema; False: only the prompt asks for it.")
    prompts: str | None = prompts_setting()
    base_url: str | None = setting(None, "Address of the service, without /v1; null: Anthropic's own.", **BESIDE)
    time_limit: float = number(900.0, 1, 86400, "Time after which a request is given up and sent again.", unit="s", **BESIDE)
    requests_at_once: int = number(8, 1, 256, "Requests that are under way at the same time.", **BESIDE)


def secrets(config: Settings) -> list[str]:
    """Names of the environment variables that hold what a request needs."""
    return [_KEY]


def make(config: Settings, context: SceneContext | None = None) -> SpeakingModel:
    """The backend. It does not use the scene.

    Raises:
      PromptError: a prompt of the user's cannot be used.
    """
    return SpeakingModel(
        backend=__name__,
        model=config.model,
        dialect=_Messages(config),
        prompts=Prompts("language/claude", config.prompts),
        paid=True,
        sees=True,
        at_once=config.requests_at_once,
    )


class _Messages:
    """The Messages API, as a `Dialect`."""

    def __init__(self, config: Settings):
        self._config = config
        self._client = LazyClient(self._make_client)

    @property
    def deciding(self) -> Mapping[str, Any]:
        names = ("effort", "thinking", "max_tokens", "constrained")
        return {name: getattr(self._config, name) for name in names}

    def send(self, conversation: Conversation, *, seed: int) -> ServiceAnswer:
        anthropic, httpx2 = optional_module("anthropic", _EXTRA), optional_module("httpx2", _EXTRA)
        arguments, key = self._arguments(conversation, anthropic), secret(_KEY)
        try:
            with self._client.get().messages.stream(**arguments) as stream:
                message = _message(stream, key)
        except (anthropic.APIError, httpx2.HTTPError, httpx2.InvalidURL) as error:
            raise sdk_fault(error, key=_KEY, secret=key) from None
        return _answer(message)

    def text(self, answer: ServiceAnswer) -> str:
        return _text(json.loads(answer.files[_MESSAGE]))

    def close(self) -> None:
        self._client.close()

    def _make_client(self) -> Any:
        config, anthropic = self._config, optional_module("anthropic", _EXTRA)
        key = secret(_KEY)
        client = http_client(config.time_limit)
        return anthropic.Anthropic(
            api_key=key, base_url=config.base_url, timeout=config.time_limit, max_retries=0, http_client=client
        )

    def _arguments(self, conversation: Conversation, anthropic: Any) -> dict[str, Any]:
        """What `messages.stream` is called with."""
        config, output, thinking = self._config, {}, {}
        if config.constrained:
            output["format"] = {"type": "json_schema", "schema": anthropic.transform_schema(dict(conversation.schema))}
        if config.effort != _DEFAULT:
            output["effort"] = config.effort
        if config.thinking != _DEFAULT:
            thinking["thinking"] = {"type": config.thinking}
        turns = [{"role": turn.role, "content": [{"type": "text", "text": turn.text}]} for turn in conversation.turns]
        if conversation.image is not None:
            source = {"type": "base64", "media_type": "image/png", "data": png_text(conversation.image)}
            turns[0]["content"].insert(0, {"type": "image", "source": source})
        told = {"model": config.model, "max_tokens": config.max_tokens, "system": conversation.system, "messages": turns}
        return {**told, **({"output_config": output} if output else {}), **thinking}


def _message(stream: Any, key: str) -> dict[str, Any]:
    """The whole message that a stream brings, as the API writes it.

    Raises:
      TransientError: it is no stream of the service, or ends before the message does.
      ServiceError: it is an error that no later try helps.
    """
    kind = stream.response.headers.get("content-type", "")
    if not kind.startswith("text/event-stream"):
        body = stream.response.read()
        if b'"error"' in body and kind.startswith("application/json"):
            raise body_fault(json.loads(body), key=_KEY, secret=key)
        raise TransientError(f"the reply is {kind or 'of no type'} and not a stream of events")
    try:
        begun = [event for event in stream if event.type == "message_start"]
    except (ValueError, RuntimeError) as error:  # what is no JSON; events that make no message
        raise TransientError(f"the reply is no stream of the service's events: {type(error).__name__}") from None
    if not begun or stream.current_message_snapshot.stop_reason is None:
        raise TransientError("the reply ended before the message did")
    return json.loads(stream.current_message_snapshot.to_json(indent=None))


def _answer(message: dict[str, Any]) -> ServiceAnswer:
    refusal = _refusal(message)
    return ServiceAnswer(
        files={} if refusal else {_MESSAGE: json.dumps(message).encode()},
        refusal=refusal,
        model_version=message["model"],
        response_id=message["id"],
        finish_reason=message["stop_reason"],
        usage=_usage(message["usage"]),
    )


def _refusal(message: dict[str, Any]) -> str:
    """Why a message is of no use; empty if it is."""
    reason = message["stop_reason"]
    if reason == "refusal":
        details = message.get("stop_details") or {}
        return f"the model refused to answer: {details.get('explanation') or details.get('category') or 'no reason given'}"
    if reason in ("max_tokens", "model_context_window_exceeded"):
        return f"the answer was cut ({reason}); a larger max_tokens, or a lower effort, leaves more room"
    if reason != "end_turn":
        return f"the answer stopped for another reason than its end ({reason})"
    return "" if _text(message).strip() else "the answer holds no text"


def _text(message: dict[str, Any]) -> str:
    """The first text of a message; thinking may come before it. Empty for none."""
    return next((block["text"] for block in message["content"] if block["type"] == "text"), "")


def _usage(usage: dict[str, Any]) -> dict[str, float]:
    inputs = ("input_tokens", "cache_creation_input_tokens", "cache_read_input_tokens")
    tokens = {"input_tokens": sum(usage.get(name) or 0 for name in inputs), "output_tokens": usage["output_tokens"]}
    return {"requests": 1.0, **{name: float(number) for name, number in tokens.items()}}
