"""`cosfly fly` against hostile policies: no crash, at most 1 GB, at most 20 s each, and every refusal names place and way out.

Usage: check_hostile.py COSFLY SUITE WORK_FOLDER [PART_OF_A_NAME]
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from hostile_policies import MODULES, SERVERS, Server

cosfly, suite, work = (str(pathlib.Path(it).resolve()) for it in sys.argv[1:4])
chosen = sys.argv[4] if len(sys.argv) > 4 else ""
work = pathlib.Path(work)
shutil.rmtree(work / "out", ignore_errors=True)
(work / "modules").mkdir(parents=True, exist_ok=True)
FEW = ["--set", "stages.walkers.count=2", "--jobs", "2", "--clips", "0", "--logs", "none"]
PATIENCE = ["--timeout-s", "2", "--wait-s", "3"]
KEY = "pass-1234-word"
subprocess.run([cosfly, "fly", suite, "--store", work / "store", "--policy", "hold", "--out", work / "out", *FEW], check=True, capture_output=True)


def check(name, policy):
    """Flies one hostile policy; gives what is wrong about it."""
    out = work / "out" / name
    command = [cosfly, "fly", suite, "--store", work / "store", "--out", out, "--name", "mine", *FEW, *PATIENCE]
    command += ["--policy", policy, "--python", sys.executable]
    environment = os.environ | {"COSFLY_API_KEY": KEY, "PYTHONDONTWRITEBYTECODE": "1"}
    with open(work / f"{name}.stdout", "wb") as stdout, open(work / f"{name}.stderr", "wb") as stderr:
        began = time.monotonic()
        process = subprocess.Popen(command, cwd=work / "modules", stdout=stdout, stderr=stderr, env=environment)
        killer = __import__("threading").Timer(60, process.kill)
        killer.start()
        _, status, usage = os.wait4(process.pid, 0)
        killer.cancel()
        took_s = time.monotonic() - began
    process.returncode = code = os.waitstatus_to_exitcode(status)
    said = (work / f"{name}.stderr").read_bytes().decode("utf-8", "replace")
    wrong = []
    if code not in (0, 1):
        wrong.append(f"exit code {code}: {said[-400:]}")
    if took_s > 20:
        wrong.append(f"{took_s:.1f} s")
    if usage.ru_maxrss > 1 << 20:
        wrong.append(f"{usage.ru_maxrss >> 10} MiB")
    if "panicked" in said or "\x1b[2J" in said:
        wrong.append("a panic, or a terminal that is controlled")
    if len(said) > 200_000:
        wrong.append(f"{len(said)} bytes of messages")
    reasons = []
    if code == 1:
        if "error[fly-policy-" not in said or "because:" not in said or "help:" not in said:
            wrong.append(f"a refusal without cause or way out: {said[-400:]}")
        if "fly-policy-unready" in said and out.exists():
            wrong.append("something is kept of a policy that never answered")
    elif code == 0:
        rows = [json.loads(line) for line in (out / "mine" / "episodes.jsonl").read_text().splitlines()]
        reasons = [row.get("policy_failure") for row in rows]
        if any(reason is not None and (len(reason) < 10 or len(reason) > 2000) for reason in reasons):
            wrong.append(f"a reason that says nothing: {reasons}")
    told = reasons[0] if reasons else said[said.rfind("because:") :].split("help:")[0]
    print(f"{name:34} {code} {took_s:5.1f} s {usage.ru_maxrss >> 10:4} MiB  {' '.join(str(told).split())[:110]}", flush=True)
    return [f"{name}: {it}" for it in wrong]


def check_module(name, text):
    (work / "modules" / f"hostile_{name}.py").write_text(text)
    return check(f"python_{name}", f"python:hostile_{name}:act")


def check_server(name, stage, behave):
    server = Server(stage, behave)
    try:
        return check(f"server_{name}", f"ws://127.0.0.1:{server.port}")
    finally:
        server.stop()


# Most of them wait: four at a time.
with ThreadPoolExecutor(4) as pool:
    tries = [pool.submit(check_module, *it) for it in MODULES.items() if chosen in f"python_{it[0]}"]
    tries += [pool.submit(check_server, name, *it) for name, it in SERVERS.items() if chosen in f"server_{name}"]
    found = [complaint for one in tries for complaint in one.result()]
print("\n".join(found))
print(f"{len(tries)} hostile policies, {len(found)} complaints")
sys.exit(bool(found))
