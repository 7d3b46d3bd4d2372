"""Faults of HTTP services: which are tried again, how long they ask to wait, and that no message holds a key."""

import email.utils

import pytest

from wm.models.http_faults import error_text, retry_after, sdk_fault, status_fault
from wm.services.faults import ServiceError, TransientError


@pytest.mark.parametrize("status", [408, 409, 425, 429, 500, 502, 503, 504, 529])
def test_what_may_pass_is_tried_again(status):
    fault = status_fault(status, {"Retry-After": "7"}, "busy", key="KEY")
    assert isinstance(fault, TransientError) and fault.after == 7 and str(fault) == f"status {status}: busy"


@pytest.mark.parametrize("status", [400, 401, 402, 403, 404, 413, 422, 501])
def test_what_does_not_pass_is_told_at_once(status):
    assert isinstance(status_fault(status, {}, "no", key="KEY"), ServiceError)


def test_an_account_without_credit_is_not_waited_for():
    fault = status_fault(429, {}, "You exceeded your quota", key="KEY", code="insufficient_quota")
    assert isinstance(fault, ServiceError) and "no credit" in str(fault)


def test_a_wrong_key_is_named_by_its_variable_and_not_shown():
    fault = status_fault(401, {}, "Incorrect key sk-123 for\nyou", key="SOME_KEY", secret="sk-123")
    assert str(fault) == "the key in SOME_KEY is not accepted (status 401: Incorrect key *** for you)"


def test_what_a_service_says_is_shortened():
    assert len(str(status_fault(400, {}, "x" * 5000, key="KEY"))) < 400


@pytest.mark.parametrize(
    "headers, wait",
    [
        ({}, None),
        ({"Retry-After": "Mon, 01 Jan 2026 00:00:00 +99999999999999"}, None),
        ({"retry-after": "2.5"}, 2.5),
        ({"Retry-After": email.utils.formatdate(1090, usegmt=True)}, 90.0),
        ({"Retry-After": email.utils.formatdate(10, usegmt=True)}, None),
        ({"retry-after-ms": "1500", "retry-after": "9"}, 1.5),
        ({"retry-after": "soon"}, None),
        ({"retry-after": "-3"}, None),
        ({"retry-after": "0"}, None),
    ],
)
def test_how_long_a_service_asks_to_wait(headers, wait):
    assert retry_after(headers, now=1000.0) == wait


@pytest.mark.parametrize(
    "body, text",
    [
        ({"error": {"message": "a"}}, "a"),
        ({"type": "error", "error": {"type": "x", "message": "b"}}, "b"),
        ({"error": "c"}, "c"),
        ({"message": "d"}, "d"),
        ({"detail": "e"}, "e"),
        ({"error": {"code": 5}}, ""),
        ("plain", "plain"),
        (" <html>", ""),
        (None, ""),
        ([1], ""),
    ],
)
def test_the_message_of_an_error_is_found(body, text):
    assert error_text(body) == text


class UnsupportedProtocol(Exception):
    pass


def test_an_exception_without_a_reply_is_tried_again_unless_the_address_is_wrong():
    assert isinstance(sdk_fault(ConnectionError("refused"), key="KEY"), TransientError)
    assert str(sdk_fault(ConnectionError("refused sk-1"), key="KEY", secret="sk-1")) == "no answer: ConnectionError: refused ***"
    wrapped = RuntimeError("Connection error.")
    wrapped.__cause__ = UnsupportedProtocol("ftp")
    fault = sdk_fault(wrapped, key="KEY")
    assert isinstance(fault, ServiceError) and "base_url" in str(fault)
