"""Scores of the detector and the tracker on sequences of frames with one box each, with 95 % intervals over stretches."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional

import numpy as np
import torch
from boxes import average_precision, matches, overlaps
from crops import SIDE, as_input, cut, seen_in
from follower import LENGTHS, Follower
from networks import Detector, Tracker, distinct, peaks
from PIL import Image

RIGHT, SURE, FAINT = 0.4, 0.5, 0.03  # overlap of a right box; certainty of a sure one; certainty below which nothing is a box
FALSE_A_SQUARE = 0.05
STRETCHES, DRAWN = 10, 1000
NEAR_PX = 20
LEAST_PX = 10
OF_OPENCV = ("CSRT", "KCF")
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
def seen_both_ways(detector: Detector, square: np.ndarray) -> np.ndarray:
    """Boxes of the mean answer to a picture and to its mirror image."""
    pixels = as_input(square)[None]
    seen, mirrored = detector(torch.cat([pixels, pixels.flip(3)]))
    return peaks((seen + mirrored.flip(2)[[0, 3, 2, 1, 4]]) / 2, FAINT)


def inside(box: np.ndarray, side: float, picture: Image.Image) -> tuple:
    """Middle of a square around the box, moved inside the picture where the square fits."""
    middle = (box[:2] + box[2:]) / 2
    return tuple(np.clip(it, side / 2, length - side / 2) if side < length else length / 2 for it, length in zip(middle, picture.size))


def in_squares(
    detectors: List[Detector], pictures: List[Image.Image], boxes: np.ndarray, stretches: np.ndarray, others: Optional[List[np.ndarray]] = None
) -> Dict[str, Interval]:
    """Scores of the first detector, and what it has more than the second in the same squares."""
    scored, *whole = (measures(detector, pictures, boxes, others) for detector in detectors)
    found = {name: interval(of, stretches) for name, of in scored.items()}
    for of_whole in whole:
        for name in ("best box right", f"recall at {FALSE_A_SQUARE} false boxes a square"):
            more = lambda chosen: scored[name](chosen) - of_whole[name](chosen)
            found[f"{name}, more than with the whole recipe"] = interval(more, stretches)
    return found


def measures(
    detector: Detector, pictures: List[Image.Image], boxes: np.ndarray, others: Optional[List[np.ndarray]]
) -> Dict[str, Callable[[np.ndarray], float]]:
    """A square of five heights around each box, scaled to 160 pixels: whether the person is found, and what else is that is none of the others."""
    rows = []
    for picture, box, people in zip(pictures, boxes, others or [np.zeros((0, 4))] * len(boxes)):
        side = LENGTHS * (box[3] - box[1])
        square, (left, top, scale) = cut(picture, inside(box, side, picture), side, SIDE)
        found = distinct(seen_both_ways(detector, square))
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
        "best box right": lambda chosen: best[chosen].mean(),
        f"recall at {SURE}": lambda chosen: (sure[chosen] > SURE).mean(),
        f"false boxes a square at {SURE}": lambda chosen: wrong[chosen].mean(),
        f"recall at {FALSE_A_SQUARE} false boxes a square": at_few,
    }


def in_whole(detector: Detector, picture: Image.Image) -> np.ndarray:
    """People in a whole picture, at six sizes."""
    found = []
    for scale in 2.0 ** -np.arange(0, 3, 0.5):
        size = [max(SIDE // 4, round(length * scale) // 16 * 16) for length in picture.size]
        seen = seen_both_ways(detector, np.asarray(picture.resize(size, Image.Resampling.BILINEAR)))
        found.append(seen * [1, *np.tile(np.divide(picture.size, size), 2)])
    return distinct(np.concatenate(found))


def precision_of(found: List[np.ndarray], boxes: np.ndarray, overlap: float) -> Callable[[np.ndarray], float]:
    """Average precision of chosen frames, each of which has one person."""
    marked = [matches(of_frame, box[None], overlap) for of_frame, box in zip(found, boxes)]
    return lambda chosen: average_precision([it for frame in chosen for it in marked[frame]], len(chosen))


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
        cv2 = None  # the report says so
    for name in OF_OPENCV:
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


def report(
    detectors: List[Detector], tracker: Tracker, dataset: Path, people: List[Sequence], others: List[Sequence], every: int, briefly: bool
) -> str:
    """Scores of the first detector, beside the second where there is one, and of the tracker."""
    sets = {"own pictures, a town not seen in training": own_pictures(detectors, dataset)}
    for sequence in people:
        numbers = [it for it in range(0, len(sequence), every) if sequence.boxes[it, 3] - sequence.boxes[it, 1] >= LEAST_PX]
        if not numbers:
            sets[f"{sequence.name}: no person of {LEAST_PX} pixels and more"] = {}
            continue
        pictures, boxes = [sequence.picture(it) for it in numbers], sequence.boxes[numbers]
        stretches = STRETCHES * np.array(numbers) // len(sequence)
        row = in_squares(detectors, pictures, boxes, stretches)
        found = [] if briefly else [in_whole(detectors[0], picture) for picture in pictures]
        for overlap in (RIGHT, 0.5) if found else ():
            row[f"average precision in whole frames, overlap {overlap}"] = interval(precision_of(found, boxes, overlap), stretches)
        sets[f"{sequence.name}, {len(numbers)} frames"] = row
    lines = ["# Networks trained on cosfly alone", "", "## Detector of people", ""]
    columns = list(dict.fromkeys(name for row in sets.values() for name in row))
    lines += ["| | " + " | ".join(sets) + " |", "|---" * (len(sets) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(str(row.get(name, "")) for row in sets.values()) + " |" for name in columns]
    if briefly:
        lines += ["", "NOT RUN: whole frames and trackers, because of `--briefly`"]
    elif people or others:
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
        left = [name for name in OF_OPENCV if not any(name in it for it in all_of)]
        if left:
            lines += ["", f"NOT RUN: {' and '.join(left)}, for OpenCV does not have them here; `pip install opencv-contrib-python-headless==4.10.0.84`"]
    else:
        lines += ["", "NOT RUN: real footage, for none was named; `--people FRAMES BOXES` scores the networks on yours"]
    return "\n".join([*lines, ""])


def own_pictures(detectors: List[Detector], dataset: Path, most: int = 200) -> Dict[str, Interval]:
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
    return in_squares(detectors, pictures, np.array(boxes), np.array(flights), others) if pictures else {}
