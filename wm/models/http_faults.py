"""What goes wrong between this machine and the HTTP service of a model, told apart by whether a later try helps.

    408, 409, 425, 429, 500, 502 and above; no connection, a cut one,
    no answer in time, a reply that is not the service's               TransientError, after Retry-After where it is given
    any other status; an address that is none                          ServiceError, which says what would be right

An error that comes in a reply with status 200, as in the middle of a stream, is told by its type in the same way. Messages
hold what the service said, shortened, and never a key.
"""

import email.utils
import re
import time
from collections.abc import Mapping
from typing import Any

from wm.services.faults import ServiceError, TransientError

_RETRIED = (408, 409, 425, 429, 500)
_HOPELESS = ("insufficient_quota", "billing_hard_limit_reached", "billing_error")
"""Codes that services send with a status that waiting would help, when it does not."""
_ADVICE = {
    401: "the key in {key} is not accepted",
    402: "the account has no credit left",
    403: "the key in {key} may not be used for this",
    404: "the model or the address is not known; check the settings model and base_url",
    413: "the request is too large for the service",
}
_STATUS = {
    "invalid_request_error": 400, "authentication_error": 401, "billing_error": 402, "permission_error": 403,
    "not_found_error": 404, "request_too_large": 413, "rate_limit_error": 429, "timeout_error": 504, "overloaded_error": 529,
}  # fmt: skip
"""The status that belongs to a type of error, where the reply's own status says success."""
_LONGEST = 300


def status_fault(
    status: int, headers: Mapping[str, str], said: str, *, key: str, secret: str = "", code: str | None = None
) -> TransientError | ServiceError:
    """The fault that a reply with an error status stands for.

    Args:
      status: of the reply.
      headers: of the reply.
      said: what the service says of it.
      key: the environment variable that holds the key.
      secret: the key itself, which is taken out of the message.
      code: of the error, as the service names it.
    """
    message = f"status {status}{_said(said, secret)}"
    if (status in _RETRIED or status > 501) and code not in _HOPELESS:
        return TransientError(message, after=retry_after(headers))
    advice = "the account has no credit left" if code in _HOPELESS else _ADVICE.get(status, "the request was not accepted")
    return ServiceError(f"{advice.format(key=key)} ({message})")


def sdk_fault(error: Exception, *, key: str, secret: str = "") -> TransientError | ServiceError:
    """The fault that an exception of an SDK on top of httpx2 stands for, whether the SDK has wrapped it or not.

    Args:
      error: an exception with a `status_code` and a `response`, or one of the transport below, or one that it caused.
      key, secret: as in `status_fault`.
    """
    status, response = getattr(error, "status_code", None), getattr(error, "response", None)
    if isinstance(status, int) and response is not None:
        body = getattr(error, "body", None)
        if status < 400:
            return body_fault(body, key=key, secret=secret)
        return status_fault(status, response.headers, error_text(body), key=key, secret=secret, code=_code(body))
    cause = error.__cause__ if isinstance(error.__cause__, Exception) else error
    kind = type(cause).__name__
    if kind in ("UnsupportedProtocol", "InvalidURL", "LocalProtocolError"):
        return ServiceError(f"the address of the service cannot be used{_said(str(cause), secret)}; check the setting base_url")
    return TransientError(f"no answer{_said(f'{kind}: {cause}' if str(cause) else kind, secret)}")


def body_fault(body: Any, *, key: str, secret: str = "") -> TransientError | ServiceError:
    """The fault that an error in the body of a reply stands for whose status says success; of an unknown type, a passing one.

    Args:
      body: decoded.
      key, secret: as in `status_fault`.
    """
    inner = body.get("error", body) if isinstance(body, dict) else {}
    number = inner.get("code") if isinstance(inner, dict) else None
    code = _code(body)
    status = number if isinstance(number, int) and 400 <= number < 600 else _STATUS.get(code or "", 500)
    return status_fault(status, {}, error_text(body), key=key, secret=secret, code=code)


def retry_after(headers: Mapping[str, str], now: float | None = None) -> float | None:
    """Seconds that a service asks to wait, by `retry-after-ms` or `Retry-After` (seconds or a date); None if it does not."""
    lower = {name.lower(): value for name, value in headers.items()}
    try:
        if "retry-after-ms" in lower:
            wait = float(lower["retry-after-ms"]) / 1000
        elif re.fullmatch(r"\s*[\d.]+\s*", lower.get("retry-after", "")):
            wait = float(lower["retry-after"])
        else:
            date = email.utils.parsedate_to_datetime(lower["retry-after"])
            wait = date.timestamp() - (time.time() if now is None else now)
    except (KeyError, ValueError, TypeError, OverflowError):
        return None
    return wait if 0 < wait < float("inf") else None


def error_text(body: Any) -> str:
    """The message in the decoded body of an error, of which services have several shapes."""
    if isinstance(body, dict):
        inner = body.get("error", body)
        return error_text(inner.get("message") or inner.get("detail")) if isinstance(inner, dict) else error_text(inner)
    return body if isinstance(body, str) and not body.lstrip().startswith("<") else ""


def _code(body: Any) -> str | None:
    """The code of an error, or its type where it has no code."""
    inner = body.get("error", body) if isinstance(body, dict) else None
    codes = [inner.get(name) for name in ("code", "type")] if isinstance(inner, dict) else []
    return next((code for code in codes if isinstance(code, str)), None)


def _said(text: str, secret: str) -> str:
    """What a service said, as the end of a message: on one line, shortened, without the key."""
    line = " ".join((text.replace(secret, "***") if secret else text).split())
    return f": {line[:_LONGEST]}{'...' * (len(line) > _LONGEST)}" if line else ""
