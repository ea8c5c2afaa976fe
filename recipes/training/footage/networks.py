"""A detector of people and a tracker of boxes, small enough for a processor: both see squares, and answer for each cell of 4 pixels."""

from __future__ import annotations

import math
from typing import Callable, Dict, List, Tuple

import numpy as np
import torch
from boxes import overlaps
from crops import HEIGHT, KEPT, SIDE, Squares, coloured, moved, views
from torch import Tensor, nn
from torch.nn import functional

CELL, TEMPLATE, KERNEL = 4, 64, 10
BATCH, RATE = 24, 2e-3
OUTPUTS = 5  # certainty, and the distances from the cell's middle to the left, top, right, bottom edge: logarithms of cells


def block(before: int, after: int, stride: int = 1) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(before, after, 3, stride, 1, bias=False), nn.GroupNorm(8, after), nn.ReLU())


class Trunk(nn.Module):
    """Picture -> 48 numbers for each cell, with what is 16 pixels and more away in sight."""

    def __init__(self) -> None:
        super().__init__()
        self.stem = nn.Sequential(block(3, 24, 2), block(24, 32, 2), block(32, 32))
        self.middle = nn.Sequential(block(32, 64, 2), block(64, 64))
        self.deep = nn.Sequential(block(64, 96, 2), block(96, 96), block(96, 96))
        self.to_middle, self.to_cells = block(96 + 64, 64), block(64 + 32, 48)

    def forward(self, pictures: Tensor) -> Tensor:
        cells = self.stem(pictures)
        middle = self.middle(cells)
        larger = functional.interpolate(self.deep(middle), size=middle.shape[-2:], mode="nearest")
        middle = self.to_middle(torch.cat([larger, middle], dim=1))
        larger = functional.interpolate(middle, size=cells.shape[-2:], mode="nearest")
        return self.to_cells(torch.cat([larger, cells], dim=1))


def head(before: int) -> nn.Sequential:
    layers = nn.Sequential(block(before, 48), nn.Conv2d(48, OUTPUTS, 1))
    nn.init.constant_(layers[-1].bias, 1.0)
    with torch.no_grad():
        layers[-1].bias[0] = -4.0
    return layers


