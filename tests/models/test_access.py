"""Packages of extras and secrets that are not there."""

import pytest

from wm.models.access import optional_module, secret
from wm.services.faults import MissingExtraError, MissingKeyError


def test_a_package_that_is_not_installed_is_named_with_its_extra():
    with pytest.raises(MissingExtraError, match=r"^no_such_package is not installed: pip install 'wm\[some\]'$"):
        optional_module("no_such_package.part", "some")
    assert optional_module("json", "some").loads("1") == 1


@pytest.mark.parametrize("value", [None, "", "  "])
def test_a_secret_that_is_not_set_is_named(monkeypatch, value):
    monkeypatch.delenv("SOME_KEY", raising=False)
    if value is not None:
        monkeypatch.setenv("SOME_KEY", value)
    with pytest.raises(MissingKeyError, match="SOME_KEY is not set"):
        secret("SOME_KEY")


@pytest.mark.parametrize("value", ["sk-12\n34", "sk-12 34", "sk-12\u202634", "\u201csk-1234\u201d", "sk-12\t34"])
def test_what_cannot_be_a_key_is_not_sent_and_not_shown(monkeypatch, value):
    """An HTTP library would refuse it with the header in its message, or fail to encode it, again for a quarter of an hour."""
    monkeypatch.setenv("SOME_KEY", value)
    with pytest.raises(MissingKeyError, match="SOME_KEY holds no key") as error:
        secret("SOME_KEY")
    assert "12" not in str(error.value)


def test_a_secret_is_read_without_the_line_break_of_a_file(monkeypatch):
    monkeypatch.setenv("SOME_KEY", "abc\n")
    assert secret("SOME_KEY") == "abc"
