"""Rows of the paper's tables: what each learns from, what it sees, and its scores window by window."""

from __future__ import annotations

import copy
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent))
import networks  # noqa: E402
import small_networks as base  # noqa: E402
from small_networks import EXPERT, PERTURBED, Windows  # noqa: E402

METRICS = ["ADE, m", "FDE, m", "SR@1m, %", "yaw, degrees", "SR@2m, %", "JointSR, %", "rotation, degrees", "HardFail, %"]
ADE, FDE, SR_1M, YAW, SR_2M, JOINT, ROTATION, HARD_FAIL = range(8)
BOTH, DENOISING, EXPERTS = (PERTURBED, EXPERT), (PERTURBED,), (EXPERT,)
Numbers = Dict[int, float]


@dataclass(frozen=True, eq=False)
class Row:
    """A row: inputs of `pose`, `box`, `depth`, `rgb`; roles and share of the flights of split train; towns: all, one, or as many flights of several."""

    table: str
    name: str
    inputs: str
    paper: Numbers
    roles: Tuple[int, ...] = BOTH
    share: float = 1.0
    towns: str = "all"
    pretrained: bool = False

    def needs_pictures(self) -> bool:
        return "rgb" in self.inputs or "depth" in self.inputs

    def slug(self) -> str:
        """Name of the results: rows that learn the same share them."""
        roles = "".join(map(str, sorted(self.roles)))
        name = "pretrained-" if self.pretrained else ""
        return f"{name}{self.inputs.replace(' ', '_') or 'zero'}-roles{roles}-{100 * self.share:.0f}-{self.towns}"


def paper(ade: float, fde: float, sr_1m: float, yaw: float) -> Numbers:
    return {ADE: ade, FDE: fde, SR_1M: sr_1m, YAW: yaw}


ZERO = Row("Baseline", "predict zero", "", {FDE: 2.872, SR_1M: 25.17})
ROWS = [
    ZERO,
    Row("Modality", "pose + box", "pose box", paper(0.849, 1.264, 77.1, 3.85)),
    Row("Modality", "pose", "pose", {}),
    Row("Modality", "box", "box", {}),
    Row("Modality", "pose + box + depth", "pose box depth", {}),
    Row("Modality", "RGB + pose", "rgb pose", paper(0.843, 1.248, 77.5, 4.11)),
    Row("Modality", "RGB + box", "rgb box", paper(2.439, 3.805, 17.6, 3.88)),
    Row("Modality", "RGB", "rgb", paper(2.503, 3.911, 15.8, 3.93)),
    Row("Modality", "RGB + pose + box", "rgb pose box", paper(0.846, 1.249, 77.6, 3.87)),
    Row("Pretrained", "RGB + pose + box", "rgb pose box", paper(0.846, 1.249, 77.6, 3.87), pretrained=True),
    Row("Paradigm", "mixed", "pose box", paper(0.846, 1.249, 77.6, 3.87)),
    Row("Paradigm", "expert only", "pose box", paper(0.855, 1.270, 75.1, 6.54), roles=EXPERTS),
    Row("Paradigm", "denoising", "pose box", paper(0.844, 1.239, 78.8, 3.97), roles=DENOISING),
    Row("Scaling", "25 %", "pose box", {ADE: 2.184, FDE: 2.744, SR_2M: 83.42}, share=0.25),
    Row("Scaling", "50 %", "pose box", {ADE: 2.159, FDE: 2.686, SR_2M: 84.09}, share=0.5),
    Row("Scaling", "100 %", "pose box", {ADE: 2.142, FDE: 2.642, SR_2M: 84.96}),
    Row("Maps", "one map", "pose box", {SR_1M: 95.89, JOINT: 42.13, ROTATION: 2.40, HARD_FAIL: 0.45}, towns="one"),
    Row("Maps", "several maps", "pose box", {SR_1M: 96.00, JOINT: 47.44, ROTATION: 2.10, HARD_FAIL: 0.20}, towns="several"),
]


