#!/usr/bin/env python3
"""Do several kinds of places teach more than one? Depth and labels from one picture, judged in kinds that no network has seen.

    python recipes/training/paper/kinds.py --out out/kinds
    python recipes/training/paper/kinds.py --out out/kinds --unseen campus villas     # other unseen kinds, on the same data

Makes towns of fourteen kinds (all but `suburb`, which is younger than the book's figures; `--kinds` and `--unseen` take it, too) and flights in
them, in pictures of 128 x 72. Trains a small network on each single kind, briefly; then, longer, on the best single kind and on all of them,
with as many frames and steps. Needs `cosfly` on the path, the package cosfly, torch 1.13 or newer
and numpy. A network is a file: what is there is not trained again. Writes `report.md`, and prints it. The book's page "Several kinds of
places" has the figures.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import sys
import warnings
from pathlib import Path
from typing import Dict, List, Tuple

sys.path.append(str(Path(__file__).resolve().parents[1]))  # tools.py
import tools

tools.need("torch", "numpy", "cosfly")
import cosfly
import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from jobs import Jobs, run_recipe, write_whole

# Those of the book's figures.
KINDS = """arterial campus forest_edge garden_rows grid hillside industrial old_town perimeter_blocks shopping terraces village villas
waterfront""".split()
SIZE, LABELS, BATCH, RATE, DECAY = (128, 72), 32, 8, 3e-3, 1e-2
# Distances beyond these are neither learnt as larger (the sky's has no end) nor judged.
SKY_M, JUDGED_M = 1000.0, 200.0
# A label counts where this share of the judged pixels has it.
LEAST_SHARE, RESAMPLES = 1e-3, 1000
# The smaller the better, or the larger.
METRICS, SIGN = ["AbsRel", "delta1", "mIoU"], [-1, 1, 1]
# Columns of a flight's scores before its table of true and told labels.
NEAR, ERROR, WITHIN, TABLE = 0, 1, 2, 3


class Scene(nn.Module):
    """A picture -> logarithm of the distance (m) and label, at half of its size."""

    def __init__(self) -> None:
        super().__init__()
        one = lambda before, after, stride: nn.Sequential(
            nn.Conv2d(before, after, 3, stride, 1, bias=False), nn.BatchNorm2d(after), nn.ReLU(inplace=True)
        )
        widths = [16, 32, 64, 96]
        pairs = list(zip(widths, widths[1:]))
        self.down = nn.ModuleList([one(3, 16, 2)] + [nn.Sequential(one(a, b, 2), one(b, b, 1)) for a, b in pairs])
        self.narrower = nn.ModuleList([nn.Conv2d(b, a, 1) for a, b in reversed(pairs)])
        self.up = nn.ModuleList([one(a, max(a, 32), 1) for a, _ in reversed(pairs)])
        self.pixels = nn.Conv2d(32, 1 + LABELS, 1)
        self.pixels.bias.data[0] = math.log(25)

    def forward(self, pictures: Tensor) -> Tuple[Tensor, Tensor]:
        passed: List[Tensor] = []
        for layer in self.down:
            pictures = layer(pictures)
            passed.append(pictures)
        for narrower, layer, skipped in zip(self.narrower, self.up, passed[-2::-1]):
            pictures = layer(functional.interpolate(narrower(pictures), size=skipped.shape[-2:]) + skipped)
        pixels = self.pixels(pictures)
        return pixels[:, 0], pixels[:, 1:]

    def numbers(self) -> np.ndarray:
        return np.concatenate([it.double().flatten().numpy() for it in self.state_dict().values()])

    def set_numbers(self, numbers: np.ndarray) -> "Scene":
        state = self.state_dict()
        ends = np.cumsum([it.numel() for it in state.values()])[:-1]
        for value, part in zip(state.values(), np.split(numbers, ends)):
            value.copy_(torch.from_numpy(part).reshape(value.shape))
        return self.eval()


class Data:
    """Pictures, depth (m) and labels of all frames, and the rows of each flight of each kind, town by town in turn."""

    def __init__(self, dataset: Path, pack: Path) -> None:
        if not pack.exists():
            warnings.simplefilter("ignore", UserWarning)  # people are small at this size, and not looked for
            cosfly.pack(dataset, pack, size=SIZE, channels=("rgb", "depth", "semantic"), jobs=1, progress=False)
        arrays = cosfly.Pack(pack, dataset)
        self.pictures, self.depth_m, self.labels = (arrays.array(name) for name in ("rgb", "depth", "semantic"))
        first: Dict[str, int] = json.loads((pack / "pack.json").read_text())["first_frame"]
        names = sorted(first, key=first.__getitem__)
        ends = [first[name] for name in names[1:]] + [len(self.labels)]
        towns: Dict[str, List[np.ndarray]] = {}
        for name, end in zip(names, ends):
            towns.setdefault(name.rpartition("-")[0].partition("_")[2], []).append(np.arange(first[name], end))
        self.flights: Dict[str, List[np.ndarray]] = {}
        for kind in {town.rpartition("_")[0] for town in towns}:
            of = [flights for town, flights in sorted(towns.items()) if town.rpartition("_")[0] == kind]
            self.flights[kind] = [flights[at] for at in range(max(map(len, of))) for flights in of if at < len(flights)]

    def as_input(self, rows: np.ndarray) -> Tensor:
        return torch.from_numpy(self.pictures[rows]).permute(0, 3, 1, 2).float() / 255 - 0.5


def train(data: Data, flights: List[np.ndarray], steps: int, seed: int) -> Scene:
    """Adam with decay; a batch is mirrored or not, one of four pixels teaches, rare labels weigh more; the rate rises and falls along half a cosine."""
    torch.manual_seed(seed)
    draws, lessons = np.random.default_rng(seed), np.concatenate(flights)
    scene = Scene().to(memory_format=torch.channels_last)
    optimiser = torch.optim.AdamW(scene.parameters(), RATE, weight_decay=DECAY)
    shares = np.bincount(data.labels[lessons].ravel(), minlength=LABELS) / data.labels[lessons].size
    weights = torch.from_numpy(np.where(shares > 0, (shares + LEAST_SHARE) ** -0.5, 0).astype(np.float32))
    rise = max(1, steps // 20)
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: min((step + 1) / rise, 0.5 * (1 + math.cos(math.pi * step / steps))))
    for _ in range(steps):
        rows, (down, right, is_mirrored) = draws.choice(lessons, BATCH), draws.integers(2, size=3)
        true_m = torch.from_numpy(data.depth_m[rows, down::2, right::2].astype(np.float32)).clamp(1, SKY_M)
        labels, pictures = torch.from_numpy(data.labels[rows, down::2, right::2].astype(np.int64)), data.as_input(rows)
        if is_mirrored:
            pictures, true_m, labels = (it.flip(-1) for it in (pictures, true_m, labels))
        log_m, told = scene(pictures.contiguous(memory_format=torch.channels_last))
        loss = functional.l1_loss(log_m, true_m.log()) + functional.cross_entropy(told, labels, weights)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    return scene


@torch.no_grad()
def judge(scene: Scene, data: Data, flights: List[np.ndarray]) -> np.ndarray:
    """Each flight's pixels in `JUDGED_M`, their sum of relative errors of depth, those within a quarter, and its table of labels."""
    found = []
    for rows in flights:
        larger = lambda of: functional.interpolate(of, size=SIZE[::-1], mode="bilinear", align_corners=False)
        log_m, labels = scene(data.as_input(rows).contiguous(memory_format=torch.channels_last))
        told_m, true_m = larger(log_m[:, None])[:, 0].numpy().astype(np.float64), data.depth_m[rows].astype(np.float64)
        is_near = (true_m > 0) & (true_m < JUDGED_M)
        ratio = np.exp(told_m[is_near]) / true_m[is_near]
        pairs = data.labels[rows].astype(np.int64) * LABELS + larger(labels).argmax(dim=1).numpy()
        table = np.bincount(pairs.ravel(), minlength=LABELS * LABELS)
        found.append([is_near.sum(), np.abs(ratio - 1).sum(), (np.maximum(ratio, 1 / ratio) < 1.25).sum(), *table])
    return np.array(found, np.float64)


