"""Runs the Python examples in the `README.md` of datasets and exports as they stand, each in the folder of its card.

Usage: `check_snippets.py FOLDER...`."""

import importlib.util
import os
import sys
import tempfile
from pathlib import Path

from shared import blocks, run, said

# Packages that are too large for continuous integration: examples that need them run only where they are installed.
OPTIONAL = ["lerobot"]

environment = os.environ | {"HF_HUB_OFFLINE": "1", "HF_DATASETS_OFFLINE": "1", "PYTHONWARNINGS": "error::DeprecationWarning:__main__"}
for folder in map(Path, sys.argv[1:]):
    examples = [example for _, example in blocks(folder / "README.md", "python")]
    assert examples or not (folder / "data").is_dir(), f"the card of {folder} has no example"
    for number, example in enumerate(examples, 1):
        missing = [name for name in OPTIONAL if name in example and importlib.util.find_spec(name) is None]
        if missing:
            print(f"skipped: example {number} of {folder.name}: {', '.join(missing)} is not installed")
            continue
        with tempfile.TemporaryDirectory() as cache:
            run(sys.executable, "-c", example, cwd=folder, env=environment | {"HF_HOME": cache})
        said(f"example {number} of {folder.name}")
