"""What the two services send, byte by byte, for the loopback server; and backends that ask it."""

import json
from typing import Any

from tests.models.loopback import Reply
from wm.models.language import claude, openai_compatible
from wm.models.language.speaking_model import SpeakingModel

SECRET = "sk-very-secret-123"
STREAM = {"content-type": "text/event-stream; charset=utf-8"}


def events(*parts: dict[str, Any]) -> bytes:
    return b"".join(f"event: {part['type']}\ndata: {json.dumps(part)}\n\n".encode() for part in parts)


def claude_reply(text: str, stop: str | None = "end_turn", **reply: Any) -> Reply:
    """A streamed message: thinking, then text in two pieces; `stop` None ends the stream before the message."""
    message = {"id": "msg_1", "type": "message", "role": "assistant", "model": "claude-opus-5-5-20260922", "content": []}
    message |= {"stop_reason": None, "stop_sequence": None, "usage": {"input_tokens": 90, "output_tokens": 1}}
    half = len(text) // 2
    parts = [
        {"type": "message_start", "message": {**message, "usage": {**message["usage"], "cache_read_input_tokens": 10}}},
        {"type": "content_block_start", "index": 0, "content_block": {"type": "thinking", "thinking": "", "signature": ""}},
        {"type": "content_block_delta", "index": 0, "delta": {"type": "thinking_delta", "thinking": "Walls first."}},
        {"type": "content_block_stop", "index": 0},
        {"type": "ping"},
        {"type": "content_block_start", "index": 1, "content_block": {"type": "text", "text": ""}},
        *(
            {"type": "content_block_delta", "index": 1, "delta": {"type": "text_delta", "text": t}}
            for t in (text[:half], text[half:])
        ),
        {"type": "content_block_stop", "index": 1},
    ]
    if stop is not None:
        details = {"type": "refusal", "category": "bio", "explanation": "not allowed"} if stop == "refusal" else None
        delta = {"stop_reason": stop, "stop_sequence": None, "stop_details": details}
        parts += [{"type": "message_delta", "delta": delta, "usage": {"output_tokens": 50}}, {"type": "message_stop"}]
    return Reply(body=events(*parts), headers=STREAM, **reply)


def openai_reply(text: str | None, stop: str | None = "stop", *, message: dict[str, Any] | None = None, **reply: Any) -> Reply:
    told = {"role": "assistant", "content": text, **(message or {})}
    completion = {"id": "chatcmpl-1", "object": "chat.completion", "created": 1, "model": "gpt-6.1-sol-2026-09-29"}
    completion |= {"choices": [{"index": 0, "finish_reason": stop, "message": told}]}
    completion |= {"usage": {"prompt_tokens": 100, "completion_tokens": 50, "total_tokens": 150}}
    return Reply(body=completion, **reply)


def good_reply(dialect: str, text: str, **reply: Any) -> Reply:
    return claude_reply(text, **reply) if dialect == "claude" else openai_reply(text, **reply)


def backend(dialect: str, url: str, **settings: Any) -> SpeakingModel:
    """A backend of either dialect that asks this address."""
    if dialect == "claude":
        return claude.make(claude.Settings(base_url=url, **settings))
    return openai_compatible.make(openai_compatible.Settings(base_url=f"{url}/v1", **settings))
