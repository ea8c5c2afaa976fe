"""Boxes that a network found, held against those of people: overlaps and average precision."""

from __future__ import annotations

from typing import List, Tuple

import numpy as np

Marked = List[Tuple[float, bool]]


def overlaps(box: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Common area of a box and each of others over the area of both (IoU); a box is left, top, right, bottom."""
    low, high = np.maximum(boxes[:, :2], box[:2]), np.minimum(boxes[:, 2:], box[2:])
    common = np.prod(np.clip(high - low, 0, None), axis=1)
    area = lambda of: np.prod(np.clip(of[..., 2:] - of[..., :2], 0, None), axis=-1)
    return common / np.maximum(area(boxes) + area(box) - common, 1e-6)


def matches(found: np.ndarray, boxes: np.ndarray, overlap: float = 0.5) -> Marked:
    """Certainty of each found row (certainty, box), best first, and whether it is the first that overlaps a person so much."""
    is_free, marked = np.ones(len(boxes), bool), []
    for row in found[np.argsort(-found[:, 0], kind="stable")]:
        common = np.where(is_free, overlaps(row[1:], boxes), 0)
        is_right = len(boxes) > 0 and common.max() >= overlap
        if is_right:
            is_free[common.argmax()] = False
        marked.append((float(row[0]), bool(is_right)))
    return marked


def average_precision(marked: Marked, people: int) -> float:
    """Area below precision over recall, 0 to 1."""
    right = np.array([it[1] for it in sorted(marked, key=lambda it: -it[0])], float)
    if not people or not len(right):
        return 0.0
    precision = right.cumsum() / np.arange(1, len(right) + 1)
    best = np.maximum.accumulate(precision[::-1])[::-1]
    return float((best * right).sum() / people)
