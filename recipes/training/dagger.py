"""Rounds of DAgger around the student of student.py, with `cosfly` alone.

Usage: dagger.py SUITE WORK_FOLDER [--cosfly COMMAND] [--store FOLDER] [--rounds 3] [--judge SUITE]
Prints the tracked share of the clone and of each round on the judge's suite (default: the same).
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import student

parser = argparse.ArgumentParser()
parser.add_argument("suite")
parser.add_argument("work", type=pathlib.Path)
parser.add_argument("--cosfly", default="cosfly")
parser.add_argument("--store")
parser.add_argument("--rounds", type=int, default=3)
parser.add_argument("--judge")
given = parser.parse_args()
given.work.mkdir(parents=True, exist_ok=True)
here = pathlib.Path(__file__).parent.resolve()
store = ["--store", given.store] if given.store else []
policy = ["--policy", "python:student:act", "--name", "student", "--python", sys.executable]


def cosfly(*arguments, weights=""):
    environment = {**os.environ, "PYTHONPATH": str(here), "STUDENT": str(weights)}
    command = [given.cosfly, *map(str, arguments), *store]
    return subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, text=True).stdout


def judged(round_):
    """Learns from a version of the labels, and flies."""
    labels, weights = given.work / f"v{round_}", (given.work / f"student{round_}.npz").resolve()
    student.train(labels, weights)
    told = cosfly(
        "fly", given.judge or given.suite, *policy, "--policy-version", f"round {round_}", "--clips", "0", "--logs", "none",
        "--json", "--out", given.work / f"flown{round_}", weights=weights,
    )
    rate = json.loads(told)["student"]["all"]["tracking_rate"]["mean"]
    print(f"round {round_}: tracking rate {rate:.3f}", flush=True)
    return weights, rate


cosfly("dagger", given.suite, "--policy", "hold", "--expert-share", "1", "--round", "clone", "--out", given.work / "v0")
weights, rate = judged(0)
rates = [rate]
for round_ in range(1, given.rounds + 1):
    old, new = given.work / f"v{round_ - 1}", given.work / f"v{round_}"
    print(cosfly(
        "dagger", given.suite, *policy, "--policy-version", f"round {round_ - 1}", "--expert-share", 0.5**round_,
        "--round", f"round{round_}", "--onto", old, "--out", new, weights=weights,
    ).splitlines()[-1])
    weights, rate = judged(round_)
    rates.append(rate)
print(f"clone {rates[0]:.3f}, after {given.rounds} rounds {rates[-1]:.3f}: {100 * (rates[-1] / rates[0] - 1):+.0f} %")
