#!/usr/bin/env python3
"""Tags, size and contents of the wheel and the source distribution: python check_wheel.py FOLDER [--most-mb SIZE]"""

import os
import re
import tarfile
import zipfile
from pathlib import Path

from shared import command_line

given = command_line("folder", most_mb=1000.0)
[wheel], [source] = given.folder.glob("*.whl"), given.folder.glob("*.tar.gz")

assert re.fullmatch(r"cosfly-[\d.]+-cp310-abi3-(manylinux|macosx|win).*\.whl", wheel.name), wheel.name
assert wheel.stat().st_size <= given.most_mb * 1e6, f"{wheel.stat().st_size / 1e6:.1f} MB"
with zipfile.ZipFile(wheel) as files:
    names = set(files.namelist())
    metadata = files.read(next(name for name in names if name.endswith("METADATA"))).decode()
    entries = files.read(next(name for name in names if name.endswith("entry_points.txt"))).decode()
modules = {"__init__", "__main__", "gym", "_calls", "_dataset", "_errors", "_expert", "_pack", "_show", "_toml", "jax", "onnx", "torch"}
assert {f"cosfly/{module}.py" for module in modules} | {"cosfly/py.typed", "cosfly/_cosfly.pyi"} <= names, names
required = [line for line in metadata.splitlines() if line.startswith("Requires-Dist") and "extra ==" not in line]
assert len(required) == 1 and "numpy" in required[0], required
assert "Requires-Python: >=3.10" in metadata and "cosfly=cosfly.__main__:main" in entries.replace(" ", "")

with tarfile.open(source) as files:
    texts = {member.name.split("/", 1)[1]: member for member in files.getmembers() if member.isfile()}
    missing = []
    for name in [name for name in texts if name.endswith(".rs")]:
        text = files.extractfile(texts[name]).read().decode()
        for path in re.findall(r'include_(?:str|bytes)!\(\s*"([^"]+)"', text):
            if os.path.normpath(Path(name).parent / path) not in texts:
                missing.append(f"{name}: {path}")
assert not missing, missing
print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB; {source.name}: {len(texts)} files")
