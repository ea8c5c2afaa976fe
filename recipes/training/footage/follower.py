"""The tracker in a sequence: filters that learn what the target looks like and how large it is, beside the network."""

from __future__ import annotations

from typing import Tuple

import numpy as np
import torch
from crops import SIDE, as_input, cut
from networks import CELL, TEMPLATE, Tracker, peaks
from PIL import Image
from torch import Tensor
from torch.nn import functional

LENGTHS = 5  # sides of squares, in longer sides of the box
FINER = 2  # pixels of the filter's square for each of the network's
# What follows is in cells of the filter, shares and logarithms.
WIDE, TIGHT, LEARNT = 1.4, 1.5, 0.02  # width of the filter's answer; how much of the surroundings it learns, targets; share of a new picture
FIT, MIDDLE, AHEAD = 0.5, 0.5, 0.5  # weights of the network's certainty beside the filter's answer, of its middle, and of the last motion
GROWTH, STILL, MOST_GROWTH, TRUST = 0.3, 0.06, 0.3, 0.7  # share of a new size; change that is none; largest change; size that is not believed
LEAST, PATIENCE, FOUND = 0.1, 3, 0.4  # answer of a lost target; pictures until all around is searched; certainty of one that is found again
SIZES, STEP, SIZE_WIDE, SIZE_LEARNT, PATCH, AROUND = 17, 0.03, 1.2, 0.025, 32, 1.0  # sizes that are compared; their steps; width of the answer
SIZED = 1.0


def waves_of(answer: np.ndarray) -> np.ndarray:
    return np.conj(np.fft.rfftn(np.fft.ifftshift(answer)))


