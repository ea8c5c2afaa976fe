"""Rows with pictures: small pictures of all frames, and one network that tells depth, labels and people from one picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import torch
from boxes import average_precision, matches
from torch import Tensor, nn
from torch.nn import functional

import networks

# People are 9 pixels high in the median; below 8 little can be learnt about them (256 x 144 gives 6).
SIZE = (384, 216)
PERSON, LABELS, SKY_M, BATCH, RATE = 12, 32, 1000.0, 24, 1e-3
# A peak below this is no person; the threshold of no metric.
FAINT = 0.05
Boxes = np.ndarray
Score = Tuple[float, float, float]
METRICS = ["AbsRel", "RMSE, m", "delta1", "mIoU", "AP50"]


class Pack:
    """Small pictures of all frames on the device: `frames` (frames, height, width, 3), uint8."""

    def __init__(self, dataset: Path, folder: Path) -> None:
        try:
            import cosfly
        except ImportError:
            raise SystemExit("rows with pictures need the package cosfly: `pip install .` in the repository") from None
        if not folder.exists():
            cosfly.pack(dataset, folder, size=SIZE, channels=("rgb", "depth", "semantic", "instance"), progress=False)
        self.arrays = cosfly.Pack(folder, dataset)
        self.first: Dict[str, int] = json.loads((folder / "pack.json").read_text())["first_frame"]
        self.frames = torch.from_numpy(self.arrays.array("rgb")).to(networks.device())

    def rows(self, windows: "object") -> np.ndarray:
        """Places of the windows' pictures, (windows, history)."""
        begin = np.array([self.first[name] for name in windows.trajectory_id]) + np.array(windows.start_frame)
        return begin[:, None] + np.arange(windows.boxes_px.shape[1])


class Scene(nn.Module):
    """A picture -> logarithm of the distance of each pixel (m), its label, and per quarter-size cell whether a person is in it, and where its edges are."""

    def __init__(self) -> None:
        super().__init__()
        block = lambda before, after, stride: nn.Sequential(
            nn.Conv2d(before, after, 3, stride, 1), nn.GroupNorm(8, after), nn.ReLU(), nn.Conv2d(after, after, 3, 1, 1), nn.ReLU()
        )
        widths = [32, 48, 96, 128]
        self.down = nn.ModuleList([block(3, 32, 2)] + [block(a, b, 2) for a, b in zip(widths, widths[1:])])
        self.up = nn.ModuleList([block(128 + 96, 96, 1), block(96 + 48, 64, 1), block(64 + 32, 48, 1)])
        self.pixels, self.people = nn.Conv2d(48, 1 + LABELS, 1), nn.Conv2d(64, 5, 1)

    def forward(self, pictures: Tensor) -> Tuple[Tensor, Tensor, Tensor]:
        passed: List[Tensor] = []
        for layer in self.down:
            pictures = layer(pictures)
            passed.append(pictures)
        people = pictures
        for layer, skipped in zip(self.up, passed[-2::-1]):
            larger = functional.interpolate(pictures, size=skipped.shape[-2:], mode="bilinear", align_corners=False)
            pictures = layer(torch.cat([larger, skipped], dim=1))
            people = pictures if skipped is passed[1] else people
        full = functional.interpolate(self.pixels(pictures), scale_factor=2, mode="bilinear", align_corners=False)
        return full[:, 0], full[:, 1:], self.people(people)


def boxes_of(semantic: np.ndarray, instance: np.ndarray) -> Boxes:
    """Boxes of the people in a picture, (people, 4): left, top, right, bottom."""
    found = []
    for person in np.unique(instance[semantic == PERSON]):
        rows, columns = np.nonzero(instance == person)
        found.append([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1])
    return np.array(found, np.float32).reshape(-1, 4)


def wanted_people(boxes: List[Boxes], shape: Tuple[int, int]) -> Tensor:
    """What the head of people learns: 1 in the cell of a box's middle, and the edges from there, in cells."""
    wanted = torch.zeros(len(boxes), 5, *shape)
    for picture, of_picture in enumerate(boxes):
        for box in of_picture / 4:
            column, row = int((box[0] + box[2]) / 2), int((box[1] + box[3]) / 2)
            edges = [column + 0.5 - box[0], row + 0.5 - box[1], box[2] - column - 0.5, box[3] - row - 0.5]
            wanted[picture, :, row, column] = torch.tensor([1.0, *edges])
    return wanted


