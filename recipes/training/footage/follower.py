"""The tracker in a sequence: filters that learn what the target looks like and how large it is, beside the network."""

from __future__ import annotations

from functools import reduce
from typing import Any, Tuple

import numpy as np
import torch
from crops import SIDE, as_input, cut
from networks import CELL, TEMPLATE, Tracker, peaks
from PIL import Image
from torch import Tensor
from torch.nn import functional

LENGTHS = 5  # sides of squares, in longer sides of the box
FINER = 2  # pixels of the filter's square for each of the network's
CELLS = FINER * SIDE // CELL
# What follows is in cells of the filter, shares and logarithms.
WIDE, TIGHT, LEARNT = 1.4, 1.5, 0.02  # width of the filter's answer; how much of the surroundings it learns, targets; share of a new picture
FIT, AHEAD = 0.5, 0.5  # weights of the network's certainty beside the filter's answer, and of the last motion
LEAST, PATIENCE, FOUND = 0.1, 3, 0.4  # answer of a lost target; pictures until all around is searched; certainty of one that is found again
SIZES, STEP, SIZE_WIDE, SIZE_LEARNT = 17, 0.03, 1.2, 0.025  # sizes that are compared, their steps; width of the answer; share of a new picture
PATCH = 32  # pixels of a side of the target's patch


