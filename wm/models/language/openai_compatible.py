"""Any server of OpenAI's chat completions: the service itself, or vLLM, llama.cpp, Ollama and others on a machine of one's own.

Presets of conf/language differ in settings only. Servers differ in how an answer is held to a JSON schema (`constraint`); a plan
is read whatever stands around it, and checked, so that "none" works too, with more rounds.

Source: the SDK (openai 3.57); https://docs.vllm.ai/en/latest/features/structured_outputs/ for vLLM's own field, which replaced
`guided_json` in version 0.12; https://docs.ollama.com/api/openai-compatibility.
"""

import dataclasses
import json
import re
from collections.abc import Callable, Mapping
from typing import Any

from wm.bounds import choice, number, setting
from wm.errors import InputError
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
_EXTRA = "openai"
_COMPLETION = "completion.json"
_NO_KEY = "none"
"""What servers without keys are sent, since the SDK wants one."""

_CONSTRAINTS: Mapping[str, Callable[[str, Mapping[str, Any]], dict[str, Any]]] = {
    "none": lambda name, schema: {},
    "json_schema": lambda name, schema: {
        "response_format": {"type": "json_schema", "json_schema": {"name": name, "strict": True, "schema": schema}}
    },
    "json_object": lambda name, schema: {"response_format": {"type": "json_object"}},
    "structured_outputs": lambda name, schema: {"extra_body": {"structured_outputs": {"json": schema}}},
    "guided_json": lambda name, schema: {"extra_body": {"guided_json": schema}},
}
"""What a request says, by the values of the setting `constraint`, from the name of a schema and the schema."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """How the server is asked."""

    backend: str = setting(__name__, "A server of OpenAI's chat dialect.")
    model: str = setting("gpt-6.1-sol", "Name of the model, as the server knows it; kept answers belong to it.")
    base_url: str | None = setting(None, "Address of the server, with /v1; null: OpenAI's own.", **BESIDE)
    key: str = setting("OPENAI_API_KEY", "Environment variable that holds the key; empty: the server wants none.", **BESIDE)
    paid: bool = setting(True, "Whether requests cost money; False: a server of your own.", **BESIDE)
    sees: bool = setting(True, "Whether the model takes images.")
    constraint: str = choice(
        "json_schema",
        tuple(_CONSTRAINTS),
        "How answers are held to the JSON schema: json_schema (response_format), structured_outputs (vLLM), guided_json (vLLM "
        "before 0.12), json_object (any JSON), none.",
    )
    effort: str | None = setting(None, "How much the model thinks, such as low; null: as it does by itself.")
    temperature: float | None = number(None, 0.0, 2.0, "Of the samples.", null="the server's own")
    seeded: bool = setting(False, "Send the seed; servers of one's own take it, and give equal answers to equal requests.")
    max_tokens: int | None = number(None, 256, 10**6, "Tokens of an answer, thinking included.", null="the server's own")
    max_tokens_field: str = choice("max_completion_tokens", ("max_completion_tokens", "max_tokens"), "How the server calls it.")
    prompts: str | None = prompts_setting()
    time_limit: float = number(900.0, 1, 86400, "Time after which a request is given up and sent again.", unit="s", **BESIDE)
    requests_at_once: int = number(8, 1, 256, "Requests that are under way at the same time.", **BESIDE)


def secrets(config: Settings) -> list[str]:
    """Names of the environment variables that hold what a request needs."""
    return [config.key] if config.key else []


def make(config: Settings, context: SceneContext | None = None) -> SpeakingModel:
    """The backend. It does not use the scene.

    Raises:
      PromptError: a prompt of the user's cannot be used.
      InputError: `key` is no name of an environment variable.
    """
    if config.key and not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", config.key):
        raise InputError("the setting key is the name of an environment variable, such as OPENAI_API_KEY, and not the key itself")
    return SpeakingModel(
        backend=__name__,
        model=config.model,
        dialect=_Completions(config),
        prompts=Prompts("language/openai_compatible", config.prompts),
        paid=config.paid,
        sees=config.sees,
        at_once=config.requests_at_once,
    )


class _Completions:
    """Chat completions, as a `Dialect`."""

    def __init__(self, config: Settings):
        self._config = config
        self._client = LazyClient(self._make_client)

    @property
    def deciding(self) -> Mapping[str, Any]:
        names = ("constraint", "effort", "temperature", "max_tokens")
        return {name: getattr(self._config, name) for name in names}

    def send(self, conversation: Conversation, *, seed: int) -> ServiceAnswer:
        openai, httpx2 = optional_module("openai", _EXTRA), optional_module("httpx2", _EXTRA)
        arguments, key = self._arguments(conversation, seed), self._key()
        faults = {"key": self._config.key or "(none)", "secret": key}
        try:
            reply = self._client.get().chat.completions.with_raw_response.create(**arguments).http_response.content
        except (openai.APIError, httpx2.HTTPError, httpx2.InvalidURL) as error:
            raise sdk_fault(error, **faults) from None
        completion = _decoded(reply)
        if completion.get("error") and not completion.get("choices"):
            raise body_fault(completion, **faults)
        return _answer(completion, reply)

    def text(self, answer: ServiceAnswer) -> str:
        return json.loads(answer.files[_COMPLETION])["choices"][0]["message"]["content"]

    def close(self) -> None:
        self._client.close()

    def _make_client(self) -> Any:
        config, openai = self._config, optional_module("openai", _EXTRA)
        key, client = self._key(), http_client(config.time_limit)
        return openai.OpenAI(api_key=key, base_url=config.base_url, timeout=config.time_limit, max_retries=0, http_client=client)

    def _key(self) -> str:
        return secret(self._config.key) if self._config.key else _NO_KEY

    def _arguments(self, conversation: Conversation, seed: int) -> dict[str, Any]:
        """What `chat.completions.create` is called with."""
        config = self._config
        turns: list[dict[str, Any]] = [{"role": turn.role, "content": turn.text} for turn in conversation.turns]
        if conversation.image is not None:
            picture = {"type": "image_url", "image_url": {"url": f"data:image/png;base64,{png_text(conversation.image)}"}}
            turns[0]["content"] = [picture, {"type": "text", "text": turns[0]["content"]}]
        told = {"model": config.model, "messages": [{"role": "system", "content": conversation.system}, *turns]}
        optional = {
            config.max_tokens_field: config.max_tokens,
            "reasoning_effort": config.effort,
            "temperature": config.temperature,
            "seed": seed % 2**31 if config.seeded else None,
        }
        constraint = _CONSTRAINTS[config.constraint](conversation.name, conversation.schema)
        return {**told, **{name: value for name, value in optional.items() if value is not None}, **constraint}


def _decoded(reply: bytes) -> dict[str, Any]:
    """The JSON object of a reply with status 200. Raises: TransientError for anything else."""
    try:
        value = json.loads(reply)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise TransientError("the reply is no JSON object, and so none of the service")
    return value


def _answer(completion: dict[str, Any], reply: bytes) -> ServiceAnswer:
    choices = completion.get("choices")
    choice = choices[0] if isinstance(choices, list) and choices else None
    if not isinstance(choice, dict) or not isinstance(choice.get("message"), dict):
        raise TransientError("the reply is no chat completion")
    refusal = _refusal(choice["message"], choice.get("finish_reason"))
    usage = completion.get("usage") or {}
    return ServiceAnswer(
        files={} if refusal else {_COMPLETION: reply},
        refusal=refusal,
        model_version=completion.get("model") or "",
        response_id=completion.get("id") or "",
        finish_reason=choice.get("finish_reason") or "",
        usage={
            "requests": 1.0,
            "input_tokens": float(usage.get("prompt_tokens") or 0),
            "output_tokens": float(usage.get("completion_tokens") or 0),
        },
    )


def _refusal(message: dict[str, Any], reason: str | None) -> str:
    """Why a message is of no use; empty if it is."""
    if message.get("refusal"):
        return f"the model refused to answer: {message['refusal']}"
    if reason == "content_filter":
        return "the answer was blocked by a filter (content_filter)"
    if reason == "length":
        return "the answer was cut (length); a larger max_tokens, or context of the server, leaves more room"
    if reason != "stop":
        return f"the answer stopped for another reason than its end ({reason})"
    if (message.get("content") or "").strip():
        return ""
    thought = message.get("reasoning") or message.get("reasoning_content")
    return f"the answer holds no text{', only reasoning' if thought else ''}"