def peaks(people: Tensor) -> np.ndarray:
    """Boxes of the cells that are more likely than their neighbours, (people, 5): certainty and edges, pixels."""
    certainty = torch.sigmoid(people[0])
    is_peak = (certainty == functional.max_pool2d(certainty[None, None], 3, 1, 1)[0, 0]) & (certainty > FAINT)
    rows, columns = torch.nonzero(is_peak, as_tuple=True)
    edges = people[1:, rows, columns]
    middle_x, middle_y = columns + 0.5, rows + 0.5
    corners = [middle_x - edges[0], middle_y - edges[1], middle_x + edges[2], middle_y + edges[3]]
    return torch.stack([certainty[rows, columns], *(4 * it for it in corners)], dim=1).cpu().numpy()


def scene_scores(pack: Pack, lessons: np.ndarray, judged: np.ndarray, flights: np.ndarray, steps: int, seed: int) -> Dict[str, Score]:
    """Scores on the judged frames, each with its interval over flights; `flights` has the flight of each judged frame."""
    torch.manual_seed(seed)
    place, draws = networks.device(), np.random.default_rng(seed)
    depth, semantic, instance = (pack.arrays.array(name) for name in ("depth", "semantic", "instance"))
    scene = Scene().to(place)
    optimiser = torch.optim.AdamW(scene.parameters(), RATE)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, steps)
    as_input = lambda rows: pack.frames[torch.from_numpy(rows).to(place)].permute(0, 3, 1, 2).float() / 255 - 0.5
    for _ in range(steps):
        rows = draws.choice(lessons, BATCH)
        log_m, labels, people = scene(as_input(rows))
        true_m = torch.from_numpy(depth[rows].astype(np.float32)).to(place).clamp(1, SKY_M)
        wanted = wanted_people([boxes_of(semantic[row], instance[row]) for row in rows], people.shape[-2:]).to(place)
        edges = functional.smooth_l1_loss(people[:, 1:], wanted[:, 1:], reduction="none") * wanted[:, :1]
        is_person = functional.binary_cross_entropy_with_logits(people[:, 0], wanted[:, 0], pos_weight=torch.tensor(50.0, device=place))
        of_labels = functional.cross_entropy(labels, torch.from_numpy(semantic[rows].astype(np.int64)).to(place))
        loss = functional.l1_loss(log_m, true_m.log()) + of_labels + is_person + edges.sum() / wanted[:, 0].sum().clamp(min=1)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    frames, found, counts = [], [], []
    with torch.no_grad():
        for row in judged:
            log_m, labels, people = (it[0] for it in scene(as_input(np.array([row]))))
            true_m, told_m = depth[row].astype(np.float64), np.exp(log_m.cpu().numpy().astype(np.float64))
            is_near = np.isfinite(true_m) & (true_m > 0) & (true_m < 200)
            ratio = told_m[is_near] / true_m[is_near]
            told, true = labels.argmax(dim=0).cpu().numpy(), semantic[row]
            shares = [np.mean((told == it)[(told == it) | (true == it)] & (true == it)[(told == it) | (true == it)]) for it in np.unique(true)]
            rmse = np.sqrt(np.mean((told_m - true_m)[is_near] ** 2))
            frames.append([np.abs(ratio - 1).mean(), rmse, np.mean(np.maximum(ratio, 1 / ratio) < 1.25), np.mean(shares)])
            boxes = boxes_of(semantic[row], instance[row])
            found.append(matches(peaks(people), boxes))
            counts.append(len(boxes))
    table, counts = np.array(frames), np.array(counts)
    own = [np.flatnonzero(flights == it) for it in np.unique(flights)]
    of = lambda rows: [*table[rows].mean(axis=0), 100 * average_precision([it for row in rows for it in found[row]], counts[rows].sum())]
    resampled = [of(np.concatenate([own[it] for it in draws.integers(len(own), size=len(own))])) for _ in range(200)]
    low, high = np.percentile(resampled, [2.5, 97.5], axis=0)
    return {name: tuple(map(float, it)) for name, *it in zip(METRICS, of(np.arange(len(judged))), low, high)}