def overlaps_of_labels(sums: np.ndarray) -> np.ndarray:
    """Right pixels over those that have the label or are told to, (..., columns) -> (..., labels)."""
    table = sums[..., TABLE:].reshape(*sums.shape[:-1], LABELS, LABELS)
    right = np.diagonal(table, axis1=-2, axis2=-1)
    return right / np.maximum(table.sum(axis=-1) + table.sum(axis=-2) - right, 1)


def metrics(sums: np.ndarray, is_label: np.ndarray) -> np.ndarray:
    """`METRICS` of sums of flights' scores, (..., columns) -> (..., metrics)."""
    return np.stack([sums[..., ERROR] / sums[..., NEAR], sums[..., WITHIN] / sums[..., NEAR], overlaps_of_labels(sums)[..., is_label].mean(axis=-1)], axis=-1)


def resampled(scores: np.ndarray, drawn: np.ndarray, is_label: np.ndarray, seed: int) -> np.ndarray:
    """(resamples, metrics) of (seeds, flights, columns): flights as often as `drawn` has them, and seeds drawn likewise."""
    of_seeds = np.stack([metrics(drawn @ of_seed, is_label) for of_seed in scores])
    chosen = np.random.default_rng(seed).integers(len(scores), size=(len(drawn), len(scores)))
    return of_seeds[chosen, np.arange(len(drawn))[:, None]].mean(axis=1)


