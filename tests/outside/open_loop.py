"""What open-loop errors of a policy tell of its closed-loop score: R2 and rank correlation, on suites that chose nothing.

Usage: open_loop.py COSFLY SUITES_FOLDER WORK_FOLDER [--choose street] [--test unseen] [--shares 0.9 0.5]
Each policy answers in states of flights that the expert flies, but for single frames (half a second) that the policy flies itself:
`cosfly dagger` with these shares of the expert. The error is that of its action from the expert's in the same state. The metric, the share
and the line from it to `tracking_rate` are chosen on the suites of --choose; R2 and Spearman's correlation are of the suites of --test.
"""

import argparse
import json
import pathlib

import numpy as np
from scipy.stats import spearmanr
from shared import run as run_program

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("cosfly", type=pathlib.Path)
parser.add_argument("suites", type=pathlib.Path)
parser.add_argument("work", type=pathlib.Path)
parser.add_argument("--choose", nargs="+", default=["street"])
parser.add_argument("--test", nargs="+", default=["unseen"])
parser.add_argument("--every", type=int, default=1, help="take each policy whose number it divides")
parser.add_argument("--shares", nargs="+", type=float, default=[0.9, 0.5])
given = parser.parse_args()
work = given.work.resolve()

CHANGES = ["", "gain=0.5", "gain=0.75", "gain=1.5", "delay_s=0.3", "delay_s=0.8", "noise_mps=1", "noise_mps=4", "gain=0.5,delay_s=0.5"]
POLICIES = [f"{name}:{change}".rstrip(":") for name in ("follow", "expert") for change in CHANGES]
POLICIES += ["hold", "random", "constant-velocity", "constant-velocity:gain=0.5", "random:gain=0.3", "constant-velocity:noise_mps=2"]
POLICIES = POLICIES[:: given.every]
store = ["--store", work / "store"]


def run(*arguments):
    return run_program(given.cosfly.resolve(), *arguments, *store)


def closed(suite, policy):
    options = ["--policy", policy, "--json", "--logs", "none", "--clips", "0", "--out", work / f"fly-{suite}"]
    (scores,) = json.loads(run("fly", given.suites / f"{suite}.toml", *options)).values()
    return scores["all"]["tracking_rate"]["mean"]


def answers(suite, policy, share):
    """Actions of the policy and of the expert in the same states: velocities (m/s), turns (degrees/s)."""
    out = work / f"{suite}-{share}-{policy.replace(':', '-').replace('=', '').replace(',', '-')}"
    run("dagger", given.suites / f"{suite}.toml", "--policy", policy, "--expert-share", share, "--round", "r", "--out", out)
    own = ~np.load(out / "by_expert.npy").astype(bool).reshape(-1)
    return np.load(out / "actions.npy")[own].astype(float), np.load(out / "expert_actions.npy")[own].astype(float)


def metrics(own, expert):
    apart = np.linalg.norm(own[:, :3] - expert[:, :3], axis=1)
    turn = np.linalg.norm(own[:, 3:] - expert[:, 3:], axis=1)
    bias = np.linalg.norm((own[:, :3] - expert[:, :3]).mean(axis=0))
    return {
        "mean error of the velocity": apart.mean(),
        "median error of the velocity": np.median(apart),
        "90 % of the errors of the velocity": np.quantile(apart, 0.9),
        "share of velocities off by 2 m/s": (apart > 2).mean(),
        "mean error of the turn": turn.mean(),
        "median error of the turn": np.median(turn),
        "90 % of the errors of the turn": np.quantile(turn, 0.9),
        "share of turns off by 10 degrees/s": (turn > 10).mean(),
        "bias of the velocity": bias,
        "velocity + turn / 10": (apart + turn / 10).mean(),
    }


def spearman(first, second):
    return spearmanr(first, second)[0] if np.ptp(first) > 0 and np.ptp(second) > 0 else 0.0


def correlation(first, second):
    return np.corrcoef(first, second)[0, 1] if np.ptp(first) > 0 and np.ptp(second) > 0 else 0.0


def r2(truth, predicted):
    """Not a number where all policies have one rate: there is nothing to explain."""
    return 1 - ((truth - predicted) ** 2).sum() / ((truth - truth.mean()) ** 2).sum() if np.ptp(truth) > 0 else np.nan


def interval(of, count):
    stream = np.random.default_rng(1)
    draws = np.array([of(stream.integers(0, count, count)) for _ in range(1000)])
    draws = draws[np.isfinite(draws)]
    return "[{:.2f}, {:.2f}]".format(*np.quantile(draws, [0.025, 0.975])) if draws.size else "[none]"


def table(suites):
    rates = np.array([np.mean([closed(suite, policy) for suite in suites]) for policy in POLICIES])
    columns = {}
    for share in given.shares:
        for policy in POLICIES:
            parts = [answers(suite, policy, share) for suite in suites]
            for name, value in metrics(*(np.concatenate(it) for it in zip(*parts))).items():
                columns.setdefault((name, share), []).append(value)
    return rates, {name: np.log(np.array(values) + 1e-3) for name, values in columns.items()}


rates, chosen = table(given.choose)
test_rates, test = table(given.test)
order = sorted(chosen, key=lambda it: correlation(chosen[it], rates))
print(f"{len(POLICIES)} policies; chosen on {', '.join(given.choose)}, tested on {', '.join(given.test)}\n")
print("| metric | expert's share | R2, chosen on | R2, tested | rank correlation, tested |\n| --- | --- | --- | --- | --- |")
for name, share in order:
    slope, height = np.polyfit(chosen[name, share], rates, 1)
    predicted, errors = slope * test[name, share] + height, test[name, share]
    own = r2(rates, slope * chosen[name, share] + height)
    tested = interval(lambda it: r2(test_rates[it], predicted[it]), len(POLICIES))
    ranked = interval(lambda it: spearman(-errors[it], test_rates[it]), len(POLICIES))
    print(f"| {name} | {share} | {own:.2f} | {r2(test_rates, predicted):.2f} {tested} | {spearman(-errors, test_rates):.2f} {ranked} |")
