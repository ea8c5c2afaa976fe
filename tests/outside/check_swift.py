"""Loads an export of format vlm with ms-swift's own loader, where it is installed.

    venv/bin/python tests/outside/check_swift.py EXPORT_FOLDER

Every line of every file must become a row with messages, and the pictures of the line.
"""

import importlib.util
import os
import sys
from pathlib import Path

if importlib.util.find_spec("swift") is None:
    print("skipped: ms-swift is not installed (pip install ms-swift)")
    sys.exit()

from swift.dataset import load_dataset

# Names of pictures are those of the folder.
os.chdir(sys.argv[1])
for path in sorted(Path(".").glob("*.jsonl")):
    # Pairs have two forms; the one without this ending is LLaMA-Factory's.
    if path.stem.endswith("_preferences"):
        continue
    lines = len(path.read_text(encoding="utf-8").splitlines())
    rows, _ = load_dataset([str(path)], split_dataset_ratio=0.0, num_proc=1, strict=True)
    assert len(rows) == lines, (path, len(rows), lines)
    for row in rows:
        assert [message["role"] for message in row["messages"]] == ["system", "user", "assistant"], row
        pictures = row.get("images") or []
        assert row["messages"][1]["content"].count("<image>") == len(pictures), row
        assert not path.stem.endswith("_swift") or row["rejected_response"], row
    print(f"ok  {path.name}: {lines} lines")