def draws_of(kinds: np.ndarray) -> np.ndarray:
    """(resamples, flights): how often each flight is drawn; each kind keeps its number."""
    draws, counts = np.random.default_rng(1), np.zeros((RESAMPLES, len(kinds)))
    for kind in np.unique(kinds):
        of = np.flatnonzero(kinds == kind)
        for resample in counts:
            np.add.at(resample, draws.choice(of, len(of)), 1)
    return counts


class Comparison:
    """Scores (seeds, flights, columns) by what was learnt from; `kinds` has the kind of each judged flight."""

    def __init__(self, kinds: np.ndarray) -> None:
        self.kinds, self.scores = kinds, {}  # type: np.ndarray, Dict[str, np.ndarray]

    def add(self, name: str, seed: np.ndarray) -> None:
        self.scores[name] = np.concatenate([self.scores[name], seed[None]]) if name in self.scores else seed[None]

    def shares(self) -> np.ndarray:
        """Of each label, of the judged pixels."""
        pixels = next(iter(self.scores.values()))[0, :, TABLE:].sum(axis=0).reshape(LABELS, LABELS).sum(axis=1)
        return pixels / pixels.sum()

    def labels(self) -> np.ndarray:
        """The labels that count."""
        return self.shares() > LEAST_SHARE

    def mean(self, name: str, part: slice = slice(None)) -> np.ndarray:
        return metrics(self.scores[name][:, part].sum(axis=1), self.labels()).mean(axis=0)

    def best(self, names: List[str], metric: int) -> str:
        """The best on the judged flights themselves: a choice in favour of the single kinds."""
        return max(names, key=lambda name: SIGN[metric] * self.mean(name)[metric])

    def table(self, names: List[str]) -> List[str]:
        drawn = draws_of(self.kinds)
        lines = [f"| learnt from | seeds | {' | '.join(METRICS)} |", f"| --- | ---: |{' ---: |' * len(METRICS)}"]
        for name in names:
            of = zip(self.mean(name), resampled(self.scores[name], drawn, self.labels(), 2).T)
            lines.append(f"| {name} | {len(self.scores[name])} | {' | '.join(cell(*it) for it in of)} |")
        return lines

    def by_label(self, names: List[str]) -> List[str]:
        lines = [f"| label | pixels, % | {' | '.join(names)} |", f"| ---: | ---: |{' ---: |' * len(names)}"]
        found = [overlaps_of_labels(self.scores[name].sum(axis=1)).mean(axis=0) for name in names]
        for label in np.flatnonzero(self.labels()):
            lines.append(f"| {label} | {100 * self.shares()[label]:.1f} | {' | '.join(f'{it[label]:.2f}' for it in found)} |")
        return lines

    def findings(self, several: str, singles: List[str]) -> List[str]:
        drawn, lines = draws_of(self.kinds), []
        unseen = [(f"`{kind}`", self.kinds == kind) for kind in dict.fromkeys(self.kinds)]
        for metric, name in enumerate(METRICS):
            best = self.best(singles, metric)
            for place, part in [("both unseen kinds", np.full(len(self.kinds), True)), *unseen]:
                more, less = (resampled(self.scores[it][:, part], drawn[:, part], self.labels(), at)[:, metric] for at, it in enumerate([several, best]))
                means = [self.mean(it, part)[metric] for it in (several, best)]
                low, high = np.percentile(SIGN[metric] * (more - less), [2.5, 97.5])
                told = "holds" if low > 0 else "does NOT hold: the reverse does" if high < 0 else "is undecided"
                lines.append(
                    f"* **{name}: {several} beat the best single one, {best}, on {place}: {told}.** "
                    f"{means[0]:.3f} - {means[1]:.3f} = {cell(means[0] - means[1], more - less)}."
                )
        return lines