class Filter:
    """A correlation filter learnt in the sequence itself (MOSSE, CVPR 2010), over places or, as in DSST (BMVC 2014), over sizes."""

    def __init__(self, shape: Tuple[int, ...], width: float, learnt: float) -> None:
        self.shape, self.axes, self.learnt = shape, tuple(range(-len(shape), 0)), learnt
        outer = lambda rows: reduce(np.multiply.outer, rows)
        wanted = outer([np.exp(-0.5 * ((np.arange(length) - length // 2) / width) ** 2) for length in shape])
        self.wanted, self.window = self._waves(np.fft.ifftshift(wanted)).conj(), outer([np.hanning(length + 2)[1:-1] for length in shape])
        self.above: Any = 0.0
        self.below: Any = 0.0

    def _waves(self, seen: np.ndarray) -> np.ndarray:
        return np.fft.rfftn(seen, axes=self.axes)

    def learn(self, seen: np.ndarray, is_target: Any = 1.0) -> None:
        """`seen`: (numbers, *shape), the target in the middle; `is_target`: how much each place is the target's."""
        power = lambda of: (of * of.conj()).real.sum(axis=0)
        target, whole, kept = self._waves(seen * is_target * self.window), self._waves(seen * self.window), 1 - self.learnt
        if not np.ndim(self.above):
            kept = 0.0
        self.above = kept * self.above + (1 - kept) * self.wanted * target
        self.below = kept * self.below + (1 - kept) * (power(target) + power(whole)) / 2

    def answer(self, seen: np.ndarray) -> np.ndarray:
        """How well the target fits each place, about 1 at best."""
        waves = (self.above.conj() * self._waves(seen * self.window)).sum(axis=0) / (self.below + 1e-3 * self.below.mean() + 1e-9)
        return np.fft.fftshift(np.fft.irfftn(waves, s=self.shape))


def near(size: np.ndarray) -> np.ndarray:
    """The places of a target of so many cells, and few around it."""
    far = np.abs(np.arange(CELLS) - CELLS // 2)
    wide, high = (np.exp(-0.5 * (far / np.maximum(TIGHT * length / 2, 0.8)) ** 4) for length in size)
    return np.outer(high, wide)


class Follower:
    """The tracker in a sequence: from the first box on, a box for each picture.

    Filters, which learn what this target looks like, say where it is and how large; the network says where, too, and looks for it in twice
    the square where both have lost it.
    """

    def __init__(self, tracker: Tracker, picture: Image.Image, box: np.ndarray) -> None:
        self.tracker, self.middle, self.size = tracker, (box[:2] + box[2:]) / 2, box[2:] - box[:2]
        self.moved, self.lost = np.zeros(2), 0
        across = np.sin(np.pi * (np.arange(CELLS) + 0.5) / CELLS)
        self.nearness = 0.7 + 0.3 * np.outer(across, across)
        square, _ = cut(picture, tuple(self.middle), self.size.max() * LENGTHS * TEMPLATE / SIDE, TEMPLATE)
        with torch.no_grad():
            self.kernels = tracker.kernels(as_input(square)[None])
        self.places, self.sizes = Filter((CELLS, CELLS), WIDE, LEARNT), Filter((SIZES,), SIZE_WIDE, SIZE_LEARNT)
        self._learn(picture)

    def _learn(self, picture: Image.Image) -> None:
        pixels, _, scale = self._around(picture, self.middle)
        self.places.learn(self._cells(pixels), near(self.size * scale / CELL))
        self.sizes.learn(self._patches(picture))

    def _around(self, picture: Image.Image, middle: np.ndarray) -> Tuple[Tensor, np.ndarray, float]:
        """The filter's square, its left top corner, and pixels per pixel."""
        square, (left, top, scale) = cut(picture, tuple(middle), self.size.max() * LENGTHS, SIDE * FINER)
        return as_input(square)[None], np.array([left, top]), scale

    @torch.no_grad()
    def _cells(self, pixels: Tensor) -> np.ndarray:
        return self.tracker.trunk.stem(pixels)[0].numpy()

    @torch.no_grad()
    def _found(self, pixels: Tensor) -> Tensor:
        return self.tracker.compared(self.kernels, self.tracker.trunk(pixels))[0]

    @torch.no_grad()
    def _patches(self, picture: Image.Image) -> np.ndarray:
        """What the first layers see in the target's box, cut larger and smaller, (numbers, SIZES)."""
        patches = []
        for grown in np.exp(STEP * (np.arange(SIZES) - SIZES // 2)):
            half = np.maximum(self.size * grown, 4) / 2
            left, top, right, bottom = *np.floor(self.middle - half), *np.ceil(self.middle + half)
            edges = [*(self.middle - half - [left, top]), *(self.middle + half - [left, top])]
            patch = picture.crop((left, top, right, bottom)).resize((PATCH, PATCH), Image.Resampling.BILINEAR, edges)
            patches.append(as_input(np.asarray(patch)))
        return self.tracker.trunk.stem(torch.stack(patches)).flatten(1).numpy().T

    def update(self, picture: Image.Image) -> np.ndarray:
        pixels, corner, scale = self._around(picture, self.middle + AHEAD * self.moved)
        found, answer = self._found(functional.avg_pool2d(pixels, FINER)), self.places.answer(self._cells(pixels))
        certain = functional.interpolate(torch.sigmoid(found[None, :1]), scale_factor=FINER, mode="bilinear", align_corners=False)[0, 0].numpy()
        likely = answer.clip(0, 1) + FIT * certain * self.nearness
        place = np.array(np.unravel_index(likely.argmax(), likely.shape))
        self.lost = self.lost + 1 if max(0.6 * answer[tuple(place)], certain[tuple(place)]) < LEAST else 0
        if self.lost >= PATIENCE:
            self._search(picture)
        elif not self.lost:
            before = self.middle
            self.middle = finer(answer, place) * CELL / scale + corner
            self.moved = (self.moved + self.middle - before) / 2
            fits = self.sizes.answer(self._patches(picture))
            self.size = np.maximum(4, self.size * np.exp(STEP * (peak(fits, int(fits.argmax())) - SIZES // 2)))
            self._learn(picture)
        return np.concatenate([self.middle - self.size / 2, self.middle + self.size / 2])

    def _search(self, picture: Image.Image) -> None:
        self.moved = np.zeros(2)
        square, (left, top, scale) = cut(picture, tuple(self.middle), self.size.max() * LENGTHS * 2, SIDE * 2)
        boxes = peaks(self._found(as_input(square)[None]), FOUND)
        if len(boxes):
            box = boxes[boxes[:, 0].argmax(), 1:]
            self.middle = (box[:2] + box[2:]) / 2 / scale + np.array([left, top])


def peak(answer: np.ndarray, place: int) -> float:
    """Where a row of answers is highest, between its places by a parabola."""
    before, here, after = (answer[min(max(place + it, 0), len(answer) - 1)] for it in (-1, 0, 1))
    curve = before - 2 * here + after
    return place + (float(np.clip((before - after) / 2 / curve, -0.5, 0.5)) if curve < 0 else 0.0)


def finer(answer: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Where a peak is between cells, (x, y)."""
    return np.array([peak(answer[place[0]], int(place[1])), peak(answer[:, place[1]], int(place[0]))])
