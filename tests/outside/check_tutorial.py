"""The book's tutorial, literally, in a copy of the recipes: every `sh` block of its pages in one shell, in order.

Usage: `check_tutorial.py COSFLY FOLDER` (`cargo` is played: the program is there)."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

cosfly, folder = (Path(argument).absolute() for argument in sys.argv[1:3])
root = Path(__file__).absolute().parents[2]
pages = [root / f"book/src/tutorial/{name}.md" for name in ("dataset", "look", "train", "fly")]
clone, programs = folder / "clone", folder / "bin"
shutil.copytree(root / "recipes", clone / "recipes")
(clone / "target/release").mkdir(parents=True)
programs.mkdir()
(clone / "target/release/cosfly").symlink_to(cosfly)
(programs / "cargo").write_text("#!/bin/sh\nexit 0\n")
(programs / "cargo").chmod(0o755)

assert {page.name for page in pages} == {path.name for path in pages[0].parent.iterdir()}, "a page of the tutorial is not run"
blocks = [block for page in pages for block in re.findall(r"^```sh\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)]
assert len(blocks) >= 12, "the tutorial has commands"
kept = {name: value for name, value in os.environ.items() if name not in ("COSFLY_STORE", "PYTHONPATH", "STUDENT")}
environment = {**kept, "PATH": f"{programs}:{kept['PATH']}"}
subprocess.run(["bash", "-euxo", "pipefail", "-c", "".join(blocks)], cwd=clone, env=environment, check=True)

for named in ("out/small/report/index.html", "out/small-preview/expert-p00000-clip.gif", "out/fly/street/clone/report.html"):
    assert (clone / named).is_file(), named
rates = {}
for name in ("hold", "clone", "first", "expert"):
    scores = json.loads((clone / f"out/fly/street/{name}/scores.json").read_text())
    rates[name] = scores["all"]["tracking_rate"]["mean"]
print(rates)
assert rates["clone"] < rates["hold"] < rates["first"] < rates["expert"], "the page tells another story"
