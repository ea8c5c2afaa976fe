"""The report of `run.py`: our tables beside the paper's, and its findings, judged by intervals over flights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

import numpy as np

from rows import ADE, FDE, HARD_FAIL, JOINT, METRICS, ROTATION, ROWS, SR_1M, SR_2M, YAW, ZERO, PaperWindows, Row

RESAMPLES = 1000
# Two rows whose interval stays within this are alike.
ALIKE = 0.1
# Fewer flights have no interval to judge by.
FEWEST = 8
COLUMNS = {"Scaling": [ADE, FDE, SR_2M], "Maps": [SR_1M, JOINT, ROTATION, HARD_FAIL]}
USUAL = [ADE, FDE, SR_1M, YAW]
Interval = Tuple[float, float, float]
Results = Dict[Row, List[np.ndarray]]


@dataclass(frozen=True)
class Finding:
    """`metric` is larger in the first row and windows than in the second; `is_alike`: nearly the same."""

    claim: str
    metric: int
    more: Tuple[str, str]
    less: Tuple[str, str]
    paper: str
    is_alike: bool = False


FULL, POSE, BOX = "Modality pose + box", "Modality pose", "Modality box"
DENOISING, EXPERTS = "Paradigm denoising", "Paradigm expert only"
FINDINGS = [
    Finding("Training beats predicting zero", FDE, ("Baseline predict zero", "all"), (FULL, "all"), "2.87 - 1.30"),
    Finding("Training beats predicting zero on yaw", YAW, ("Baseline predict zero", "all"), (FULL, "all"), "not told"),
    Finding("Pose history is the decisive input", FDE, (BOX, "all"), (POSE, "all"), "3.81 - 1.25"),
    Finding("Boxes add little to poses on the path", FDE, (POSE, "all"), (FULL, "all"), "1.248 - 1.249", is_alike=True),
    Finding("Pictures add little to poses and boxes", FDE, (FULL, "all"), ("Modality RGB + pose + box", "all"), "1.264 - 1.249", is_alike=True),
    Finding("Denoising beats expert only on yaw", YAW, (EXPERTS, "all"), (DENOISING, "all"), "6.54 - 3.97"),
    Finding("Denoising beats expert only on the path", FDE, (EXPERTS, "all"), (DENOISING, "all"), "1.270 - 1.239"),
    Finding("Denoising beats mixed on the path", FDE, ("Paradigm mixed", "all"), (DENOISING, "all"), "1.249 - 1.239"),
    Finding("Half of the data beats a quarter", FDE, ("Scaling 25 %", "all"), ("Scaling 50 %", "all"), "2.744 - 2.686"),
    Finding("All data beat half of them", FDE, ("Scaling 50 %", "all"), ("Scaling 100 %", "all"), "2.686 - 2.642"),
    Finding("Unseen places are harder", FDE, (FULL, "unseen"), (FULL, "seen"), "1.311 - 0.882"),
    Finding("Hard windows are harder than easy ones", FDE, (FULL, "hard"), (FULL, "easy"), "2.17 - 0.75"),
    Finding("Several maps beat one: share within 0.5 m and 1 degree", JOINT, ("Maps several maps", "all"), ("Maps one map", "all"), "47.44 - 42.13"),
    Finding("Several maps beat one: rotation", ROTATION, ("Maps one map", "all"), ("Maps several maps", "all"), "2.40 - 2.10"),
    Finding("Several maps beat one in unseen places", FDE, ("Maps one map", "unseen"), ("Maps several maps", "unseen"), "not told"),
]


def parts(judged: PaperWindows) -> Dict[str, np.ndarray]:
    found = {"all": np.ones(len(judged), bool), "seen": judged.is_seen, "unseen": ~judged.is_seen}
    return {**found, **{name: judged.difficulty == level for level, name in enumerate(["easy", "medium", "hard"])}}


def interval(walkers: np.ndarray, more: Tuple[np.ndarray, np.ndarray], less: Optional[Tuple[np.ndarray, np.ndarray]] = None) -> Interval:
    """Mean of the values of a part of the windows, less the mean of others, and the middle 95 % over resamples of whole walkers' flights."""
    count = walkers.max() + 1
    drawn = np.random.default_rng(1).integers(count, size=(RESAMPLES, count))

    def means(values: np.ndarray, part: np.ndarray) -> Tuple[float, np.ndarray]:
        sums, windows = (np.bincount(walkers[part], weights, count) for weights in (values[part], None))
        with np.errstate(invalid="ignore", divide="ignore"):
            return values[part].mean() if part.any() else np.nan, sums[drawn].sum(axis=1) / windows[drawn].sum(axis=1)

    middle, spread = means(*more)
    if less is not None:
        other, others = means(*less)
        middle, spread = middle - other, spread - others
    return (middle, *np.nanpercentile(spread, [2.5, 97.5])) if np.isfinite(middle) else (np.nan,) * 3


