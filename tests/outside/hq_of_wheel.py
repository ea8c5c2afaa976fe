#!/usr/bin/env python3
"""The command `hq` as far as cosfly uses it, played over the Python package `hyperqueue`: its server and workers are the
real ones, in processes of their own; the package has no command line. The server has no journal: a killed one forgets its jobs."""

import json
import os
import shutil
import sys
import tempfile
import time
import tomllib
from datetime import timedelta
from importlib.metadata import version
from pathlib import Path

from hyperqueue.client import Client
from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest
from hyperqueue.job import Job

FOLDER = Path(os.environ.get("HQ_SERVER_DIR", Path.home() / ".hq-server")).absolute()
CURRENT = FOLDER / "hq-current"
# Records that a task ended, which the package does not tell; a cancelled job starts no more commands.
RECORDER = '[ -e "$0/cancelled" ] && exit 1; id=$1; shift; "$@"; code=$?; : > "$0/$id.$code"; exit $code'


def forever(_cluster):
    while True:
        time.sleep(3600)


def start_server():
    FOLDER.mkdir(parents=True, exist_ok=True)
    cluster = LocalCluster(str(FOLDER))
    shutil.rmtree(FOLDER / "jobs", ignore_errors=True)
    (FOLDER / "jobs").mkdir()
    (FOLDER / "server.pid").write_text(str(os.getpid()))
    forever(cluster)


def is_alive(number):
    """Whether there is a process with a number, written down as a text."""
    try:
        os.kill(int(number), 0)
        return True
    except (OSError, ValueError):
        return False


def start_worker(cpus):
    # The package starts a worker beside a server of its own; the worker reads the place of the server from a folder.
    own = Path(tempfile.mkdtemp(prefix="hq-worker-"))
    cluster = LocalCluster(str(own))
    (own / "hq-current").unlink()
    (own / "hq-current").symlink_to(CURRENT.resolve())
    cluster.start_worker(WorkerConfig(cores=cpus))
    (FOLDER / "workers").mkdir(exist_ok=True)
    (FOLDER / "workers" / str(os.getpid())).touch()
    forever(cluster)


def workers():
    return [{"id": int(entry.name)} for entry in FOLDER.glob("workers/*") if is_alive(entry.name)]


def submit(path):
    described = tomllib.loads(Path(path).read_text())
    records = Path(tempfile.mkdtemp(dir=FOLDER / "jobs", prefix="new-"))
    job, tasks = Job(name=described["name"], max_fails=None), {}
    for task in described["task"]:
        request = task["request"][0]
        time_s = request.get("time_request")
        tasks[task["id"]] = job.program(
            ["sh", "-c", RECORDER, str(records), str(task["id"]), *task["command"]],
            deps=[tasks[dep] for dep in task.get("deps", [])],
            # The package's workers have processors alone.
            resources=ResourceRequest(cpus=request["resources"]["cpus"], min_time=time_s and timedelta(seconds=int(time_s.removesuffix("s")))),
            stdout=None, stderr=None, crash_limit=task["crash_limit"], cwd="/",
        )
    deps = {task["id"]: task.get("deps", []) for task in described["task"]}
    (records / "job.json").write_text(json.dumps({"name": described["name"], "ids": list(tasks), "deps": list(deps.items())}))
    submitted = Client(str(FOLDER)).submit(job)
    (FOLDER / "jobs" / str(submitted.id)).symlink_to(records)
    return {"id": submitted.id}


def ends(number):
    """Finished tasks, failed tasks with a reason, and tasks that failed ones keep from starting."""
    records = FOLDER / "jobs" / number
    described = json.loads((records / "job.json").read_text())
    finished = sorted(int(entry.name.split(".")[0]) for entry in records.glob("*.0"))
    told = Client(str(FOLDER)).connection.get_failed_tasks([int(number)])[int(number)]
    failed = {described["ids"][index]: context.error for index, context in told.items()}
    aborted = set()
    for task, deps in described["deps"]:
        if task not in failed and any(dep in failed or dep in aborted for dep in deps):
            aborted.add(task)
    return described, finished, failed, aborted


def jobs():
    listed = []
    for entry in (FOLDER / "jobs").iterdir():
        if entry.name.isdigit():
            described, finished, failed, aborted = ends(entry.name)
            stats = {"finished": len(finished), "failed": len(failed), "aborted": len(aborted), "canceled": 0}
            if (entry / "cancelled").exists():
                stats["canceled"] = len(described["ids"]) - sum(stats.values())
            listed.append({"id": int(entry.name), "name": described["name"], "task_count": len(described["ids"]), "task_stats": stats})
    return sorted(listed, key=lambda job: job["id"])


def answer(arguments):
    match arguments:
        case ["server", "info"]:
            return {"version": version("hyperqueue"), "server_dir": str(FOLDER)}
        case ["server", "stop"]:
            os.kill(int((FOLDER / "server.pid").read_text()), 15)
            return {}
        case ["worker", "list"]:
            return workers()
        case ["job", "submit-file", path]:
            return submit(path)
        case ["job", "list", "--all"]:
            return jobs()
        case ["job", "task-ids", number, "--filter", "finished"]:
            return {number: ends(number)[1]}
        case ["task", "list", number, "--task-status", "failed"]:
            return {number: [{"id": task, "state": "failed", "error": error} for task, error in ends(number)[2].items()]}
        case ["job", "cancel", number]:
            (FOLDER / "jobs" / number / "cancelled").touch()
            return {}
        case _:
            sys.exit(f"hq_of_wheel.py does not play `hq {' '.join(arguments)}`")


def main():
    arguments = sys.argv[1:]
    if arguments[:2] == ["--output-mode", "json"]:
        arguments = arguments[2:]
    match arguments:
        case ["server", "start", *_]:
            start_server()
        case ["worker", "start", *options]:
            cpus = [option.removeprefix("--cpus=") for option in options if option.startswith("--cpus=")]
            start_worker(int(cpus[0]) if cpus else os.cpu_count())
    try:
        if not (FOLDER / "server.pid").exists() or not is_alive((FOLDER / "server.pid").read_text()):
            raise ConnectionError(f"no server runs in {FOLDER}")
        print(json.dumps(answer(arguments)))
    except Exception as error:
        print(json.dumps({"error": f"{type(error).__name__}: {error}"}))
        sys.exit(1)


if __name__ == "__main__":
    main()
