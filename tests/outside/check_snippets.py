"""Runs the Python examples in the `README.md` of datasets and exports as they stand, each in the folder of its card.

python check_snippets.py FOLDER...
"""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Packages that are too large for continuous integration: examples that need them run only where they are installed.
OPTIONAL = ["lerobot"]

environment = os.environ | {"HF_HUB_OFFLINE": "1", "HF_DATASETS_OFFLINE": "1", "PYTHONWARNINGS": "error::DeprecationWarning:__main__"}
for folder in map(Path, sys.argv[1:]):
    examples = re.findall(r"^```python\n(.*?)^```", (folder / "README.md").read_text(), re.M | re.S)
    assert examples or not (folder / "data").is_dir(), f"the card of {folder} has no example"
    for number, example in enumerate(examples, 1):
        missing = [name for name in OPTIONAL if name in example and importlib.util.find_spec(name) is None]
        if missing:
            print(f"skipped: example {number} of {folder.name}: {', '.join(missing)} is not installed")
            continue
        with tempfile.TemporaryDirectory() as cache:
            command = [sys.executable, "-c", example]
            done = subprocess.run(command, cwd=folder, env=environment | {"HF_HOME": cache}, capture_output=True, text=True)
        assert done.returncode == 0, f"example {number} of {folder}:\n{example}\n{done.stdout}{done.stderr}"
        print(f"ok  example {number} of {folder.name}")
