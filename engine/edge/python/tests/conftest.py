"""The dataset of all tests: the small recipe, run once."""

import os
from pathlib import Path

import pytest

import cosfly


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """A folder with the small recipe and its dataset, `data`."""
    place = tmp_path_factory.mktemp("small")
    os.chdir(place)
    cosfly.init("small")
    made = cosfly.run("small", out="data", jobs=2, progress=False)
    assert made.outcome == "complete" and made.out == Path("data"), made
    return place


@pytest.fixture(autouse=True)
def inside(folder):
    os.chdir(folder)
