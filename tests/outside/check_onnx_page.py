"""The book's page on policies in ONNX, literally: every `sh` and `python` block, in order; and the page's lists against the program.

Usage: `check_onnx_page.py COSFLY FOLDER` (with a Python that has cosfly, numpy and onnx)."""

import os
import re
import subprocess
import sys
from pathlib import Path

from shared import blocks

cosfly, folder = (Path(argument).absolute() for argument in sys.argv[1:3])
root = Path(__file__).absolute().parents[2]
page = (root / "book/src/guide/onnx.md").read_text()
folder.mkdir(parents=True)
(folder / "recipes").symlink_to(root / "recipes")
(folder / "bin").mkdir()
(folder / "bin/cosfly").symlink_to(cosfly)
environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
environment.pop("COSFLY_STORE", None)
os.chdir(folder)
space = {"__name__": "__main__"}
said = ""
for language, block in blocks(root / "book/src/guide/onnx.md", "sh", "python"):
    if language == "python":
        exec(compile(block, "onnx.md", "exec"), space)
        continue
    ran = subprocess.run(["bash", "-euxo", "pipefail", "-c", block], env=environment, check=True, stdout=subprocess.PIPE, text=True)
    print(ran.stdout)
    said += ran.stdout
assert re.search(r"^ +1  0\.\d+  re-run +student \(sees state\)$", said, re.MULTILINE), said
assert "Re-run, sees state" in (folder / "results/index.html").read_text()

source = (root / "engine/edge/onnx/src/operators/mod.rs").read_text()
operators = ", ".join(re.findall(r'^    operator\("(\w+)"', source, re.MULTILINE))
assert f"opset 13 to 24: {operators}." in " ".join(page.split()), f"the page lists other operators than {operators}"
