"""Failures that `cosfly hunt` finds, beside random sampling with as many flights, on suites and policies that chose nothing.

Usage: `check_hunt.py COSFLY SUITES_FOLDER WORK_FOLDER [--budget 40] [--pool 1600] [--seeds 1 2 3] [--drawn 200] [--policies POLICY ...]` (of those
below; all where left out). Random sampling flies `--drawn` candidates of a pool of another seed, so that its share of failures is known well. A
failure of a hunt is a walk: no walk counts twice. Prints the table of the book's page "Hunting for failures". The intervals (95 %) come from
resampled seeds of hunts and resampled random flights."""

import numpy as np
from shared import command_line, json_of

given = command_line("cosfly suites work", budget=40, pool=1600, drawn=200, seeds=[1, 2, 3], policies=[str])

CASES = [
    ("trees", "expert:delay_s=0.6"), ("loss", "expert:gain=1.4,delay_s=0.5"), ("hard", "expert:noise_mps=2.5"),
    ("trees", "causal"), ("loss", "causal"), ("hard", "causal"), ("street", "expert:delay_s=0.8"),
    ("street", "expert:noise_mps=3,gain=0.9"), ("vehicles", "follow:gain=0.5,delay_s=0.3,noise_mps=1"),
]
store = ["--store", given.work.resolve() / "store"]
stream = np.random.default_rng(1)


def hunt(suite, policy, *options):
    out = given.work.resolve() / "-".join([suite, *map(str, options), policy]).replace("/", "-").replace(":", "-").replace("=", "")
    return json_of(given.cosfly.resolve(), "hunt", given.suites / f"{suite}.toml", "--policy", policy, "--out", out, *store, "--json", *options)


def interval(values):
    return "[{:.1f}, {:.1f}]".format(*np.quantile(values, [0.025, 0.975]))


print(f"| suite | policy | failures of {given.budget}, hunted | random | times | at most |\n| --- | --- | --- | --- | --- | --- |")
for suite, policy in CASES:
    if given.policies and policy not in given.policies:
        continue
    drawn = hunt(suite, policy, "--search", "random", "--seed", 99, "--pool", given.drawn, "--budget", given.drawn)
    share = drawn["failures"] / drawn["flown"]
    found = [hunt(suite, policy, "--seed", seed, "--pool", given.pool, "--budget", given.budget) for seed in given.seeds]
    assert all(it["walks"] == it["failures"] for it in found), found
    shares = np.array([it["failures"] / given.budget for it in found])
    hunted = stream.choice(shares, (2000, len(shares))).mean(axis=1)
    rates = stream.binomial(drawn["flown"], share, 2000) / drawn["flown"]
    times = hunted / np.maximum(rates, 0.5 / drawn["flown"])
    mean = given.budget * shares.mean()
    print(
        f"| {suite} | `{policy}` | {mean:.1f} | {given.budget * share:.1f} {interval(given.budget * rates)} "
        f"| {shares.mean() / max(share, 0.5 / drawn['flown']):.1f} {interval(times)} | {1 / max(share, 0.5 / drawn['flown']):.1f} |",
        flush=True,
    )
