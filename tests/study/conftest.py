"""One small study for all tests that only read it."""

import dataclasses

import pytest

from tests.study.clips import small_study


@pytest.fixture(scope="session")
def made_study(tmp_path_factory):
    return small_study(tmp_path_factory.mktemp("study"))


@pytest.fixture
def study(made_study, tmp_path):
    """The study with a folder of its own, for answers."""
    return dataclasses.replace(made_study, folder=tmp_path)
