"""How the smaller tiers of a benchmark rank policies against the largest: variations of the baselines, Spearman's rank correlation.

Usage: `rank_tiers.py COSFLY BENCHMARK WORK_FOLDER [--causal]`. Flies the largest tier once for each policy; an episode has the same row in every
tier, so the smaller ones are parts of it. Prints the table of the book's page "A benchmark in tiers". With --causal, variations of the planner are
flown, too (slow)."""

import time

from scipy.stats import spearmanr
from shared import command_line, json_lines, run

given = command_line("cosfly benchmark work", causal=False)
work = given.work.resolve()
work.mkdir(parents=True, exist_ok=True)
TIERS = ["mini", "standard", "full"]

CHANGES = ["", "gain=0.25", "gain=0.5", "gain=0.75", "gain=1.5", "gain=2", "delay_s=0.3", "delay_s=0.6", "delay_s=1", "delay_s=2"]
CHANGES += ["noise_mps=1", "noise_mps=3", "noise_mps=6", "gain=0.5,delay_s=0.5", "gain=1.5,delay_s=0.5,noise_mps=1"]
policies = [f"{name}:{change}".rstrip(":") for name in ("follow", "expert") for change in CHANGES]
policies += ["hold", "random", "constant-velocity", "constant-velocity:gain=0.5", "constant-velocity:gain=2", "random:gain=0.3"]
if given.causal:
    policies += ["causal", "causal:delay_s=0.6", "causal:noise_mps=3", "causal:gain=0.5"]


def fly(tier, policies):
    command = [given.cosfly.resolve(), "fly", given.benchmark, "--tier", tier, "--clips", "0", "--logs", "none", "--quiet", "--json"]
    command += ["--store", work / "store", "--out", work / tier]
    begun = time.monotonic()
    run(*command, *(part for policy in policies for part in ("--policy", policy)))
    return time.monotonic() - begun


def rates(folder):
    return {row["episode"]: row["score"]["tracked_steps"] / row["score"]["planned_steps"] for row in json_lines(folder / "episodes.jsonl")}


made = fly("full", ["hold"])
print(f"making all episodes and flying `hold` once: {made:.0f} s", flush=True)
episodes = {}
for tier in TIERS:
    seconds = fly(tier, ["follow"])
    episodes[tier] = sorted(rates(work / tier / "follow"))
    print(f"`follow` on {tier}: {len(episodes[tier])} episodes, {seconds:.0f} s", flush=True)
fly("full", policies)
table = {folder.name: rates(folder) for folder in sorted((work / "full").iterdir()) if (folder / "episodes.jsonl").exists()}
score = {tier: [sum(rows[name] for name in episodes[tier]) / len(episodes[tier]) for rows in table.values()] for tier in TIERS}
print(f"\n| tier | episodes | rank correlation with full, {len(table)} policies | largest difference of a tracking rate |\n| --- | --- | --- | --- |")
for tier in TIERS:
    apart = max(abs(a - b) for a, b in zip(score[tier], score["full"]))
    print(f"| {tier} | {len(episodes[tier])} | {spearmanr(score[tier], score['full'])[0]:.3f} | {apart:.3f} |")
for name, *numbers in sorted(zip(table, *(score[tier] for tier in TIERS)), key=lambda it: -it[-1]):
    print(f"{name:<44}", *(f"{number:.3f}" for number in numbers))
worst = min(spearmanr(score[tier], score["full"])[0] for tier in TIERS)
assert len(table) >= 30 and worst >= 0.95, (len(table), worst)
