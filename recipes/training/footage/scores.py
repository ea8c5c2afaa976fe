"""Scores of the detector and the tracker on sequences of frames with one box each, with 95 % intervals over stretches."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple

import numpy as np
import torch
from boxes import average_precision, matches, overlaps
from crops import SIDE, as_input, cut, seen_in
from networks import CELL, TEMPLATE, Detector, Tracker, distinct, peaks
from PIL import Image

RIGHT, SURE, FAINT = 0.4, 0.5, 0.03  # overlap of a right box; certainty of a sure one; certainty below which nothing is a box
FALSE_A_SQUARE = 0.05
LENGTHS = 5  # sides of squares, in longer sides of the box
STRETCHES, DRAWN = 10, 1000
NEAR_PX = 20
# The tracker: what follows is in cells, shares and logarithms, chosen on few sequences.
WIDE, TIGHT, LEARNT = 0.7, 1.5, 0.02  # width of the filter's answer; how much of the surroundings it learns, targets; share of a new picture
FIT, MIDDLE, AHEAD = 0.5, 0.5, 0.5  # weights of the network's certainty beside the filter's answer, of its middle, and of the last motion
GROWTH, STILL, MOST_GROWTH, TRUST = 0.3, 0.06, 0.3, 0.7  # share of a new size; change that is none; largest change; size that is not believed
LEAST, PATIENCE, FOUND = 0.1, 3, 0.4  # answer of a lost target; pictures until all around is searched; certainty of one that is found again
LEAST_PX = 10
Begin = Callable[[Image.Image, np.ndarray], Any]  # a tracker in a sequence, from its first picture and box on


class Sequence:
    """Frames in order of their names, and the box of each: NaN where the target is not to be seen."""

    def __init__(self, frames: str, boxes: str, first: str = "1") -> None:
        folder, file = Path(frames), Path(boxes)
        if not folder.is_dir() or not file.is_file():
            missing = file if folder.is_dir() else folder
            raise SystemExit(f"footage: {missing} is not there; a sequence is a folder of frames and a text file of boxes")
        self.name, self.boxes = file.stem, []
        for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
            try:
                left, top, wide, high = map(float, line.replace(",", " ").split())
            except ValueError:
                told = f"footage: {file}:{number}: `{line[:60]}` is no box"
                raise SystemExit(f"{told}; write left,top,width,height in pixels, NaN where there is none") from None
            self.boxes.append([left, top, left + wide, top + high] if wide > 0 and high > 0 else [np.nan] * 4)
        pictures = sorted(it for it in folder.iterdir() if it.suffix.lower() in (".jpg", ".jpeg", ".png"))
        self.pictures = pictures[int(first) - 1 :][: len(self.boxes)]
        if len(self.pictures) < len(self.boxes) or not self.boxes:
            raise SystemExit(f"footage: {file} has {len(self.boxes)} boxes, and {folder} {len(self.pictures)} frames for them")
        self.boxes = np.array(self.boxes)
        if np.isnan(self.boxes[0]).any():
            raise SystemExit(f"footage: {file}:1: the first line has no box to follow")
        for number in range(len(self)):
            self.picture(number)  # a broken one is told before hours of training

    def picture(self, number: int) -> Image.Image:
        try:
            return Image.open(self.pictures[number]).convert("RGB")
        except OSError as error:
            raise SystemExit(f"footage: {self.pictures[number]} cannot be read: {error}") from None

    def __len__(self) -> int:
        return len(self.boxes)


class Interval(NamedTuple):
    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.2f} [{self.low:.2f}, {self.high:.2f}]"


def interval(of: Callable[[np.ndarray], float], stretches: np.ndarray) -> Interval:
    """`of` rows, and its 2.5 and 97.5 percentiles over stretches drawn anew."""
    draws, names = np.random.default_rng(0), np.unique(stretches)
    rows = [np.flatnonzero(stretches == it) for it in names]
    drawn = [of(np.concatenate([rows[it] for it in draws.integers(len(rows), size=len(rows))])) for _ in range(DRAWN)]
    return Interval(of(np.arange(len(stretches))), *np.percentile(drawn, [2.5, 97.5]))


def mean_of(values: List[float]) -> Interval:
    return interval(lambda rows: float(np.mean(np.array(values)[rows])), np.arange(len(values)))


@torch.no_grad()
def people_in(detector: Detector, square: np.ndarray) -> np.ndarray:
    return distinct(peaks(detector(as_input(square)[None])[0], FAINT))


def inside(box: np.ndarray, side: float, picture: Image.Image) -> tuple:
    """Middle of a square around the box, moved inside the picture where the square fits."""
    middle = (box[:2] + box[2:]) / 2
    return tuple(np.clip(it, side / 2, length - side / 2) if side < length else length / 2 for it, length in zip(middle, picture.size))


def in_squares(
    detector: Detector, pictures: List[Image.Image], boxes: np.ndarray, stretches: np.ndarray, others: Optional[List[np.ndarray]] = None
) -> Dict[str, Interval]:
    """A square of five heights around each box, scaled to 160 pixels: whether the person is found, and what else is that is none of the others."""
    rows = []
    for picture, box, people in zip(pictures, boxes, others or [np.zeros((0, 4))] * len(boxes)):
        side = LENGTHS * (box[3] - box[1])
        square, (left, top, scale) = cut(picture, inside(box, side, picture), side, SIDE)
        found = people_in(detector, square)
        inside_square = lambda box: (box - [left, top, left, top]) * scale
        is_right = overlaps(inside_square(box), found[:, 1:]) > RIGHT
        is_other = np.array([(overlaps(it, inside_square(people)) > 0.2).any() for it in found[:, 1:]], bool)
        found, is_right = found[is_right | ~is_other], is_right[is_right | ~is_other]
        rows.append((found[:, 0], is_right))
    best = np.array([bool(len(it[0])) and bool(it[1][0]) for it in rows])
    sure = np.array([it[0][it[1]].max(initial=0.0) for it in rows])
    false = [it[0][~it[1]] for it in rows]
    wrong = np.array([(it > SURE).sum() for it in false])

    def at_few(chosen: np.ndarray) -> float:
        every = np.sort(np.concatenate([false[it] for it in chosen]))[::-1]
        allowed = int(FALSE_A_SQUARE * len(chosen))
        return float((sure[chosen] > (every[allowed] if len(every) > allowed else 0.0)).mean())

    return {
        "best box right": interval(lambda chosen: best[chosen].mean(), stretches),
        f"recall at {SURE}": interval(lambda chosen: (sure[chosen] > SURE).mean(), stretches),
        f"false boxes a square at {SURE}": interval(lambda chosen: wrong[chosen].mean(), stretches),
        f"recall at {FALSE_A_SQUARE} false boxes a square": interval(at_few, stretches),
    }


@torch.no_grad()
def in_whole(detector: Detector, picture: Image.Image) -> np.ndarray:
    """People in a whole picture, at six sizes."""
    found = []
    for scale in 2.0 ** -np.arange(0, 3, 0.5):
        size = [max(SIDE // 4, round(length * scale) // 16 * 16) for length in picture.size]
        seen = peaks(detector(as_input(np.asarray(picture.resize(size, Image.Resampling.BILINEAR)))[None])[0], FAINT)
        found.append(seen * [1, *np.tile(np.divide(picture.size, size), 2)])
    return distinct(np.concatenate(found))


def precision_of(found: List[np.ndarray], boxes: np.ndarray, overlap: float) -> Callable[[np.ndarray], float]:
    """Average precision of chosen frames, each of which has one person."""
    marked = [matches(of_frame, box[None], overlap) for of_frame, box in zip(found, boxes)]
    return lambda chosen: average_precision([it for frame in chosen for it in marked[frame]], len(chosen))


class Filter:
    """A correlation filter learnt in the sequence itself (MOSSE, CVPR 2010) on the trunk's first layers: the target, and not what is around it."""

    def __init__(self, cells: np.ndarray, size: np.ndarray) -> None:
        self.far = np.arange(cells.shape[-1]) - cells.shape[-1] // 2
        near = np.exp(-0.5 * (self.far / WIDE) ** 2)
        self.wanted = np.conj(np.fft.rfft2(np.fft.ifftshift(np.outer(near, near))))
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


