#!/usr/bin/env python3
"""Runs the Python examples of a page of the book, one after the other, as a reader would: python run_page.py PAGE"""

import re
import sys
from pathlib import Path

page = Path(sys.argv[1]).read_text(encoding="utf-8")
blocks = re.findall(r"^```python\n(.*?)^```", page, re.S | re.M)
space = {}
for number, block in enumerate(blocks, 1):
    print(f"--- example {number} of {len(blocks)}", flush=True)
    exec(compile(block, f"{sys.argv[1]}, example {number}", "exec"), space)
