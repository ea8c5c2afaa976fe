"""Squares around targets in pictures, and what is measured of them: the front half of judge_pictures.py.

Reads datasets (boxes from the tables, pictures from the logs) and folders of real frames with a file of boxes."""

import hashlib
import json
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shared
from brisque import BRISQUE
from PIL import Image

LEAST_PX, LEAST_SIDE_PX, HEIGHTS = 12, 64, 5
OVERLAP, SCORE = 0.4, 0.3
# COCO's classes that are right for a kind of body.
ROAD, CYCLES = {"car", "bus", "truck"}, {"bicycle", "motorcycle"}
RIGHT = {"pedestrian": {"person"}, "car": ROAD, "van": ROAD, "truck": ROAD, "bus": ROAD, "motorcycle": CYCLES, "bicycle": CYCLES}


@dataclass
class Crop:
    """A square around a target: `box` is left, top, right, bottom as shares of the square; `picture` is the number of its picture."""

    size: str
    kind: str
    flight: str
    square: Image.Image
    box: tuple
    height_px: float
    picture: tuple
    groups: dict = field(default_factory=dict)
    answer: dict = field(default_factory=dict)

    def score(self, network):
        """Score of the best box of a right class that overlaps the target's; 0 without one."""
        right = [row[4] for row in self.answer[network] if row[5] in RIGHT[self.kind] and overlap(row, self.box) > OVERLAP]
        return max(right, default=0.0)

    def named(self):
        """Class of CenterNet's best box over the target, whatever its score."""
        over = [row for row in self.answer["centernet"] if overlap(row, self.box) > OVERLAP]
        return max(over, key=lambda row: row[4])[5] if over else "nothing"

    def reduced(self, factor):
        """The same crop from a picture reduced by a whole factor, by the mean of areas."""
        size = f"{self.size} / {factor}"
        return Crop(size, self.kind, self.flight, self.square.reduce(factor), self.box, self.height_px / factor, self.picture, self.groups)


def overlap(a, b):
    """Intersection over union of two boxes."""
    wide, high = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    both = max(wide, 0) * max(high, 0)
    return both / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both)


def cut(picture, box):
    """The square of five heights around a box in pixels, moved inside the picture, and the box in it; None where it does not fit."""
    left, top, right, bottom = box
    side = min(max(round(HEIGHTS * (bottom - top)), LEAST_SIDE_PX), *picture.size)
    x = min(max(round((left + right - side) / 2), 0), picture.width - side)
    y = min(max(round((top + bottom - side) / 2), 0), picture.height - side)
    inside = ((left - x) / side, (top - y) / side, (right - x) / side, (bottom - y) / side)
    if min(inside) < 0 or max(inside) > 1:
        return None
    return picture.crop((x, y, x + side, y + side)), inside


def size_of(height_px):
    """Name of the bin of a target's height."""
    return f"from {max(edge for edge in (LEAST_PX, 30, 60, 120, 240) if edge <= height_px):03} px"


def evenly(rows, most):
    """At most so many of the rows, evenly over them."""
    return [rows[index] for index in np.unique(np.linspace(0, len(rows) - 1, min(most, len(rows))).round().astype(int))]


def is_seen(row, film, visible):
    """Whether a frame shows that share of the target, large enough and away from the picture's edge."""
    left, top, right, bottom = row["visible_box_px"] or (0, 0, 0, 0)
    edge = min(left, top, film["camera_width_px"] - right, film["camera_height_px"] - bottom)
    return row["visible_by_pixels"] >= visible and bottom - top >= LEAST_PX and edge > 3


def crops_of_dataset(dataset, visible, per_film, by_camera, where):
    """Crops of the targets of a dataset, at most `per_film` of a flight and camera, and the first picture of each."""
    (films, frames, _), crops, kept = shared.flown(dataset, of_bodies=["kind"]), [], {}
    for _, film in sorted(films.items()):
        seen = [row for _, row in sorted(frames[film["trajectory_id"]].items()) if is_seen(row, film, visible)]
        chosen = {row["frame"]: row for row in evenly(seen, per_film)}
        for number, picture in pictures_of_log(Path(dataset) / film["mcap_path"], chosen):
            row = chosen[number]
            found, high = cut(picture, row["visible_box_px"]), row["visible_box_px"][3] - row["visible_box_px"][1]
            if found is None:
                continue
            size = film["camera_name"] if by_camera else size_of(high)
            pitch = "below -60" if row["camera_pitch_deg"] < -60 else "-60 to -45" if row["camera_pitch_deg"] < -45 else "above -45"
            name = (where, film["trajectory_id"], number)
            groups = {"weather": film["weather_preset"], "crowd": film["flight_id"].split("-")[0], "pitch": pitch, "town": film["town"]}
            crops.append(Crop(size, film["target_kind"] or "pedestrian", f"{where} {film['flight_id']}", *found, high, name, groups))
            kept.setdefault(film["trajectory_id"], (name, picture))
    return crops, dict(kept.values())