class Filter:
    """A correlation filter learnt in the sequence itself (MOSSE, CVPR 2010) on the trunk's first layers: the target, and not what is around it."""

    def __init__(self, cells: np.ndarray, size: np.ndarray) -> None:
        self.far = np.arange(cells.shape[-1]) - cells.shape[-1] // 2
        near = np.exp(-0.5 * (self.far / WIDE) ** 2)
        self.wanted = waves_of(np.outer(near, near))
        self.window = np.outer(np.hanning(len(self.far)), np.hanning(len(self.far)))
        self.above, self.below = self._of(cells, size)

    def _of(self, cells: np.ndarray, size: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """`size` is the target's, cells; the square's middle is the target's."""
        wide, high = (np.exp(-0.5 * (np.abs(self.far) / np.maximum(TIGHT * length / 2, 0.8)) ** 4) for length in size)
        target, whole = (np.fft.rfft2(cells * it) for it in (np.outer(high, wide) * self.window, self.window))
        power = lambda of: (of * of.conj()).real.sum(axis=0)
        return self.wanted * target, (power(target) + power(whole)) / 2

    def update(self, cells: np.ndarray, size: np.ndarray) -> None:
        above, below = self._of(cells, size)
        self.above, self.below = (1 - LEARNT) * self.above + LEARNT * above, (1 - LEARNT) * self.below + LEARNT * below

    def answer(self, cells: np.ndarray) -> np.ndarray:
        """How well the target's middle fits each cell, about 1 at best."""
        waves = np.fft.rfft2(cells * self.window)
        return np.fft.fftshift(np.fft.irfft2((self.above.conj() * waves).sum(axis=0) / (self.below + 1e-3 * self.below.mean() + 1e-9), s=self.window.shape))


class SizeFilter:
    """The same over sizes (DSST, BMVC 2014): the target's patch, cut larger and smaller, against the size it was learnt at."""

    def __init__(self, patches: np.ndarray) -> None:
        steps = np.arange(SIZES) - SIZES // 2
        self.wanted = waves_of(np.exp(-0.5 * (steps / SIZE_WIDE) ** 2))
        self.window = np.hanning(SIZES + 2)[1:-1]
        self.above, self.below = self._of(patches)

    def _of(self, patches: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        waves = np.fft.rfft(patches * self.window)
        return self.wanted * waves, (waves * waves.conj()).real.sum(axis=0)

    def update(self, patches: np.ndarray) -> None:
        above, below = self._of(patches)
        self.above, self.below = (1 - SIZE_LEARNT) * self.above + SIZE_LEARNT * above, (1 - SIZE_LEARNT) * self.below + SIZE_LEARNT * below

    def answer(self, patches: np.ndarray) -> np.ndarray:
        waves = np.fft.rfft(patches * self.window)
        return np.fft.fftshift(np.fft.irfft((self.above.conj() * waves).sum(axis=0) / (self.below + 1e-3 * self.below.mean() + 1e-9), n=SIZES))


class Follower:
    """The tracker in a sequence: from the first box on, a box for each picture.

    The filter, which learns what this target looks like, says where it is, together with the network; the network alone says how large, and
    looks for it in twice the square where both have lost it.
    """

    def __init__(self, tracker: Tracker, picture: Image.Image, box: np.ndarray) -> None:
        self.tracker, self.middle, self.size = tracker, (box[:2] + box[2:]) / 2, box[2:] - box[:2]
        self.moved, self.lost = np.zeros(2), 0
        across = np.sin(np.pi * (np.arange(FINER * SIDE // CELL) + 0.5) / (FINER * SIDE // CELL))
        self.nearness = 0.7 + 0.3 * np.outer(across, across)
        square, _ = cut(picture, tuple(self.middle), self.size.max() * LENGTHS * TEMPLATE / SIDE, TEMPLATE)
        with torch.no_grad():
            self.kernels = tracker.kernels(as_input(square)[None])
        pixels, _, scale = self._around(picture, self.middle)
        self.filter, self.sizes = Filter(self._cells(pixels), self.size * scale / CELL), SizeFilter(self._patches(picture))
        found = self._found(functional.avg_pool2d(pixels, FINER))
        _, size, certainty = box_beside(found, np.array(found.shape[1:]) // 2)
        self.known = self.size * scale / FINER / size  # what the first box calls its size, in what the network does
        self.trust = max(0.0, 1 - float(np.abs(np.log(self.known)).max()) / TRUST) * (certainty > 0.2)

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
            half = np.maximum(self.size * grown * AROUND, 4) / 2
            left, top, right, bottom = *np.floor(self.middle - half), *np.ceil(self.middle + half)
            edges = [*(self.middle - half - [left, top]), *(self.middle + half - [left, top])]
            patch = picture.crop((left, top, right, bottom)).resize((PATCH, PATCH), Image.Resampling.BILINEAR, edges)
            patches.append(as_input(np.asarray(patch)))
        return self.tracker.trunk.stem(torch.stack(patches)).flatten(1).numpy().T

    def update(self, picture: Image.Image) -> np.ndarray:
        pixels, corner, scale = self._around(picture, self.middle + AHEAD * self.moved)
        found, answer = self._found(functional.avg_pool2d(pixels, FINER)), self.filter.answer(self._cells(pixels))
        certain = functional.interpolate(torch.sigmoid(found[None, :1]), scale_factor=FINER, mode="bilinear", align_corners=False)[0, 0].numpy()
        likely = answer.clip(0, 1) + FIT * certain * self.nearness
        place = np.array(np.unravel_index(likely.argmax(), likely.shape))
        middle, size, certainty = box_beside(found, place // FINER)
        self.lost = self.lost + 1 if max(0.6 * answer[tuple(place)], certainty) < LEAST else 0
        if self.lost >= PATIENCE:
            self._search(picture)
        else:
            weight, before = certainty * MIDDLE * self.trust, self.middle
            self.middle = ((1 - weight) * finer(answer, place) * CELL + weight * middle * FINER) / scale + corner
            self.moved = (self.moved + self.middle - before) / 2
            grown = np.log(np.maximum(size * self.known * FINER, 2) / (self.size * scale)).clip(-MOST_GROWTH, MOST_GROWTH)
            grown = 0.8 * grown.mean() + 0.2 * grown
            grown = np.sign(grown) * np.maximum(np.abs(grown) - STILL, 0)
            self.size = np.maximum(4, self.size * np.exp(GROWTH * certainty * self.trust * grown))
            if not self.lost:
                if SIZED:
                    fits = self.sizes.answer(self._patches(picture))
                    self.size = np.maximum(4, self.size * np.exp(SIZED * STEP * (float(peak(fits)) - SIZES // 2)))
                    self.sizes.update(self._patches(picture))
                pixels, _, scale = self._around(picture, self.middle)
                self.filter.update(self._cells(pixels), self.size * scale / CELL)
        return np.concatenate([self.middle - self.size / 2, self.middle + self.size / 2])

    def _search(self, picture: Image.Image) -> None:
        self.moved = np.zeros(2)
        square, (left, top, scale) = cut(picture, tuple(self.middle), self.size.max() * LENGTHS * 2, SIDE * 2)
        boxes = peaks(self._found(as_input(square)[None]), FOUND)
        if len(boxes):
            box = boxes[boxes[:, 0].argmax(), 1:]
            self.middle = (box[:2] + box[2:]) / 2 / scale + np.array([left, top])


def box_beside(found: torch.Tensor, place: np.ndarray) -> Tuple[np.ndarray, np.ndarray, float]:
    """Middle, size and certainty of the network's box at or beside a cell, pixels of the square."""
    top, left = np.maximum(place - 2, 0)
    around = torch.sigmoid(found[0, top : place[0] + 3, left : place[1] + 3])
    row, column = divmod(int(around.argmax()), around.shape[1])
    edges = found[1:, top + row, left + column].clamp(max=6).exp().numpy() * CELL
    middle = np.array([left + column + 0.5, top + row + 0.5]) * CELL + (edges[2:] - edges[:2]) / 2
    return middle, edges[:2] + edges[2:], float(around.max())


def peak(answer: np.ndarray, place: int = -1) -> float:
    """Where a row of answers is highest, between its places by a parabola."""
    place = int(answer.argmax()) if place < 0 else place
    before, here, after = (answer[min(max(place + it, 0), len(answer) - 1)] for it in (-1, 0, 1))
    curve = before - 2 * here + after
    return place + (float(np.clip((before - after) / 2 / curve, -0.5, 0.5)) if curve < 0 else 0.0)


def finer(answer: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Where a peak is between cells, (x, y)."""
    return np.array([peak(answer[place[0]], int(place[1])), peak(answer[:, place[1]], int(place[0]))])
