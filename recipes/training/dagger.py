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

import tools

tools.need("numpy", "msgpack")
import student

HERE = pathlib.Path(__file__).parent.resolve()
POLICY = ["--policy", "python:student:act", "--name", "student", "--python", sys.executable]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("suite", help="recipe whose episodes are flown and labelled")
    parser.add_argument("work", type=pathlib.Path, help="folder for labels, weights and flights")
    parser.add_argument("--cosfly", default="cosfly", help="the program (default: cosfly)")
    parser.add_argument("--store", help="folder of the store, as for `cosfly run`")
    parser.add_argument("--rounds", type=tools.counted, default=3, help="rounds after the clone (default: 3)")
    parser.add_argument("--judge", help="recipe that the students are judged on (default: the same)")
    return parser.parse_args()


class Rounds:
    """Labels, students and their flights, in folders of `work`."""

    def __init__(self, given):
        self.given, self.store = given, ["--store", given.store] if given.store else []
        given.work.mkdir(parents=True, exist_ok=True)

    def cosfly(self, *words, weights=""):
        environment = {**os.environ, "PYTHONPATH": str(HERE), "STUDENT": str(weights)}
        return tools.cosfly([self.given.cosfly, *words, *self.store], env=environment, stdout=subprocess.PIPE, text=True).stdout

    def judged(self, round_):
        """Learns from a version of the labels, and flies."""
        labels, weights = self.given.work / f"v{round_}", (self.given.work / f"student{round_}.npz").resolve()
        student.train(labels, weights)
        told = self.cosfly(
            "fly", self.given.judge or self.given.suite, *POLICY, "--policy-version", f"round {round_}", "--clips", "0", "--logs", "none",
            "--json", "--out", self.given.work / f"flown{round_}", weights=weights,
        )  # fmt: skip
        rate = json.loads(told)["student"]["all"]["tracking_rate"]["mean"]
        print(f"round {round_}: tracking rate {rate:.3f}", flush=True)
        return weights, rate


def main():
    given = arguments()
    rounds = Rounds(given)
    rounds.cosfly("dagger", given.suite, "--policy", "hold", "--expert-share", "1", "--round", "clone", "--out", given.work / "v0")
    weights, rate = rounds.judged(0)
    rates = [rate]
    for round_ in range(1, given.rounds + 1):
        old, new = given.work / f"v{round_ - 1}", given.work / f"v{round_}"
        told = rounds.cosfly(
            "dagger", given.suite, *POLICY, "--policy-version", f"round {round_ - 1}", "--expert-share", 0.5**round_,
            "--round", f"round{round_}", "--onto", old, "--out", new, weights=weights,
        )  # fmt: skip
        print(told.splitlines()[-1])
        weights, rate = rounds.judged(round_)
        rates.append(rate)
    change = f"{100 * (rates[-1] / rates[0] - 1):+.0f} %" if rates[0] else "from nothing"
    print(f"clone {rates[0]:.3f}, after {given.rounds} rounds {rates[-1]:.3f}: {change}")


if __name__ == "__main__":
    tools.script(main)