class PaperWindows(Windows):
    """Windows whose waypoints begin at the expert's pose, as in the paper's comparison, or at the input's."""

    def __init__(self, folder: Path, splits: List[str], roles: List[int], anchor: str) -> None:
        super().__init__(folder, splits, roles)
        column = lambda name: self.table[name].combine_chunks()
        if anchor == "expert":
            steps = column("expert_steps_in_world").flatten().to_numpy().reshape(len(self), -1, 6)
            self.deltas = steps[:, -self.deltas.shape[1] :].astype(np.float64)
        # Distances of the boxes, by `read_depth`, for the rows that see depth.
        self.seen_m: Optional[np.ndarray] = None
        self.role = column("role").to_numpy()
        self.rank = column("subset_rank").to_numpy()
        self.is_seen = column("scene").to_numpy() == 0
        self.difficulty = column("difficulty").to_numpy()

    def chosen(self, row: Row) -> np.ndarray:
        """The windows that a row learns from; none of one town for the rows of maps."""
        is_chosen = np.isin(self.role, row.roles) & (self.rank < row.share)
        if row.towns == "all":
            return is_chosen
        walkers, first = np.unique(self.walker, return_index=True)
        town, rank = self.town[first], self.rank[first]
        names, counts = np.unique(town, return_counts=True)
        if len(names) < 2:
            return np.zeros(len(self), bool)
        if row.towns == "one":
            return is_chosen & (self.town == names[counts.argmax()])
        # Town by town the walkers of the lowest ranks, as many as the largest town has.
        turn = np.array([np.sum((town == town[it]) & (rank < rank[it])) for it in range(len(walkers))])
        return is_chosen & np.isin(self.walker, walkers[np.lexsort((rank, turn))[: counts.max()]])


def numbers(windows: Windows, row: Row) -> np.ndarray:
    """What a row sees beside pictures."""
    windows, sees_poses, sees_boxes = copy.copy(windows), "pose" in row.inputs, "box" in row.inputs
    windows.depth_m = windows.seen_m if "depth" in row.inputs else None
    if not sees_poses and not sees_boxes:
        return windows.current[:, [3, 5]]
    return base.features(windows, sees_poses, sees_boxes)


def scores(deltas: np.ndarray, windows: Windows) -> np.ndarray:
    """The metrics of every window, as `cosfly eval` defines them; shares in percent."""
    apart = deltas.cumsum(axis=1) - windows.deltas.cumsum(axis=1)
    distance = np.linalg.norm(apart[..., :3], axis=-1)
    angles = np.abs(base.short_way(apart[..., 3:]))
    last, last_yaw = distance[:, -1], angles[:, -1, 1]
    shares = [last <= 1, last <= 2, (last <= 0.5) & (last_yaw <= 1), last > 10]
    sr_1m, sr_2m, joint, hard_fail = (100.0 * it for it in shares)
    columns = [distance.mean(axis=1), last, sr_1m, angles[..., 1].mean(axis=1), sr_2m, joint, angles.mean(axis=(1, 2)), hard_fail]
    return np.stack(columns, axis=1)


def trained(row: Row, lessons: PaperWindows, judged: PaperWindows, pack: Optional["object"], steps: int, seed: int) -> np.ndarray:
    """Scores of a row's network on the judged windows."""
    if row == ZERO:
        return scores(np.zeros_like(judged.deltas), judged)
    learnt_from = lessons.chosen(row)
    both = [lessons, lessons.mirrored()]
    seen = np.concatenate([numbers(part, row)[learnt_from] for part in both])
    wanted = np.concatenate([base.outcomes(part)[learnt_from] for part in both])
    of_lessons = of_judged = None
    if "rgb" in row.inputs:
        places = pack.rows(lessons)[learnt_from]
        mirrored = np.arange(2 * len(places)) >= len(places)
        of_lessons = networks.Pictures(pack.frames, np.concatenate([places, places]), mirrored)
        of_judged = networks.Pictures(pack.frames, pack.rows(judged), np.zeros(len(judged), bool))
    in_scale, out_scale = base.Scale(seen), base.Scale(wanted)
    network = networks.train(in_scale.apply(seen), out_scale.apply(wanted), of_lessons, steps, seed)
    found = networks.predict(network, in_scale.apply(numbers(judged, row)), of_judged)
    return scores(base.as_deltas(out_scale.undo(found), judged.current), judged)


def fine_tuned(
    source: str, lessons: PaperWindows, judged: PaperWindows, pack: "object", steps: int, seed: int, kept: Path, end: Optional[float]
) -> np.ndarray:
    """Scores of a pretrained model on the judged windows; `kept` holds what it has learnt where the time, `end`, is over."""
    import pretrained

    wanted = base.outcomes(lessons)
    scale = base.Scale(wanted)
    found = pretrained.fine_tuned(source, pack, lessons, judged, scale.apply(wanted), steps, seed, kept, end)
    return scores(base.as_deltas(scale.undo(found), judged.current), judged)
