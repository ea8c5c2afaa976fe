"""Carries the Dockerfile out in a plain shell, without a daemon: its stages are folders, what it builds is a binary that is there.

Usage: `check_container.py COSFLY WORK`. `COPY` and `RUN` do their work, with three differences: absolute paths lie in the folder of the stage,
Debian's packages are looked up and not installed (as root on Debian), and `cargo build` checks the copied workspace and takes COSFLY. Then the
commands of the Dockerfile's first lines run as a user without rights."""

import os
import re
import shlex
import shutil
import sys
import tempfile
from pathlib import Path

from shared import program, require, run, said

cosfly, work = (Path(argument).resolve() for argument in sys.argv[1:])
repository = Path(__file__).resolve().parents[2]
lines = (repository / "Dockerfile").read_text(encoding="utf-8").splitlines()
tools = work / "tools"
tools.mkdir(parents=True)
# `cargo build --release` without building again: the workspace is whole, its lock holds, and the binary is one that is there.
CARGO = f"""test "$*" = "build --release"
{shutil.which("cargo")} metadata --locked --offline --format-version 1 >/dev/null
mkdir -p target/release
cp {cosfly} target/release/cosfly
"""
APT = f"""case "$1" in
update) {shutil.which("apt-get")} -qq update || echo "not updated" ;;
*) {shutil.which("apt-get")} --simulate "$@" ;;
esac
"""
for name, text in {"cargo": CARGO, "apt-get": APT if os.getuid() == 0 and shutil.which("apt-get") else ":"}.items():
    program(tools / name, f"set -e\n{text}")
environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"}


def inside(stage, path, folder):
    """A path of a stage."""
    return work / "stages" / stage / str((Path("/") / folder / path)).lstrip("/")


def copy(sources, target):
    """Files below a folder of the repository, those that git knows: what .dockerignore leaves out is not among them."""
    for name in run("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *sources, cwd=repository).split("\0")[:-1]:
        relative = Path(name) if sources == ["."] else Path(name).relative_to(sources[0])
        (target / relative).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(repository / name, target / relative)


stage = folder = ""
last = {}
for line in filter(lambda it: it and not it.startswith("#"), lines):
    name, text = line.split(" ", 1)
    if name == "FROM":
        base, _, stage = text.partition(" AS ")
        stage = stage or "last"
        parent = work / "stages" / base
        if parent.is_dir():
            shutil.copytree(parent, work / "stages" / stage)
        else:
            folder = "/"
            inside(stage, "", folder).mkdir(parents=True)
    elif name == "WORKDIR":
        folder = text
        inside(stage, "", folder).mkdir(parents=True, exist_ok=True)
    elif name == "COPY":
        *sources, target = text.split(" ")
        if found := re.fullmatch("--from=(.*)", sources[0]):
            to = inside(stage, target, folder)
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(inside(found[1], sources[1], "/"), to)
        else:
            copy(sources, inside(stage, target, folder))
    elif name == "RUN":
        own = re.sub(r"(?<= )/", f"{work / 'stages' / stage}/", text)
        run("sh", "-euc", own, cwd=inside(stage, "", folder), env=environment)
    else:
        last[name] = eval(text)
    said(name, text[:100])

root, entry = work / "stages" / stage, last["ENTRYPOINT"]
installed = root / "usr/local/bin" / entry[0]
needed = set(re.findall(r"^\s*([^/\s]+?)\.so", run("ldd", installed), re.M))
require(needed <= {"linux-vdso", "libgcc_s", "libm", "libc"}, f"a bare Debian lacks some of {needed}")
require("Usage" in run(installed, *last["CMD"]), "CMD says nothing")
user = "setpriv --reuid=65534 --regid=65534 --clear-groups".split() if os.getuid() == 0 else []
place = inside(stage, "", folder)
place.chmod(0o777)
temporary = Path(tempfile.gettempdir()).resolve()
for part in [work, *work.parents]:
    if os.getuid() == 0 and temporary in part.parents:
        part.chmod(part.stat().st_mode | 0o111)
command = next(line for line in lines if "docker run" in line).split(" cosfly ", 1)[1]
arguments = [str(root) + it if it.startswith("/") else it for it in shlex.split(command)]
run(*user, installed, *arguments, cwd=place, env={"PATH": "/usr/bin:/bin"})
made = [path.name for path in (place / "out").iterdir()]
run(installed, "verify", place / "out" / made[0])
said("docker run", f"{command}: {made}")