def cell(middle: float, spread: np.ndarray) -> str:
    return "{:.3f} [{:.3f}, {:.3f}]".format(middle, *np.percentile(spread, [2.5, 97.5]))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--out", type=Path, required=True, help="folder of data, networks and the report")
    add("--unseen", nargs=2, default=["old_town", "waterfront"], metavar="KIND", help="kinds that are judged (default old_town waterfront)")
    add("--kinds", nargs="+", metavar="KIND", help="kinds to learn from (default: all others)")
    add("--towns", type=int, default=3, help="towns of each kind (default 3)")
    add("--first-town", type=int, default=1, help="seed of the first town of each kind (default 1)")
    add("--set", action="append", default=[], metavar="KEY=VALUE", help="setting of kinds.toml, as of `cosfly run`")
    add("--cosfly", default="cosfly", help="the program (default cosfly)")
    add("--brief-steps", type=int, default=1200, help="steps of the networks by which the best single kind is chosen (default 1200)")
    add("--steps", type=int, default=2400, help="steps of the networks that are compared (default 2400)")
    add("--seeds", type=int, default=3, help="networks of the several kinds and of the best one (default 3)")
    add("--minutes", type=float, help="begin no job after so many minutes; run again to go on")
    chosen = parser.parse_args()
    chosen.kinds = chosen.kinds or [it for it in KINDS if it not in chosen.unseen]
    if len(set(chosen.kinds) | set(chosen.unseen)) < len(chosen.kinds) + 2 or len(chosen.kinds) < 2:
        parser.error(f"two or more different kinds to learn from and two others to judge, not {' '.join(chosen.kinds)} and {' '.join(chosen.unseen)}")
    if min(chosen.towns, chosen.brief_steps, chosen.steps, chosen.seeds) < 1 or chosen.first_town < 0:
        parser.error("--towns, --steps, --brief-steps and --seeds are 1 or more, --first-town is 0 or more")
    return chosen


