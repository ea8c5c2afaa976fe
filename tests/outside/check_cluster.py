#!/usr/bin/env python3
"""check_cluster.py COSFLY RECIPE FOLDER: a recipe on the real HyperQueue (of the Python package) and on this machine gives one
version, while a worker is killed every few seconds, the server once, the driver twice."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from shared import json_of, program

cosfly, recipe, folder = (Path(argument).absolute() for argument in sys.argv[1:4])
folder.mkdir(parents=True, exist_ok=True)
hq = folder / "hq"
program(hq, f'exec "{sys.executable}" "{Path(__file__).with_name("hq_of_wheel.py").absolute()}" "$@"')
os.environ.update(COSFLY_HQ=str(hq), HQ_SERVER_DIR=str(folder / "server"))
run = [cosfly, "run", recipe, "--set", "stages.walkers.count=10", "--json"]


def start(*arguments):
    # In a group of its own, so that everything of it can be killed at once.
    return subprocess.Popen([hq, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def kill(process):
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def wait_for_server():
    for _ in range(200):
        if subprocess.run([hq, "server", "info"], capture_output=True).returncode == 0:
            return
        time.sleep(0.1)
    sys.exit("the server does not start")


def drive():
    command = [*run, "--on", "hq", "--store", folder / "shared", "--out", folder / "there", "--request", "*:batch=2"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def two_workers():
    return [start("worker", "start", "--cpus=1") for _ in range(2)]


here = json_of(*run, "--store", folder / "alone", "--out", folder / "here")
server = start("server", "start")
wait_for_server()
workers, next_worker = two_workers(), 2.0
driver, began, killed = drive(), time.time(), {"worker": 0, "server": 0, "driver": 0}
while driver.poll() is None:
    at = time.time() - began
    if at > 600:
        sys.exit("the run does not end")
    if at > next_worker:
        next_worker = at + 3
        kill(workers.pop(0))
        workers.append(start("worker", "start", "--cpus=1"))
        killed["worker"] += 1
    if killed["driver"] < 2 and at > (3.5, 8.0)[killed["driver"]]:
        driver.kill()
        driver.wait()
        driver = drive()
        killed["driver"] += 1
    if killed["server"] == 0 and at > 6:
        kill(server)
        server = start("server", "start")
        wait_for_server()
        for worker in workers:
            kill(worker)
        workers = two_workers()
        killed["server"] += 1
    time.sleep(0.05)
stdout, stderr = driver.communicate()
print(f"killed: {killed}; {time.time() - began:.0f} s")
if driver.returncode != 0:
    sys.exit(f"the run failed with {driver.returncode}:\n{stdout}\n{stderr}")
there = json.loads(stdout)
digests = [{stage["stage"]: stage["digest"] for stage in summary["stages"]} for summary in (here, there)]
if here["version"] != there["version"] or digests[0] != digests[1]:
    sys.exit(f"the versions differ: {here['version']} here, {there['version']} on HyperQueue")
jobs = json_of(hq, "--output-mode", "json", "job", "list", "--all")
began = time.time()
assert json.loads(drive().communicate()[0])["version"] == here["version"]
after = json_of(hq, "--output-mode", "json", "job", "list", "--all")
assert len(jobs) == len(after), "a finished run submits nothing"
print(f"one version: {here['version']}; a finished run is found finished in {time.time() - began:.1f} s")
for process in [*workers, server]:
    kill(process)