class Detector(nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.trunk, self.head = Trunk(), head(48)

    def forward(self, pictures: Tensor) -> Tensor:
        return self.head(self.trunk(pictures))


class Tracker(nn.Module):
    """A square around the target once, and one in which to look for the target: what both have alike decides."""

    def __init__(self) -> None:
        super().__init__()
        self.trunk, self.alike, self.head = Trunk(), nn.GroupNorm(8, 48), head(96)

    def kernels(self, templates: Tensor) -> Tensor:
        """(targets, 3, TEMPLATE, TEMPLATE) -> (targets, 48, KERNEL, KERNEL)."""
        cells, margin = self.trunk(templates), (TEMPLATE // CELL - KERNEL) // 2
        return cells[:, :, margin : margin + KERNEL, margin : margin + KERNEL]

    def forward(self, kernels: Tensor, pictures: Tensor) -> Tensor:
        cells = self.trunk(pictures)
        count, channels, height, width = cells.shape
        before, after = KERNEL // 2, KERNEL // 2 - 1
        padded = functional.pad(cells, (before, after, before, after)).reshape(1, count * channels, height + KERNEL - 1, width + KERNEL - 1)
        alike = functional.conv2d(padded, kernels.reshape(count * channels, 1, KERNEL, KERNEL), groups=count * channels).reshape(cells.shape)
        return self.head(torch.cat([self.alike(alike), cells], dim=1))


def peaks(found: Tensor, least: float) -> np.ndarray:
    """Boxes of the cells that are more certain than their neighbours, (found, 5): certainty and edges, pixels."""
    certainty = torch.sigmoid(found[0])
    is_peak = (certainty == functional.max_pool2d(certainty[None, None], 3, 1, 1)[0, 0]) & (certainty > least)
    rows, columns = torch.nonzero(is_peak, as_tuple=True)
    left, top, right, bottom = found[1:, rows, columns].clamp(max=6).exp()
    edges = [columns + 0.5 - left, rows + 0.5 - top, columns + 0.5 + right, rows + 0.5 + bottom]
    return torch.stack([certainty[rows, columns], *(CELL * it for it in edges)], dim=1).numpy()


def distinct(found: np.ndarray, overlap: float = 0.35) -> np.ndarray:
    """The most certain boxes that do not overlap a more certain one."""
    kept: List[np.ndarray] = []
    for row in found[np.argsort(-found[:, 0], kind="stable")]:
        if not kept or overlaps(row[1:], np.stack(kept)[:, 1:]).max() < overlap:
            kept.append(row)
    return np.stack(kept) if kept else np.zeros((0, 5))


class Wanted:
    """What the cells of a batch learn: how near a body's middle is, its edges, and which cells count."""

    def __init__(self, count: int) -> None:
        cells = SIDE // CELL
        self.certainty, self.counts = np.zeros((count, cells, cells), np.float32), np.ones((count, cells, cells), np.float32)
        self.edges, self.has_edges = np.ones((count, 4, cells, cells), np.float32), np.zeros((count, cells, cells), np.float32)
        self.middle_x, self.middle_y = np.meshgrid(np.arange(cells) + 0.5, np.arange(cells) + 0.5)

    def add(self, row: int, box: np.ndarray, is_clear: bool) -> None:
        left, top, right, bottom = box / CELL
        x, y, wide, high = (left + right) / 2, (top + bottom) / 2, right - left, bottom - top
        if not is_clear:
            inside = (self.middle_x > left - 1) & (self.middle_x < right + 1) & (self.middle_y > top - 1) & (self.middle_y < bottom + 1)
            self.counts[row][inside & (self.certainty[row] < 0.99)] = 0
            return
        spread = lambda length: max(0.7, length / 7)
        near = np.exp(-0.5 * (((self.middle_x - x) / spread(wide)) ** 2 + ((self.middle_y - y) / spread(high)) ** 2))
        column, line = int(x), int(y)
        if 0 <= column < near.shape[1] and 0 <= line < near.shape[0]:
            near[line, column] = 1.0
            self.counts[row, line, column] = 1
        self.certainty[row] = np.maximum(self.certainty[row], near)
        middle = near > 0.5
        edges = np.stack([self.middle_x - left, self.middle_y - top, right - self.middle_x, bottom - self.middle_y])
        self.edges[row][:, middle] = np.maximum(edges, 0.1)[:, middle]
        self.has_edges[row][middle] = 1

    def loss(self, found: Tensor) -> Tensor:
        """Focal loss of the certainty as in CenterNet (1904.07850), and the overlap of the boxes (IoU)."""
        wanted, counts = torch.from_numpy(self.certainty), torch.from_numpy(self.counts)
        certainty = torch.sigmoid(found[:, 0]).clamp(1e-4, 1 - 1e-4)
        is_middle = wanted >= 1.0
        right = -((1 - certainty) ** 2) * certainty.log() * is_middle
        wrong = -((1 - wanted) ** 4) * certainty**2 * (1 - certainty).log() * ~is_middle * counts
        edges, true = found[:, 1:].clamp(max=6).exp(), torch.from_numpy(self.edges)
        common = torch.minimum(edges, true)
        wide, high = common[:, 0] + common[:, 2], common[:, 1] + common[:, 3]
        area = lambda of: (of[:, 0] + of[:, 2]) * (of[:, 1] + of[:, 3])
        overlap = wide * high / (area(edges) + area(true) - wide * high)
        has_edges = torch.from_numpy(self.has_edges)
        of_edges = -(overlap.clamp(min=1e-3).log() * has_edges).sum() / has_edges.sum().clamp(min=1)
        return (right.sum() + wrong.sum()) / is_middle.sum().clamp(min=1) + of_edges


def seen_anew(squares: Squares, rows: np.ndarray, draws: np.random.Generator, move: float) -> Tuple[Tensor, np.ndarray]:
    """Pictures of the networks' size, in which bodies in the middle of squares are 18 to 48 pixels long, and the maps to them."""
    count = len(rows)
    scales = np.exp(draws.uniform(np.log(0.45), np.log(1.2), count))
    room = np.clip(KEPT * scales / SIDE - 1, 0.2, move)[:, None]  # views lie within the square
    moves, turns = draws.uniform(-1, 1, (count, 2)) * room, draws.uniform(-0.12, 0.12, count)
    seen = views(squares.pictures[torch.from_numpy(rows)], SIDE, scales, moves, turns, draws.random(count) < 0.5)
    return coloured(seen.pictures, draws), seen.map


def lesson_of_detector(network: Detector, squares: Squares, draws: np.random.Generator) -> Tensor:
    rows = draws.integers(len(squares.bodies), size=BATCH)
    pictures, maps = seen_anew(squares, rows, draws, 1.0)
    wanted = Wanted(BATCH)
    for row, square in enumerate(rows):
        for it in sorted(squares.around[square], key=lambda it: it.is_clear):
            if it.is_person:
                box = moved(it.box, maps[row])
                wanted.add(row, box, it.is_clear and box[3] - box[1] >= 10)
    return wanted.loss(network(pictures))


class LessonOfTracker:
    """Pairs of squares around one body; in one of five, the body looked for is another one, which is not there."""

    def __init__(self, squares: Squares) -> None:
        self.of_body: Dict[Tuple[str, str], List[int]] = {}
        for row, body in enumerate(squares.bodies):
            if body[1]:
                self.of_body.setdefault(body, []).append(row)
        self.rows = np.concatenate(list(self.of_body.values()))

    def __call__(self, network: Tracker, squares: Squares, draws: np.random.Generator) -> Tensor:
        rows = draws.choice(self.rows, BATCH)
        partners = np.array([draws.choice(self.of_body[squares.bodies[row]]) for row in rows])
        strangers = draws.random(BATCH) < 0.2
        partners[strangers] = draws.choice(self.rows, strangers.sum())
        pictures, maps = seen_anew(squares, rows, draws, 0.7)
        scale = 32 / HEIGHT * np.exp(draws.uniform(-0.08, 0.08, BATCH))
        still = np.zeros(BATCH)
        templates = views(squares.pictures[torch.from_numpy(partners)], TEMPLATE, scale, draws.uniform(-0.06, 0.06, (BATCH, 2)), still, still > 0)
        wanted = Wanted(BATCH)
        for row, (square, partner) in enumerate(zip(rows, partners)):
            for it in squares.around[square]:
                if (squares.bodies[square][0], it.body) == squares.bodies[partner]:
                    wanted.add(row, moved(it.box, maps[row]), it.is_clear)
        return wanted.loss(network(network.kernels(coloured(templates.pictures, draws)), pictures))


def train(network: nn.Module, lesson: Callable[..., Tensor], squares: Squares, steps: int, seed: int, say: Callable[[str], None]) -> None:
    """Adam with decay; the rate rises for a twentieth of the steps and falls along half a cosine."""
    draws = np.random.default_rng(seed)
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=1e-2)
    rise = max(1, steps // 20)
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: min((step + 1) / rise, 0.5 * (1 + math.cos(math.pi * step / steps))))
    mean = 0.0
    for step in range(steps):
        loss = lesson(network, squares, draws)
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        schedule.step()
        mean += (float(loss.detach()) - mean) / min(step + 1, 100)
        if (step + 1) % 100 == 0:
            say(f"step {step + 1} of {steps}: loss {mean:.3f}")
    network.eval()
