"""The finished run that the tests of comparisons read."""

import pathlib

import pytest


@pytest.fixture(scope="package")
def run_folder(finished) -> pathlib.Path:
    return finished.folder
