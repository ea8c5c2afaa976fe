"""All suites, flown by all baselines: the ranks, what the expert sees, the same bytes again; rounds of DAgger.

Usage: `check_suites.py COSFLY SUITES_FOLDER WORK_FOLDER`. Prints the table of the book's page "Benchmarks", section "Baselines in closed loop"."""

import json
import pathlib
import sys
import time

import numpy as np
from shared import bytes_of, json_lines
from shared import run as run_program

cosfly, suites, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]).resolve()
work.mkdir(parents=True, exist_ok=True)
names = ["random", "constant-velocity", "hold", "follow", "causal", "expert"]
store = ["--store", work / "store"]


def run(*arguments):
    return run_program(cosfly, *arguments, *store)


print("| suite | hash | " + " | ".join(f"`{name}`" for name in names) + " | certified | seen by the expert |")
print("| --- | --- |" + " --- |" * (len(names) + 2))
order = ["street", "unseen", "trees", "crowd", "vehicles", "loss", "night_rain", "hard"]
assert {path.stem for path in suites.glob("*.toml")} == set(order)
for suite in order:
    policies = [part for name in names for part in ("--policy", name)]
    scores = json.loads(run("fly", suites / f"{suite}.toml", *policies, "--json", "--clips", "0", "--logs", "none", "--out", work / suite))
    rate = {name: scores[name]["all"]["tracking_rate"]["mean"] for name in names}
    rows = json_lines(work / suite / "expert/episodes.jsonl")
    stated = np.mean([row["certified_visibility"] for row in rows])
    seen = np.mean([row["score"]["visible_sum"] / row["score"]["steps"] for row in rows])
    digest = json.loads((work / suite / "expert/card.json").read_text())["suite"]["hash"]
    cells = " | ".join(f"{rate[name]:.3f}" for name in names)
    print(f"| {suite} | `{digest[:8]}` | {cells} | {stated:.3f} | {seen:.3f} |", flush=True)
    idle = max(rate["hold"], rate["constant-velocity"])
    assert rate["random"] < idle < rate["causal"] <= rate["expert"] + 1e-9 and rate["follow"] < rate["causal"], (suite, rate)
    assert abs(stated - seen) < 0.01, (suite, stated, seen)

# A suite with a quadrotor, wind and gusts gives the same bytes again, in shares.
for share in ("2/3", "1/3", "3/3"):
    run("fly", suites / "night_rain.toml", "--policy", "causal", "--shard", share, "--jobs", "1", "--clips", "1", "--out", work / "shares")
run("fly", suites / "night_rain.toml", "--policy", "causal", "--jobs", "2", "--clips", "1", "--out", work / "whole")
assert bytes_of(work / "shares") == bytes_of(work / "whole")

# Labels: how many a second; a small student gains by three rounds.
begun = time.monotonic()
told = run("dagger", suites / "street.toml", "--policy", "random", "--expert-share", "0", "--round", "r", "--out", work / "labels")
seconds = time.monotonic() - begun
made = json.loads((work / "labels/card.json").read_text())["rounds"][0]["made"]
print(f"{made['labels']} labels in {seconds:.1f} s; {told.splitlines()[0]}")
loop = pathlib.Path(__file__).resolve().parents[2] / "recipes/training/dagger.py"
rounds = run_program(sys.executable, loop, suites / "street.toml", work / "dagger", "--cosfly", cosfly, *store)
print(rounds)
clone, last = (float(line.rsplit(" ", 1)[1]) for line in rounds.splitlines() if line.startswith(("round 0", "round 3")))
assert last >= 1.3 * clone, (clone, last)
print("suites: all as they should be")
