"""What notebooks show: a notebook is executed, and its outputs hold the pictures."""

import base64
import io
import os
import re

import numpy as np
import pytest
from PIL import Image

import cosfly

nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed: displays in notebooks are not tested")
nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed: displays in notebooks are not tested")

CELLS = [
    "import cosfly; dataset = cosfly.Dataset('data', channels=('rgb', 'depth', 'semantic', 'instance')); dataset",
    "dataset.trajectory('expert-p00001')",
    "dataset.town()",
    "dataset.trajectory('expert-p00001')[3]",
    "cosfly.preview('data', progress=False)",
    "cosfly.run('small', out='data')",
    "cosfly.Dataset('exports-for-notebook', channels=('rgb',)).trajectory('expert-p00000')",
]


@pytest.fixture(scope="module")
def shown(folder):
    """Data of the last output of each cell."""
    if not os.path.exists("exports-for-notebook"):
        cosfly.export("data", "lerobot", "exports-for-notebook", progress=False)
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    return [cell.outputs[-1]["data"] for cell in book.cells]


def pictures(page):
    """Formats and sizes of the pictures inside of a page."""
    files = re.findall("data:image/[a-z]+;base64,([A-Za-z0-9+/=]+)", page)
    return [(image.format, image.size) for image in (Image.open(io.BytesIO(base64.b64decode(it))) for it in files)]


def test_a_dataset_shows_frames_and_its_report(shown):
    page = shown[0]["text/html"]
    assert pictures(page)[:4] == [("PNG", (320, 180))] * 4 and "srcdoc" in page and "4 trajectories" in page


def test_a_trajectory_shows_contact_sheet_plan_and_clip(shown):
    formats = [it for it, size in pictures(shown[1]["text/html"]) if min(size) > 100]
    assert formats == ["PNG", "PNG", "GIF"] and not os.path.exists("data-preview/expert-p00001-sheet.png")
    # Of a foreign layout: frames.
    assert len(pictures(shown[6]["text/html"])) >= 6


def test_a_town_shows_its_plan(shown):
    assert min(Image.open(io.BytesIO(base64.b64decode(shown[2]["image/png"]))).size) > 200


def test_a_frame_shows_its_channels_and_colours_are_exact(shown):
    page = shown[3]["text/html"]
    assert [size for _, size in pictures(page)] == [(320, 180)] * 4 and "semantic" in page
    frame = cosfly.Dataset("data").trajectory("expert-p00001")[3]
    assert np.array_equal(np.array(Image.open(io.BytesIO(frame.png("rgb")))), frame["rgb"])


def test_previews_and_runs_show_themselves(shown):
    assert len(pictures(shown[4]["text/html"])) == 3 and "complete" in shown[5]["text/html"]


def test_what_is_not_there_is_named():
    dataset = cosfly.Dataset("data")
    with pytest.raises(KeyError, match="expert-p00001"):
        dataset.frame("expert-p0001", 3)
    with pytest.raises(IndexError):
        dataset.trajectory("expert-p00001")[1000]
    with pytest.raises(KeyError, match="downtown"):
        dataset.town("uptown")
    with pytest.raises(ValueError, match="no town"):
        cosfly.Dataset("exports-for-notebook", channels=()).town()