class Follower:
    """The tracker in a sequence: from the first box on, a box for each picture.

    The filter, which learns what this target looks like, says where it is, together with the network; the network alone says how large, and
    looks for it in twice the square where both have lost it.
    """

    def __init__(self, tracker: Tracker, picture: Image.Image, box: np.ndarray) -> None:
        self.tracker, self.middle, self.size = tracker, (box[:2] + box[2:]) / 2, box[2:] - box[:2]
        self.moved, self.lost = np.zeros(2), 0
        across = np.sin(np.pi * (np.arange(SIDE // CELL) + 0.5) / (SIDE // CELL))
        self.nearness = 0.7 + 0.3 * np.outer(across, across)
        square, _ = cut(picture, tuple(self.middle), self.size.max() * LENGTHS * TEMPLATE / SIDE, TEMPLATE)
        with torch.no_grad():
            self.kernels = tracker.kernels(as_input(square)[None])
        near, found, _, scale = self._look(picture, self.middle)
        self.filter = Filter(near, self.size * scale / CELL)
        _, size, certainty = box_beside(found, np.array(self.nearness.shape) // 2)
        self.known = self.size * scale / size  # what the first box calls its size, in what the network does
        self.trust = max(0.0, 1 - float(np.abs(np.log(self.known)).max()) / TRUST) * (certainty > 0.2)

    @torch.no_grad()
    def _look(self, picture: Image.Image, middle: np.ndarray, larger: int = 1) -> Tuple[np.ndarray, torch.Tensor, np.ndarray, float]:
        """First layers and answer of the network for a square, its left top corner, and pixels per pixel."""
        square, (left, top, scale) = cut(picture, tuple(middle), self.size.max() * LENGTHS * larger, SIDE * larger)
        near = self.tracker.trunk.stem(as_input(square)[None])
        found = self.tracker.compared(self.kernels, self.tracker.trunk.from_stem(near))[0]
        return near[0].numpy(), found, np.array([left, top]), scale

    def update(self, picture: Image.Image) -> np.ndarray:
        near, found, corner, scale = self._look(picture, self.middle + AHEAD * self.moved)
        answer = self.filter.answer(near)
        likely = answer.clip(0, 1) + FIT * torch.sigmoid(found[0]).numpy() * self.nearness
        place = np.array(np.unravel_index(likely.argmax(), likely.shape))
        middle, size, certainty = box_beside(found, place)
        self.lost = self.lost + 1 if max(0.6 * answer[tuple(place)], certainty) < LEAST else 0
        if self.lost >= PATIENCE:
            self._search(picture)
        else:
            weight, before = certainty * MIDDLE * self.trust, self.middle
            self.middle = ((1 - weight) * finer(answer, place) * CELL + weight * middle) / scale + corner
            self.moved = (self.moved + self.middle - before) / 2
            grown = np.log(np.maximum(size * self.known, 2) / (self.size * scale)).clip(-MOST_GROWTH, MOST_GROWTH)
            grown = 0.8 * grown.mean() + 0.2 * grown
            grown = np.sign(grown) * np.maximum(np.abs(grown) - STILL, 0)
            self.size = np.maximum(4, self.size * np.exp(GROWTH * certainty * self.trust * grown))
            if not self.lost:
                cell = np.round((self.middle - corner) * scale / CELL).astype(int)[::-1]
                self.filter.update(np.roll(near, tuple(np.array(answer.shape) // 2 - cell), (1, 2)), self.size * scale / CELL)
        return np.concatenate([self.middle - self.size / 2, self.middle + self.size / 2])

    def _search(self, picture: Image.Image) -> None:
        self.moved = np.zeros(2)
        _, found, corner, scale = self._look(picture, self.middle, 2)
        boxes = peaks(found, FOUND)
        if len(boxes):
            box = boxes[boxes[:, 0].argmax(), 1:]
            self.middle = (box[:2] + box[2:]) / 2 / scale + corner


def box_beside(found: torch.Tensor, place: np.ndarray) -> Tuple[np.ndarray, np.ndarray, float]:
    """Middle, size and certainty of the network's box at or beside a cell, pixels of the square."""
    top, left = np.maximum(place - 2, 0)
    around = torch.sigmoid(found[0, top : place[0] + 3, left : place[1] + 3])
    row, column = divmod(int(around.argmax()), around.shape[1])
    edges = found[1:, top + row, left + column].clamp(max=6).exp().numpy() * CELL
    middle = np.array([left + column + 0.5, top + row + 0.5]) * CELL + (edges[2:] - edges[:2]) / 2
    return middle, edges[:2] + edges[2:], float(around.max())


def finer(answer: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Where a peak is between cells, (x, y), by a parabola along each axis."""
    moved = place.astype(float)
    for axis, step in enumerate(np.eye(2, dtype=int)):
        before, here, after = (answer[tuple(np.clip(place + it * step, 0, len(answer) - 1))] for it in (-1, 0, 1))
        curve = before - 2 * here + after
        moved[axis] += float(np.clip((before - after) / 2 / curve, -0.5, 0.5)) if curve < 0 else 0.0
    return moved[::-1]


class OfOpenCv:
    def __init__(self, make: Callable[[], Any], picture: Image.Image, box: np.ndarray) -> None:
        self.tracker, self.box = make(), box
        self.tracker.init(np.asarray(picture)[:, :, ::-1].copy(), tuple(int(round(it)) for it in (*box[:2], *(box[2:] - box[:2]))))

    def update(self, picture: Image.Image) -> np.ndarray:
        is_found, box = self.tracker.update(np.asarray(picture)[:, :, ::-1].copy())
        if is_found:
            self.box = np.array([box[0], box[1], box[0] + box[2], box[1] + box[3]], float)
        return self.box


def trackers(tracker: Tracker) -> Dict[str, Begin]:
    found: Dict[str, Begin] = {"trained on cosfly": lambda picture, box: Follower(tracker, picture, box)}
    try:
        import cv2
    except ImportError:
        return found
    for name in ("CSRT", "KCF"):
        if hasattr(cv2, f"Tracker{name}_create"):
            make = getattr(cv2, f"Tracker{name}_create")
            found[f"{name} of OpenCV {cv2.__version__}"] = lambda picture, box, make=make: OfOpenCv(make, picture, box)
    return found


def followed(sequence: Sequence, begin: Begin) -> Dict[str, Interval]:
    """Success (area below the share of frames over the overlap) and precision (middle within 20 pixels), as OTB and UAV123 define them."""
    follower, told = begin(sequence.picture(0), sequence.boxes[0]), [sequence.boxes[0]]
    for number in range(1, len(sequence)):
        told.append(follower.update(sequence.picture(number)))
    shown = ~np.isnan(sequence.boxes).any(axis=1)
    true, told = sequence.boxes[shown], np.array(told)[shown]
    common = np.array([overlaps(box, other[None])[0] for box, other in zip(true, told)])
    away = np.linalg.norm((true[:, :2] + true[:, 2:] - told[:, :2] - told[:, 2:]) / 2, axis=1)
    success = (common[:, None] > np.linspace(0, 1, 21)).mean(axis=1)
    stretches = STRETCHES * np.arange(len(true)) // len(true)
    near = away <= NEAR_PX
    return {"success": interval(lambda it: success[it].mean(), stretches), "precision": interval(lambda it: near[it].mean(), stretches)}


def report(detector: Detector, tracker: Tracker, dataset: Path, people: List[Sequence], others: List[Sequence], every: int) -> str:
    sets = {"own pictures, a town not seen in training": own_pictures(detector, dataset)}
    for sequence in people:
        numbers = [it for it in range(0, len(sequence), every) if sequence.boxes[it, 3] - sequence.boxes[it, 1] >= LEAST_PX]
        if not numbers:
            sets[f"{sequence.name}: no person of {LEAST_PX} pixels and more"] = {}
            continue
        pictures, boxes = [sequence.picture(it) for it in numbers], sequence.boxes[numbers]
        stretches = STRETCHES * np.array(numbers) // len(sequence)
        row = in_squares(detector, pictures, boxes, stretches)
        found = [in_whole(detector, picture) for picture in pictures]
        for overlap in (RIGHT, 0.5):
            row[f"average precision in whole frames, overlap {overlap}"] = interval(precision_of(found, boxes, overlap), stretches)
        sets[f"{sequence.name}, {len(numbers)} frames"] = row
    lines = ["# Networks trained on cosfly alone", "", "## Detector of people", ""]
    columns = list(dict.fromkeys(name for row in sets.values() for name in row))
    lines += ["| | " + " | ".join(sets) + " |", "|---" * (len(sets) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(str(row.get(name, "")) for row in sets.values()) + " |" for name in columns]
    if people or others:
        lines += ["", "## Trackers", "", f"| sequence | tracker | success | precision at {NEAR_PX} px |", "|---|---|---|---|"]
        all_of: Dict[str, List[Dict[str, Interval]]] = {}
        for sequence in people + others:
            for name, begin in trackers(tracker).items():
                row = followed(sequence, begin)
                all_of.setdefault(name, []).append(row)
                lines.append(f"| {sequence.name} | {name} | " + " | ".join(map(str, row.values())) + " |")
        for name, rows in all_of.items() if len(people + others) > 1 else ():
            means = [mean_of([row[score].value for row in rows]) for score in rows[0]]
            lines.append(f"| **mean of {len(rows)} sequences** | {name} | " + " | ".join(map(str, means)) + " |")
    return "\n".join([*lines, ""])


def own_pictures(detector: Detector, dataset: Path, most: int = 200) -> Dict[str, Interval]:
    import cosfly

    judged = cosfly.Dataset(dataset, split="test", channels=("rgb",))
    seen, pictures, boxes, flights, others = seen_in(judged), [], [], [], []
    for number in range(0, len(judged), max(1, len(judged) // most)):
        sample = judged[number]
        of_frame = seen.get((sample["trajectory_id"], int(sample["frame"])), [])
        target = next((it for it in of_frame if it.body == "target" and it.is_clear), None)
        if target:
            pictures.append(Image.fromarray(sample["rgb"]))
            boxes.append(target.box)
            flights.append(sample["trajectory_id"])
            others.append(np.array([it.box for it in of_frame if it.body != "target" and it.is_person]).reshape(-1, 4))
    return in_squares(detector, pictures, np.array(boxes), np.array(flights), others) if pictures else {}
