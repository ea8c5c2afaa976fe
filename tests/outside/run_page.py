#!/usr/bin/env python3
"""Runs the Python examples of pages of the book, one after the other, as a reader would: python run_page.py PAGE...

A page with `<!-- needs: MODULE -->` is skipped, with a line that says so, where the module is not installed."""

import importlib.util
import re
import sys
from pathlib import Path

from shared import blocks

for path in sys.argv[1:]:
    needs = re.findall(r"<!-- needs: (\S+) -->", Path(path).read_text(encoding="utf-8"))
    absent = [name for name in needs if importlib.util.find_spec(name) is None]
    if absent:
        print(f"--- {path}: skipped, {', '.join(absent)} is not installed")
        continue
    examples = blocks(path, "python")
    assert examples, f"{path} has no example"
    space = {"__name__": "__main__"}
    for number, (_, block) in enumerate(examples, 1):
        print(f"--- {path}: example {number} of {len(examples)}", flush=True)
        exec(compile(block, f"{path}, example {number}", "exec"), space)
