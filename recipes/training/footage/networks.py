"""A detector of people and a tracker of boxes, small enough for a processor: both see squares, and answer for each cell of 4 pixels."""

from __future__ import annotations

import copy
from typing import Callable, Dict, List, Optional, Tuple

import numpy as np
import torch
from boxes import overlaps
from crops import KEPT, SIDE, Squares, View, coarse, coloured, moved, views
from objects import drawn_objects, pasted
from torch import Tensor, nn
from torch.nn import functional

CELL, TEMPLATE, KERNEL = 4, 64, 10
BATCH, RATE, RISE, FALL = 8, 1.5e-3, 50, 400  # steps in which the rate rises, and in which it falls at least
LEAST_LONG, MOST_LONG = 10, 56  # longer sides of bodies in training, pixels
OUTPUTS = 5  # certainty, and the distances from the cell's middle to the left, top, right, bottom edge: logarithms of cells


def block(before: int, after: int, stride: int = 1, size: int = 3) -> nn.Sequential:
    return nn.Sequential(nn.Conv2d(before, after, size, stride, size // 2, bias=False), nn.GroupNorm(8, after), nn.ReLU())


class Trunk(nn.Module):
    """Picture -> 48 numbers for each cell, with what is 16 pixels and more away in sight."""

    def __init__(self) -> None:
        super().__init__()
        self.stem = nn.Sequential(block(3, 24, 2), block(24, 32, 2), block(32, 32))
        self.middle = nn.Sequential(block(32, 64, 2), block(64, 64))
        self.deep = nn.Sequential(block(64, 96, 2), block(96, 96), block(96, 96))
        self.to_middle, self.to_cells = block(96 + 64, 64), block(64 + 32, 48, size=1)

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
        self.trunk, self.alike, self.both, self.head = Trunk(), nn.GroupNorm(8, 48), block(96, 32, size=1), head(32)

    def kernels(self, templates: Tensor) -> Tensor:
        """(targets, 3, TEMPLATE, TEMPLATE) -> (targets, 48, KERNEL, KERNEL)."""
        cells, margin = self.trunk(templates), (TEMPLATE // CELL - KERNEL) // 2
        return cells[:, :, margin : margin + KERNEL, margin : margin + KERNEL]

    def compared(self, kernels: Tensor, cells: Tensor) -> Tensor:
        count, channels, height, width = cells.shape
        before, after = KERNEL // 2, KERNEL // 2 - 1
        padded = functional.pad(cells, (before, after, before, after)).reshape(1, count * channels, height + KERNEL - 1, width + KERNEL - 1)
        alike = functional.conv2d(padded, kernels.reshape(count * channels, 1, KERNEL, KERNEL), groups=count * channels).reshape(cells.shape)
        return self.head(self.both(torch.cat([self.alike(alike), cells], dim=1)))


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


class Lesson:
    """Pictures for both networks at once: people to find, and a target to follow from a picture of it, taken from another frame.

    The target is a body, or an object of no kind that is pasted in; in one of eight, a stranger who is not there.
    """

    def __init__(self, squares: Squares) -> None:
        self.squares = squares
        self.of_body: Dict[Tuple[str, str], List[int]] = {}
        for row, body in enumerate(squares.bodies):
            if body[1]:
                self.of_body.setdefault(body, []).append(row)
        self.rows = np.concatenate(list(self.of_body.values()))

    def seen_anew(self, rows: np.ndarray, side: int, lengths: np.ndarray, moves: np.ndarray, turns: np.ndarray, mirrors: np.ndarray) -> View:
        """Views in which the bodies in the middle of squares are as long as asked, where the squares' pixels allow it."""
        scales = np.clip(lengths / self.squares.lengths[rows], 0.5, 4.0)
        room = np.clip(KEPT * scales / side - 1, 0.2, 1.0)[:, None]  # views lie within the square
        return views(self.squares.pictures[torch.from_numpy(rows)], side, scales, moves * room, turns, mirrors)

    def with_objects(
        self, where: np.ndarray, pictures: Tensor, templates: Tensor, lengths: np.ndarray, draws: np.random.Generator
    ) -> Tuple[List[Optional[np.ndarray]], np.ndarray]:
        """Pastes an object and another one into pictures, and the first into the templates beside them; its boxes, and what the two hide."""
        rows = np.flatnonzero(where)
        count, chosen, lengths = len(rows), torch.from_numpy(rows), lengths[rows]
        boxes: List[Optional[np.ndarray]] = [None] * len(where)
        hides = np.zeros((len(where), SIDE, SIDE), np.float32)
        if count < 2:
            return boxes, hides
        number = lambda low, high, *shape: draws.uniform(low, high, (count, *shape))
        objects, turns, stretches = drawn_objects(self.squares, count, draws), number(-np.pi, np.pi), number(0.8, 1.2)
        other = pasted(pictures[chosen], objects.roll(1, 0), lengths * np.exp(number(-0.3, 0.3)), number(-1, 1, 2), turns, stretches)
        found = pasted(other.pictures, objects, lengths, number(-0.75, 0.75, 2), turns + number(-0.3, 0.3), stretches * number(0.85, 1.15))
        shown = pasted(templates[chosen], objects, 32 * np.exp(number(-0.1, 0.1)), number(-0.06, 0.06, 2), turns, stretches)
        pictures[chosen], templates[chosen] = found.pictures, shown.pictures
        hides[rows] = torch.maximum(other.hides, found.hides).numpy()
        for row, box in zip(rows, found.boxes):
            boxes[row] = box
        return boxes, hides

    def __call__(self, detector: Detector, tracker: Optional[Tracker], draws: np.random.Generator) -> Tensor:
        squares, count = self.squares, BATCH
        number = lambda low, high, *shape: draws.uniform(low, high, (count, *shape))
        rows = draws.integers(len(squares.bodies), size=count)
        is_object = np.array([not squares.bodies[row][1] for row in rows]) | (draws.random(count) < 0.25)
        is_stranger = draws.random(count) < 0.12
        partners = np.array([draws.choice(self.of_body.get(squares.bodies[row], self.rows)) for row in rows])
        partners[is_stranger] = draws.choice(self.rows, is_stranger.sum())
        lengths = np.exp(number(np.log(LEAST_LONG), np.log(MOST_LONG)))
        seen = self.seen_anew(rows, SIDE, lengths, number(-0.85, 0.85, 2), number(-0.12, 0.12), draws.random(count) < 0.5)
        still = np.zeros(count)
        beside = self.seen_anew(np.where(is_object, rows, partners), TEMPLATE, 32 * np.exp(number(-0.1, 0.1)), number(-0.06, 0.06, 2), still, still > 0)
        pooled, smear = draws.choice([1, 1, 1, 2, 3], count), draws.integers(-1, 2, 2)
        camera, lighter = int(draws.integers(2**32)), torch.from_numpy(np.exp(number(-0.2, 0.2, 1, 1, 1) + number(-0.05, 0.05, 3, 1, 1))).float()
        found, hides = self.with_objects(is_object, seen.pictures, beside.pictures, lengths, draws)
        pictures = coloured(coarse(seen.pictures, pooled, smear, draws), np.random.default_rng(camera))
        templates = coloured(coarse(beside.pictures * lighter, pooled, smear, draws), np.random.default_rng(camera))
        people, target = Wanted(count), Wanted(count)
        for row, (square, partner) in enumerate(zip(rows, partners)):
            for it in sorted(squares.around[square], key=lambda it: it.is_clear):
                box = moved(it.box, seen.map[row])
                left, top, right, bottom = np.clip(box, 0, SIDE).astype(int)
                is_hidden = right > left and bottom > top and hides[row, top:bottom, left:right].mean() > 0.25
                if it.is_person:
                    people.add(row, box, it.is_clear and not is_hidden and box[3] - box[1] >= LEAST_LONG * 0.7)
                if not is_object[row] and (squares.bodies[square][0], it.body) == squares.bodies[partner]:
                    target.add(row, box, it.is_clear)
            if not is_stranger[row] and found[row] is not None:
                target.add(row, found[row], True)
        unlike = torch.from_numpy(is_stranger & is_object)
        templates[unlike] = templates.roll(2, 0)[unlike]
        cells = detector.trunk(pictures)
        loss = people.loss(detector.head(cells))
        return loss + target.loss(tracker.compared(tracker.kernels(templates), cells)) if tracker else loss


def on_one_trunk(detector: Detector, tracker: Tracker) -> nn.ModuleList:
    tracker.trunk = detector.trunk
    return nn.ModuleList([detector, tracker])


def train(detector: Detector, tracker: Tracker, squares: Squares, together: int, alone: int, seed: int, say: Callable[[str], None]) -> None:
    """Both networks on one trunk, which the tracker then keeps; the detector learns on with a copy."""
    lesson, draws = Lesson(squares), np.random.default_rng(seed)
    learn(on_one_trunk(detector, tracker), lambda: lesson(detector, tracker, draws), together, lambda line: say(f"both, {line}"))
    tracker.trunk = copy.deepcopy(detector.trunk)
    learn(detector, lambda: lesson(detector, None, draws), alone, lambda line: say(f"detector, {line}"))
    detector.eval(), tracker.eval()


def learn(network: nn.Module, lesson: Callable[[], Tensor], steps: int, say: Callable[[str], None]) -> None:
    """Adam with decay; the rate rises at first, stays, and falls to nothing in the last fifth of the steps."""
    optimiser, fall, mean = torch.optim.AdamW(network.parameters(), RATE, weight_decay=1e-2), max(FALL, steps // 5), 0.0
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: min((step + 1) / RISE, 1.0, (steps - step) / fall))
    for step in range(steps):
        loss = lesson()
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        schedule.step()
        mean += (float(loss.detach()) - mean) / min(step + 1, 100)
        if (step + 1) % 100 == 0:
            say(f"step {step + 1} of {steps}: loss {mean:.3f}")