def make_data(chosen: argparse.Namespace) -> Path:
    towns = chosen.out.resolve() / "towns"
    towns.mkdir(parents=True, exist_ok=True)
    names = []
    for kind in sorted(chosen.kinds + chosen.unseen):
        for seed in range(chosen.first_town, chosen.first_town + chosen.towns):
            (towns / f"{kind}_{seed}.json").write_text(json.dumps({"format": "cosfly-generated/1", "seed": seed, "place": kind}))
            names.append(f'{{ name = "{kind}_{seed}" }}')
    settings = [f"for_each.town=[{', '.join(names)}]", f"stages.town.source={towns}/{{town.name}}.json", *chosen.set]
    run_recipe(chosen.cosfly, "kinds.toml", chosen.out / "data", settings)
    return chosen.out / "data"


def main() -> None:
    chosen = arguments()
    torch.set_num_threads(1)
    dataset = make_data(chosen)
    identity = hashlib.sha256((dataset / "SHA256SUMS").read_bytes()).hexdigest()
    data = Data(dataset, chosen.out / f"pack-{identity[:12]}")
    count = min(len(data.flights[kind]) for kind in chosen.kinds)
    if count < len(chosen.kinds):
        raise SystemExit(f"{count} flights of a kind cannot be spread over {len(chosen.kinds)} kinds; raise `--towns` or `--set stages.walkers.count=`")
    several = f"{len(chosen.kinds)} kinds"
    lessons = {kind: data.flights[kind][:count] for kind in chosen.kinds}
    lessons[several] = [flights[at] for at in range(count) for flights in lessons.values()][:count]
    judged = {kind: [rows[::2] for rows in data.flights[kind]] for kind in chosen.unseen}
    key = f"{identity} {count} {torch.__version__}"
    jobs = Jobs(chosen.out / "networks" / hashlib.sha256(key.encode()).hexdigest()[:12], chosen.minutes)
    compared = Comparison(np.repeat(chosen.unseen, [len(it) for it in judged.values()]))

    def learn(name: str, lesson: str, steps: int, seed: int) -> None:
        of = lesson if lesson != several else f"{len(chosen.kinds)}_kinds_{hashlib.sha256(' '.join(chosen.kinds).encode()).hexdigest()[:12]}"
        file = f"{of}-{steps}-{seed}"
        numbers = jobs.result(file, lambda: train(data, lessons[lesson], steps, seed).numbers())
        found = [jobs.result(f"{file}-{kind}", lambda: judge(Scene().set_numbers(numbers), data, flights)) for kind, flights in judged.items()]
        if all(it is not None for it in found):
            compared.add(name, np.concatenate(found))

    briefly = {f"{kind}, briefly": kind for kind in chosen.kinds}
    for name, kind in briefly.items():
        learn(name, kind, chosen.brief_steps, 0)
    if not jobs.left:
        best = sorted({briefly[compared.best(list(briefly), metric)] for metric in range(len(METRICS))})
        for seed in range(chosen.seeds):
            for name in [several, *best]:
                learn(name, name, chosen.steps, seed)
    if jobs.left:
        raise SystemExit(f"the minutes are over: run the command again to go on; networks and scores are in {jobs.folder}")
    text = "\n".join([
        f"{len(compared.kinds)} flights of {' and '.join(chosen.unseen)} judged, kinds that no network has seen. Each learnt from "
        f"{sum(map(len, lessons[several]))} frames in {chosen.steps} steps,\n*briefly* in {chosen.brief_steps}. In brackets the middle 95 % of {RESAMPLES} "
        "resamples of flights and of seeds.\n",
        *compared.table([several, *best, *sorted(briefly, key=lambda name: compared.mean(name)[0])]), "",
        *compared.by_label([several, *best]), "", *compared.findings(several, best), "",
    ])  # fmt: skip
    write_whole(chosen.out / "report.md", lambda file: file.write(text.encode()))
    print(text)


if __name__ == "__main__":
    tools.script(main)