def cell(values: Interval) -> str:
    return "none" if np.isnan(values[0]) else "{:.2f} [{:.2f}, {:.2f}]".format(*values)


def table(name: str, results: Results, counts: Dict[Row, int], judged: PaperWindows) -> List[str]:
    columns = COLUMNS.get(name, USUAL)
    head = [name, "windows learnt"] + [METRICS[it] for it in columns] + ["the paper, same columns"]
    lines = [f"| {' | '.join(head)} |", f"| {' | '.join(['---', '---:'] + ['---:'] * (len(columns) + 1))} |"]
    whole = np.ones(len(judged), bool)
    for row in (row for row in ROWS if row.table == name):
        told = " / ".join(f"{row.paper[it]:g}" if it in row.paper else "-" for it in columns) if row.paper else "-"
        cells = ["not run"] * len(columns)
        if row in results:
            means = np.mean(results[row], axis=0)
            cells = [cell(interval(judged.walker, (means[:, it], whole))) for it in columns]
        lines.append(f"| {' | '.join([row.name, str(counts.get(row, '-')), *cells, told])} |")
    return lines + [""]


def by_part(results: Results, judged: PaperWindows) -> List[str]:
    names = ["seen", "unseen", "easy", "medium", "hard"]
    masks = parts(judged)
    counts = [f"{name} ({masks[name].sum()})" for name in names]
    lines = [f"| FDE, m, by part (windows) | {' | '.join(counts)} |", "| --- |" + " ---: |" * len(names)]
    for row in (row for row in ROWS if row in results):
        fde = np.mean(results[row], axis=0)[:, FDE]
        lines.append(f"| {row.table}: {row.name} | {' | '.join(cell(interval(judged.walker, (fde, masks[name]))) for name in names)} |")
    return lines + [""]


def verdict(values: Interval, finding: Finding) -> str:
    _, low, high = values
    if finding.is_alike:
        return "holds" if -ALIKE < low and high < ALIKE else "does NOT hold" if low > ALIKE or high < -ALIKE else "is undecided"
    return "holds" if low > 0 else "does NOT hold: the reverse does" if high < 0 else "is undecided"


def findings(results: Results, judged: PaperWindows) -> List[str]:
    by_name, masks, lines = {f"{row.table} {row.name}": row for row in results}, parts(judged), []
    for finding in FINDINGS:
        sides = [finding.more, finding.less]
        if not all(name in by_name for name, _ in sides):
            lines.append(f"* **{finding.claim}: not run.**")
            continue
        of = [(np.mean(results[by_name[name]], axis=0)[:, finding.metric], masks[part]) for name, part in sides]
        values = interval(judged.walker, *of)
        means = " - ".join("none" if not part.any() else f"{column[part].mean():.2f}" for column, part in of)
        is_judged = all(len(np.unique(judged.walker[part])) >= FEWEST for _, part in of)
        told = verdict(values, finding) if is_judged else "has too few flights to judge"
        lines.append(
            f"* **{finding.claim}: {told}.** {METRICS[finding.metric]}: {means} = {cell(values)}; the paper: {finding.paper}."
        )
    return lines + [""]


def downstream(scene: Optional[np.ndarray]) -> List[str]:
    paper = {"AbsRel": 0.045, "RMSE, m": 2.50, "delta1": 0.972, "mIoU": 0.862, "AP50": 94.2}
    lines = ["| Depth, labels, people from one picture, unseen places | from scratch | the paper, fine-tuned |", "| --- | ---: | ---: |"]
    cells = ["not run"] * len(paper) if scene is None else ["{:.3f} [{:.3f}, {:.3f}]".format(*it) for it in scene]
    return lines + [f"| {name} | {ours} | {theirs:g} |" for (name, theirs), ours in zip(paper.items(), cells)] + [""]


def written(results: Results, counts: Dict[Row, int], judged: PaperWindows, scene: Optional[np.ndarray], anchor: str) -> str:
    seeds = max((len(it) for row, it in results.items() if row != ZERO), default=0)
    lines = [
        f"{len(judged)} perturbed windows of {judged.walker.max() + 1} walkers judged; waypoints begin at the {anchor}'s pose; mean of {seeds} "
        f"seed{'s' * (seeds != 1)};\nin brackets the middle 95 % of {RESAMPLES} resamples of whole flights. The paper's networks have 0.8 billion weights.\n"
    ]
    for name in dict.fromkeys(row.table for row in ROWS):
        lines += table(name, results, counts, judged)
    lines += by_part(results, judged) + downstream(scene) + findings(results, judged)
    return "\n".join(lines)
