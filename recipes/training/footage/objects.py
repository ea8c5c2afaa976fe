"""Objects of no kind: shapes filled with pieces of pictures and pasted into others, so that the tracker learns to follow anything."""

from __future__ import annotations

from typing import List, NamedTuple, Optional

import numpy as np
import torch
from crops import Squares, views
from torch import Tensor
from torch.nn import functional

FINE = 64  # pixels of an object's side before it is pasted


def drawn_objects(squares: Squares, count: int, draws: np.random.Generator) -> Tensor:
    """(count, 4, FINE, FINE): a shape of two parts, 0 to 255, each with colours of its own, and where it is, 0 to 1."""
    parts = []
    for _ in range(2):
        rows, scales = draws.integers(len(squares.bodies), size=count), np.exp(draws.uniform(-0.7, 1.0, count))
        away, angle = draws.uniform(60, 120, count) * scales / (FINE / 2), draws.uniform(-np.pi, np.pi, count)  # who is in the middle is no object
        moves = away[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
        piece = views(squares.pictures[torch.from_numpy(rows)], FINE, scales, moves, angle, angle > 0).pictures
        number = lambda low, high, channels: torch.from_numpy(draws.uniform(low, high, (count, channels, 1, 1))).float()
        parts.append((piece * torch.exp(number(-0.5, 0.5, 1) + number(-0.3, 0.3, 3)) + number(-70, 70, 1) + number(-30, 30, 3)).clamp(0, 255))
    y, x = np.meshgrid(*[(np.arange(FINE) + 0.5) / FINE * 2 - 1] * 2, indexing="ij")
    drawn = lambda low, high: draws.uniform(low, high, (count, 1, 1))
    power, narrow, taper = np.exp(drawn(0.3, 2.0)), np.exp(drawn(-1.3, 0)), drawn(-0.5, 0.5)
    inside = np.abs(x / (narrow * (1 + taper * y))) ** power + np.abs(y) ** power < 0.9
    second = np.abs((x - drawn(-0.5, 0.5) * narrow) / (narrow * drawn(0.3, 0.9))) ** power + np.abs((y - drawn(-0.7, 0.7)) / drawn(0.2, 0.8)) ** power < 1
    colours = torch.where(torch.from_numpy(second)[:, None], *parts)
    return torch.cat([colours, torch.from_numpy(inside)[:, None].float()], dim=1)


class Pasted(NamedTuple):
    pictures: Tensor
    hides: Tensor  # (views, side, side), 0 to 1
    boxes: List[Optional[np.ndarray]]


def pasted(pictures: Tensor, objects: Tensor, lengths: np.ndarray, places: np.ndarray, turns: np.ndarray, stretches: np.ndarray) -> Pasted:
    """Pictures with an object each, `lengths` pixels long, its middle at `places` (-1 to 1 over half of the picture); its box where half of it shows."""
    side, cos, sin = pictures.shape[-1], np.cos(turns), np.sin(turns)
    inverse = np.stack([np.stack([cos, sin], 1) / stretches[:, None], np.stack([-sin, cos], 1)], 1) * (side / lengths)[:, None, None]
    theta = np.concatenate([inverse, -(inverse @ places[:, :, None])], axis=2)
    grid = functional.affine_grid(torch.from_numpy(theta).float(), [len(pictures), 4, side, side], align_corners=False)
    small = torch.from_numpy(lengths < FINE * 0.6)[:, None, None, None]
    seen = functional.grid_sample(torch.where(small, functional.avg_pool2d(objects, 3, 1, 1), objects), grid, align_corners=False)
    hides = seen[:, 3:]
    boxes: List[Optional[np.ndarray]] = []
    for shown, length in zip((hides[:, 0] > 0.5).numpy(), lengths):
        rows, columns = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
        boxes.append(np.array([columns[0], rows[0], columns[-1] + 1, rows[-1] + 1], float) if len(rows) and shown.sum() > 8 else None)
    return Pasted(pictures * (1 - hides) + seen[:, :3] * hides, hides[:, 0], boxes)
