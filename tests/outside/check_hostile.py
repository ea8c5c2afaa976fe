"""`cosfly fly` against hostile policies: no crash, at most 1 GB, at most 20 s each, and every refusal names place and way out.

Usage: `check_hostile.py COSFLY SUITE WORK_FOLDER [PART_OF_A_NAME]`."""

import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

from hostile_policies import MODULES, SERVERS, Server
from shared import json_lines, run

cosfly, suite, work = (pathlib.Path(it).resolve() for it in sys.argv[1:4])
chosen = sys.argv[4] if len(sys.argv) > 4 else ""
shutil.rmtree(work / "out", ignore_errors=True)
(work / "modules").mkdir(parents=True, exist_ok=True)
FEW = ["--set", "stages.walkers.count=2", "--jobs", "2", "--clips", "0", "--logs", "none"]
PATIENCE = ["--timeout-s", "2", "--wait-s", "3"]
KEY = "pass-1234-word"
run(cosfly, "fly", suite, "--store", work / "store", "--policy", "hold", "--out", work / "out", *FEW)


def check(name, policy):
    """Flies one hostile policy; gives what is wrong about it."""
    out = work / "out" / name
    command = [cosfly, "fly", suite, "--store", work / "store", "--out", out, "--name", "mine", *FEW, *PATIENCE]
    command += ["--policy", policy, "--python", sys.executable]
    environment = os.environ | {"COSFLY_API_KEY": KEY, "PYTHONDONTWRITEBYTECODE": "1"}
    with open(work / f"{name}.stdout", "wb") as stdout, open(work / f"{name}.stderr", "wb") as stderr:
        began = time.monotonic()
        process = subprocess.Popen(command, cwd=work / "modules", stdout=stdout, stderr=stderr, env=environment)
        killer = threading.Timer(60, process.kill)
        killer.start()
        _, status, usage = os.wait4(process.pid, 0)
        killer.cancel()
        took_s = time.monotonic() - began
    process.returncode = code = os.waitstatus_to_exitcode(status)
    said = (work / f"{name}.stderr").read_bytes().decode("utf-8", "replace")
    reasons = [row.get("policy_failure") for row in json_lines(out / "mine/episodes.jsonl")] if code == 0 else []
    faults = {
        f"exit code {code}: {said[-400:]}": code not in (0, 1),
        f"{took_s:.1f} s": took_s > 20,
        f"{usage.ru_maxrss >> 10} MiB": usage.ru_maxrss > 1 << 20,
        "a panic, or a terminal that is controlled": "panicked" in said or "\x1b[2J" in said,
        f"{len(said)} bytes of messages": len(said) > 200_000,
        f"a refusal without cause or way out: {said[-400:]}": code == 1 and not all(it in said for it in ("error[fly-policy-", "because:", "help:")),
        "something is kept of a policy that never answered": code == 1 and "fly-policy-unready" in said and out.exists(),
        f"a reason that says nothing: {reasons}": any(reason is not None and not 10 <= len(reason) <= 2000 for reason in reasons),
    }
    told = reasons[0] if reasons else said[said.rfind("because:") :].split("help:")[0]
    print(f"{name:34} {code} {took_s:5.1f} s {usage.ru_maxrss >> 10:4} MiB  {' '.join(str(told).split())[:110]}", flush=True)
    return [f"{name}: {words}" for words, is_so in faults.items() if is_so]


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
