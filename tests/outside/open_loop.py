"""What open-loop errors of a policy tell of its closed-loop score: R2 and rank correlation, on suites that chose nothing.

Usage: `open_loop.py COSFLY SUITES_FOLDER WORK_FOLDER [--choose street] [--test unseen trees] [--shares 0.9 0.5] [--every N]`. Each policy answers in
states of flights that the expert flies, but for single frames (half a second) that the policy flies itself: `cosfly dagger` with these shares of the
expert. The error is that of its action from the expert's in the same state. A *lasting* error is the length of the mean error vector of a flight,
averaged over flights: errors that cancel do not count, errors that add up do. The metric, the share and the line from it to `tracking_rate` are
chosen on the suites of --choose; R2 and Spearman's correlation are of each suite of --test. Of the policies, each whose number --every divides is
taken."""

import json

import numpy as np
from scipy.stats import spearmanr
from shared import command_line, json_lines
from shared import run as run_program

given = command_line("cosfly suites work", choose=["street"], test=["unseen"], every=1, shares=[0.9, 0.5])
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


def errors(suite, policy, share):
    """A list over flights: actions of the policy less those of the expert in the same states (n, 5), m/s and degrees/s."""
    out = work / f"{suite}-{share}-{policy.replace(':', '-').replace('=', '').replace(',', '-')}"
    run("dagger", given.suites / f"{suite}.toml", "--policy", policy, "--expert-share", share, "--round", "r", "--out", out)
    flights = []
    for path in sorted((out / "rounds" / "r").glob("*.jsonl")):
        own = [np.subtract(row["action"], row["expert_action"]) for row in json_lines(path) if not row["by_expert"] and row["expert_action"]]
        if own:
            flights.append(np.array(own))
    return flights


def metrics(flights):
    """By name what a line is fitted to, one or two numbers: an error by its logarithm, or by how near it is to where more hardly matters."""
    own = np.concatenate(flights)
    apart, turn = np.linalg.norm(own[:, :3], axis=1), np.linalg.norm(own[:, 3:], axis=1)
    lasting = np.mean([np.linalg.norm(flight[:, :3].mean(axis=0)) for flight in flights])
    lasting_turn = np.mean([np.linalg.norm(flight[:, 3:].mean(axis=0)) for flight in flights])
    singles = {
        "mean error of the velocity": apart.mean(), "median error of the velocity": np.median(apart),
        "share of velocities off by 2 m/s": (apart > 2).mean(),
        "mean error of the turn": turn.mean(), "median error of the turn": np.median(turn),
        "share of turns off by 10 degrees/s": (turn > 10).mean(),
        "velocity + turn / 10": (apart + turn / 10).mean(),
        "lasting error of the velocity": lasting, "lasting error of the turn": lasting_turn,
    }
    near = [lasting / (1 + lasting), lasting_turn / (10 + lasting_turn)]  # a half at 1 m/s and at 10 degrees/s
    columns = {name: [np.log(value + 1e-3)] for name, value in singles.items()}
    return columns | {"lasting errors, two weights": near, "lasting errors, one weight": [sum(near)]}


def spearman(first, second):
    return spearmanr(first, second)[0] if np.ptp(first) > 0 and np.ptp(second) > 0 else 0.0


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
            flights = [flight for suite in suites for flight in errors(suite, policy, share)]
            for name, values in metrics(flights).items():
                columns.setdefault((name, share), []).append(values)
    return rates, {name: np.c_[np.ones(len(POLICIES)), values] for name, values in columns.items()}


rates, chosen = table(given.choose)
weights = {name: np.linalg.lstsq(columns, rates, rcond=None)[0] for name, columns in chosen.items()}
order = sorted(chosen, key=lambda name: -np.nan_to_num(r2(rates, chosen[name] @ weights[name])))
print(f"{len(POLICIES)} policies; chosen on {', '.join(given.choose)}\n")
print("| metric | expert's share | line | R2, chosen on |\n| --- | --- | --- | --- |")
for name in order:
    line = " ".join(f"{weight:.2f}" for weight in weights[name])
    print(f"| {name[0]} | {name[1]} | {line} | {r2(rates, chosen[name] @ weights[name]):.2f} |")
for suite in given.test:
    test_rates, test = table([suite])
    print(f"\n| metric | expert's share | R2, {suite} | rank correlation, {suite} |\n| --- | --- | --- | --- |")
    predicted = {name: test[name] @ weights[name] for name in order} | {("tracking rate in closed loop on the suites chosen on", ""): rates}
    for (name, share), guess in predicted.items():
        tested = interval(lambda it: r2(test_rates[it], guess[it]), len(POLICIES))
        ranked = interval(lambda it: spearman(guess[it], test_rates[it]), len(POLICIES))
        print(f"| {name} | {share} | {r2(test_rates, guess):.2f} {tested} | {spearman(guess, test_rates):.2f} {ranked} |")