def pictures_of_log(path, numbers):
    for number, (_, message, *_) in enumerate(shared.messages(path, ["/camera/rgb/image"])):
        if number in numbers:
            yield number, shared.picture(message).convert("RGB")


def crops_of_frames(folder, boxes, kind, first, count):
    """Crops of real frames, `count` evenly over the sequence: line i of `boxes` (left,top,width,height) belongs to the picture `first + i`
    of the sorted folder. Ten stretches of the sequence count as flights."""
    pictures = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() in (".jpg", ".jpeg", ".png"))
    lines = []
    for number, line in enumerate(Path(boxes).read_text().split(), 1):
        try:
            lines.append([float(part) for part in line.split(",")])
            assert len(lines[-1]) == 4
        except (ValueError, AssertionError):
            raise SystemExit(f"judge_pictures: {boxes}:{number}: `{line}` is no box; write left,top,width,height in pixels") from None
    good = [index for index, line in enumerate(lines) if line[3] >= LEAST_PX and index + first < len(pictures)]
    crops, kept = [], {}
    for index in evenly(good, count):
        left, top, wide, high = lines[index]
        name, picture = (Path(boxes).stem, index), Image.open(pictures[index + first]).convert("RGB")
        found, size = cut(picture, (left, top, left + wide, top + high)), "as filmed" if kind == "pedestrian" else size_of(high)
        if found is not None:
            flight = f"{name[0]} {10 * index // len(lines)}"
            crops.append(Crop(size, kind, flight, *found, high, name, {"sequence": name[0]}))
            kept[name] = picture
    return crops, kept


class Networks:
    """The networks in a process of node, with a file of the answers that were given before."""

    def __init__(self, modules, kept):
        self.kept, self.answers = Path(kept), {}
        if self.kept.exists():
            self.answers = dict(json.loads(line) for line in self.kept.read_text().splitlines())
        command = ["node", str(Path(__file__).with_name("judge_networks.mjs")), str(modules)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def judge(self, crop):
        squares = b"".join(crop.square.resize((side, side), Image.Resampling.BILINEAR).tobytes() for side in (512, 416))
        name = hashlib.blake2b(squares, digest_size=16).hexdigest()
        if name not in self.answers:
            self.process.stdin.write(bytes([crop.kind == "pedestrian"]) + squares)
            self.process.stdin.flush()
            line = self.process.stdout.readline()
            if not line:
                raise SystemExit("judge_pictures: node ended; its words are above")
            self.answers[name] = json.loads(line)
            with self.kept.open("a") as file:
                file.write(json.dumps([name, self.answers[name]]) + "\n")
        crop.answer = self.answers[name]


def slopes(picture):
    """Slopes of the power spectrum of the luminance of the central square, log against log, over rings of one cycle: from 1/50 to 1/2 of
    a cycle a pixel, and its upper half, from 1/4 on."""
    side = min(picture.size)
    x, y = (picture.width - side) // 2, (picture.height - side) // 2
    light = np.asarray(picture.crop((x, y, x + side, y + side)).convert("L"), dtype=float)
    window = np.hanning(side)
    power = np.abs(np.fft.fft2((light - light.mean()) * np.outer(window, window))) ** 2
    frequency = np.fft.fftfreq(side)
    ring = np.hypot(frequency[:, None], frequency[None, :])
    number = np.rint(ring * side).astype(int).ravel()
    mean = np.bincount(number, power.ravel()) / np.bincount(number)
    cycles = np.arange(len(mean)) / side

    def slope(least):
        used = (cycles >= least) & (cycles <= 0.5)
        return np.polyfit(np.log(cycles[used]), np.log(mean[used] + 1e-12), 1)[0]

    return slope(0.02), slope(0.25)


def measures_of(pictures, most):
    """BRISQUE and slopes of at most so many pictures, rows of numbers."""
    natural = BRISQUE(url=False)
    numbers = [(natural.score(np.asarray(pictures[name])), *slopes(pictures[name])) for name in evenly(sorted(pictures), most)]
    return np.round(numbers, 6)  # the last digits hang on the threads of OpenCV


def frechet(a, real):
    """Frechet distance of two clouds of features, rows of numbers, in units of the real ones' spread."""
    a, b = (np.asarray(rows) / (np.std(real, axis=0) + 1e-9) for rows in (a, real))
    both = np.linalg.eigvals(np.cov(a.T) @ np.cov(b.T)).real
    means = ((a.mean(axis=0) - b.mean(axis=0)) ** 2).sum()
    return round(float(means + np.trace(np.cov(a.T)) + np.trace(np.cov(b.T)) - 2 * np.sqrt(np.clip(both, 0, None)).sum()), 3)
