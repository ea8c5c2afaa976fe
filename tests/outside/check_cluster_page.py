#!/usr/bin/env python3
"""check_cluster_page.py PAGE COSFLY FOLDER: the commands of the book's page on clusters, literally, from an empty folder;
then the script for Slurm, with Slurm where it is installed and with a played `srun` otherwise."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from shared import blocks, program

page, cosfly, folder = (Path(argument).absolute() for argument in sys.argv[1:4])
programs, empty = folder / "bin", folder / "empty"
programs.mkdir(parents=True)
empty.mkdir()
program(programs / "hq", f'exec "{sys.executable}" "{Path(__file__).with_name("hq_of_wheel.py").absolute()}" "$@"')
program(programs / "cosfly", f'exec "{cosfly}" "$@"')
environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "HQ_SERVER_DIR": str(folder / "server")}
environment.pop("COSFLY_HQ", None)


def follow(script, what, **more):
    # A group of its own: servers and workers that the script leaves behind end with it.
    process = subprocess.Popen(["bash", "-euxo", "pipefail", "-c", script], cwd=empty, env={**environment, **more}, start_new_session=True)
    try:
        code = process.wait(timeout=600)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    if code != 0:
        sys.exit(f"{what} failed with {code}")


commands = [block for _, block in blocks(page, "sh")]
assert len(commands) >= 4, "the page has commands"
follow("".join(commands), "the page")
assert (empty / "out").is_dir() and (empty / "commands.jsonl").read_text() == "", "all was finished"

# The script, with a store that has nothing.
shutil.rmtree(empty / "store")
script = empty / "job.sh"
if shutil.which("sbatch") and shutil.which("srun"):
    follow("sed -i '/partition/d; s/--nodes=2/--nodes=1/' job.sh; sbatch --wait job.sh", "Slurm")
    print("the script ran under Slurm")
else:
    program(programs / "srun", 'exec "$@" --cpus=2')
    follow("bash job.sh", "the script for Slurm")
    print("skipped: Slurm is not installed (Debian: slurm-wlm); the script ran with a played `srun`")
assert (empty / "store" / "done").is_dir()
print("the page works as it stands")
