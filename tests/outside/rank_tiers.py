"""How the smaller tiers of a benchmark rank policies against the largest: variations of the baselines, Spearman's rank correlation.

Usage: `rank_tiers.py COSFLY BENCHMARK WORK_FOLDER [--causal] [--students]`. Flies the largest tier once for each policy; an episode has the same row in every
tier, so the smaller ones are parts of it. Prints the table of the book's page "A benchmark in tiers". With --causal, variations of the planner are
flown, too (slow). With --students, the networks that ship and nine students: three sizes, a clone and two rounds of DAgger each, learnt on walks of
another seed (needs numpy and msgpack)."""

import os
import sys
import time
from pathlib import Path

from scipy.stats import spearmanr
from shared import command_line, json_lines, run

given = command_line("cosfly benchmark work", causal=False, students=False)
work = given.work.resolve()
work.mkdir(parents=True, exist_ok=True)
TIERS = ["mini", "standard", "full"]

CHANGES = ["", "gain=0.25", "gain=0.5", "gain=0.75", "gain=1.5", "gain=2", "delay_s=0.3", "delay_s=0.6", "delay_s=1", "delay_s=2"]
CHANGES += ["lead_s=0.2", "lead_s=0.5", "gain=0.5,lead_s=0.5", "noise_mps=1", "noise_mps=3", "noise_mps=6", "gain=0.5,delay_s=0.5", "gain=1.5,delay_s=0.5,noise_mps=1"]
policies = [f"{name}:{change}".rstrip(":") for name in ("follow", "expert") for change in CHANGES]
policies += ["hold", "random", "constant-velocity", "constant-velocity:gain=0.5", "constant-velocity:gain=2", "random:gain=0.3"]
if given.causal:
    policies += ["causal", "causal:delay_s=0.6", "causal:noise_mps=3", "causal:gain=0.5"]
ROOT = Path(__file__).absolute().parents[2]
SIZES, ROUNDS = (4, 16, 64), 3


def learn():
    """Weights of students by their names."""
    sys.path.append(str(ROOT / "recipes/training"))
    import student

    weights = {}
    suite = [ROOT / "recipes/suites/street.toml", "--set", "seed=7001", "--store", work / "store", "--python", sys.executable]
    for size in SIZES:
        student.HIDDEN = size
        for number in range(ROUNDS):
            of = ["--policy", "python:student:act", "--onto", work / f"labels-{size}-{number - 1}"] if number else ["--policy", "hold"]
            labels = work / f"labels-{size}-{number}"
            of += ["--expert-share", 0.5**number, "--round", f"round{number}", "--out", labels]
            run(given.cosfly.resolve(), "dagger", *suite, *of, env=student_of(weights.get(f"student-{size}-{number - 1}")))
            weights[f"student-{size}-{number}"] = work / f"student-{size}-{number}.npz"
            student.train(labels, weights[f"student-{size}-{number}"])
    return weights


def student_of(weights):
    """Environment of a program that flies a student."""
    return {**os.environ, "PYTHONPATH": str(ROOT / "recipes/training"), "STUDENT": str(weights)}


def fly(tier, policies, *more, **options):
    command = [given.cosfly.resolve(), "fly", given.benchmark, "--tier", tier, "--clips", "0", "--logs", "none", "--quiet", "--json"]
    command += ["--store", work / "store", "--out", work / tier]
    begun = time.monotonic()
    run(*command, *more, *(part for policy in policies for part in ("--policy", policy)), **options)
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
if given.students:
    for name, weights in learn().items():
        fly("full", ["python:student:act"], "--name", name, "--python", sys.executable, env=student_of(weights))
    fly("full", [f"onnx:{file}" for file in sorted((ROOT / "recipes/policies").glob("*.onnx"))])
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
