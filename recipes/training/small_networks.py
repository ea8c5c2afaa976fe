#!/usr/bin/env python3
"""Trains small networks on a dataset's windows and tests two findings of the paper with them.

    python recipes/training/small_networks.py out/hundred
    python recipes/training/small_networks.py out/hundred --predictions networks.jsonl
    python recipes/training/small_networks.py out/hundred --depth

Needs numpy, and pyarrow for reading. Learns from split train, judges on the other splits. Fifteen networks, three
seeds of five kinds: two hidden layers, trained by Adam on poses and on boxes of the target. A box is
read as a place: its middle gives the direction, its height the distance. `--depth` adds a kind that reads the distance from the
depth pictures of the logs instead, and needs `mcap` and `mcap-protobuf-support`. Every window is learnt a second time as its
mirror image. Tested is whether pose history is the decisive input, whether boxes add to poses, and whether learning from
perturbed flights (denoising) beats learning from experts' flights alone on yaw.

`--predictions` writes the windows' predictions by the first network (poses and boxes, denoising) as a file for
`cosfly eval`. The book's page "Benchmarks" has the figures of a dataset of a hundred walkers.
"""

import argparse
import copy
import json
from pathlib import Path

import tools

tools.need("numpy", "pyarrow.dataset")
import numpy as np
import pyarrow.dataset as ds

EXPERT, PERTURBED = 0, 1
# Name, sees poses, sees boxes, roles of the flights that are learnt from.
KINDS = [
    ("poses and boxes, denoising", True, True, [PERTURBED]),
    ("poses alone, denoising", True, False, [PERTURBED]),
    ("boxes alone, denoising", False, True, [PERTURBED]),
    ("poses and boxes, mixed", True, True, [PERTURBED, EXPERT]),
    ("poses and boxes, expert only", True, True, [EXPERT]),
]
FULL, WITHOUT_BOXES, WITHOUT_POSES, EXPERT_ONLY = 0, 1, 2, 4
WITH_DEPTH = ("poses, boxes and depth, denoising", True, True, [PERTURBED])
# A person fills the near part of a box: this share of its pixels is no farther.
NEAR_SHARE = 30
HIDDEN, BATCH, RATE = 64, 64, 2e-3
PERSON_M = 1.72
# Signs of x, y, z, pitch, yaw, roll in a mirror.
MIRROR = np.array([1, -1, 1, 1, -1, -1])
METRICS = ["ade_m", "fde_m", "sr_1m", "yaw_mae_deg"]


class Windows:
    """Windows of some splits and roles. Poses are x, y, z (m), pitch, yaw, roll (degrees), world frame."""

    def __init__(self, folder, splits, roles):
        files = [str(file) for split in splits for file in sorted((folder / "data/windows").glob(f"{split}-*.parquet"))]
        table = ds.dataset(files).to_table()
        table = table.filter(np.isin(table["role"].to_numpy(), roles))
        flights = ds.dataset(folder / "data/trajectories").to_table(
            ["trajectory_id", "town", "pedestrian_id", "camera_width_px", "camera_height_px", "camera_focal_px"]
        )
        flights = {row["trajectory_id"]: row for row in flights.to_pylist()}
        lists = lambda name, width: table[name].combine_chunks().flatten().to_numpy().reshape(len(table), -1, width)
        self.table = table
        self.trajectory_id = table["trajectory_id"].to_pylist()
        self.start_frame = table["start_frame"].to_pylist()
        self.current = lists("current_pose_in_world", 6)[:, 0]
        self.deltas = lists("waypoint_deltas_in_world", 6).astype(np.float64)
        # The poses before the current one, from the last step back to the first.
        steps = lists("input_steps_in_world", 6).astype(np.float64)
        self.before = self.current[:, None] - steps[:, ::-1].cumsum(axis=1)[:, ::-1]
        rows = [flights[name] for name in self.trajectory_id]
        self.image_px = np.array([[row["camera_width_px"], row["camera_height_px"]] for row in rows], np.float64)
        self.focal_px = np.array([row["camera_focal_px"] for row in rows])
        self.boxes_px = lists("input_boxes_px", 4).astype(np.float64)
        self.depth_m = None
        self.town = np.array([row["town"] for row in rows])
        walkers = [(row["town"], row["pedestrian_id"]) for row in rows]
        numbers = {walker: number for number, walker in enumerate(dict.fromkeys(walkers))}
        self.walker = np.array([numbers[walker] for walker in walkers], dtype=int)

    def __len__(self):
        return len(self.current)

    def read_depth(self, folder):
        """Distances along the optical axis to what the boxes show, metres, from the depth pictures of the logs; 0 without a box."""
        from mcap.reader import make_reader
        from mcap_protobuf.decoder import DecoderFactory

        paths = ds.dataset(folder / "data/trajectories").to_table(["trajectory_id", "mcap_path"]).to_pylist()
        paths = {row["trajectory_id"]: row["mcap_path"] for row in paths}
        rows = {}
        for row, name in enumerate(self.trajectory_id):
            rows.setdefault(name, []).append(row)
        self.depth_m = np.zeros(self.boxes_px.shape[:2])
        for name, of_flight in rows.items():
            with (folder / paths[name]).open("rb") as file:
                messages = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages("/camera/depth/image")
                for frame, (*_, image) in enumerate(messages):
                    picture = np.frombuffer(image.data, "<f4").reshape(image.height, image.width)
                    for row in of_flight:
                        place = frame - self.start_frame[row]
                        if 0 <= place < self.boxes_px.shape[1]:
                            left, top, right, bottom = self.boxes_px[row, place].astype(int)
                            box = picture[top:bottom, left:right]
                            self.depth_m[row, place] = np.percentile(box, NEAR_SHARE) if box.size else 0

    def mirrored(self):
        """The same windows in a mirrored world."""
        other = copy.copy(self)
        other.current, other.deltas, other.before = self.current * MIRROR, self.deltas * MIRROR, self.before * MIRROR
        left, top, right, bottom = np.moveaxis(self.boxes_px, -1, 0)
        width = self.image_px[:, None, 0]
        other.boxes_px = np.where((right > left)[..., None], np.stack([width - right, top, width - left, bottom], axis=-1), 0)
        return other


def short_way(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


def turned(offset, yaw_deg):
    """Offsets seen along a heading: ahead, right, up."""
    yaw = np.radians(yaw_deg)
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y, z = offset[..., 0], offset[..., 1], offset[..., 2]
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=-1)


def relative(current, poses):
    """Poses seen from the current one: ahead, right, up (m), pitch, yaw, roll (degrees)."""
    difference = poses - current[:, None]
    place = turned(difference[..., :3], current[:, None, 4])
    return np.concatenate([place, short_way(difference[..., 3:])], axis=-1)


def places(windows, sees_poses):
    """Where the boxes show the target: place (ahead, right, up, m), direction, angle of its height, and whether it is seen.

    With poses all are seen from the current pose; without, each from the camera of its own picture.
    """
    low, high = windows.boxes_px[..., :2], windows.boxes_px[..., 2:]
    is_seen = (high > low).all(axis=-1, keepdims=True)
    right, down = np.moveaxis((low + high) / 2 - windows.image_px[:, None] / 2, -1, 0) / windows.focal_px[:, None]
    poses = np.concatenate([windows.before, windows.current[:, None]], axis=1) * sees_poses
    current = poses[:, -1:]
    pitch, yaw = np.radians(poses[..., 3]), np.radians(poses[..., 4])
    ahead, up = np.cos(pitch) + np.sin(pitch) * down, np.sin(pitch) - np.cos(pitch) * down
    ray = np.stack([np.cos(yaw) * ahead - np.sin(yaw) * right, np.sin(yaw) * ahead + np.cos(yaw) * right, up], axis=-1)
    length = np.linalg.norm(ray, axis=-1, keepdims=True)
    ray /= length
    # A person of usual height who stands upright covers this angle.
    angle = np.maximum((high - low)[..., 1:], 1) / windows.focal_px[:, None, None]
    away_m = PERSON_M * np.hypot(ray[..., :1], ray[..., 1:2]) / angle
    away_m = np.clip(away_m if windows.depth_m is None else windows.depth_m[..., None] * length, 2, 80)
    seen_from = lambda offset: np.where(is_seen, turned(offset, current[..., 4]), 0.0)
    place = seen_from(poses[..., :3] + away_m * ray - current[..., :3])
    return place, seen_from(ray), np.where(is_seen, angle, 0.0), is_seen.astype(float)


def features(windows, sees_poses, sees_boxes):
    parts = []
    if sees_poses:
        parts += [relative(windows.current, windows.before).reshape(len(windows), -1), windows.current[:, [3, 5]]]
    if sees_boxes:
        parts += [part.reshape(len(windows), -1) for part in places(windows, sees_poses)]
    return np.concatenate(parts, axis=1)


def outcomes(windows):
    waypoints = windows.current[:, None] + windows.deltas.cumsum(axis=1)
    return relative(windows.current, waypoints).reshape(len(windows), -1)


def as_deltas(found, current):
    """Increments along the world's axes, from waypoint to waypoint, of outcomes."""
    found = found.reshape(len(found), -1, 6)
    place = turned(found[..., :3], -current[:, None, 4])
    reached = np.concatenate([place, found[..., 3:]], axis=-1)
    return np.diff(reached, axis=1, prepend=np.zeros_like(reached[:, :1]))


class Scale:
    """Columns with mean 0 and spread 1; columns that never change become 0."""

    def __init__(self, table):
        self.mean, spread = table.mean(axis=0), table.std(axis=0)
        self.spread = np.where(spread > 1e-9, spread, np.inf)

    def apply(self, table):
        return ((table - self.mean) / self.spread).astype(np.float32)

    def undo(self, table):
        return self.mean + table * np.where(np.isinf(self.spread), 0.0, self.spread)


class Network:
    def __init__(self, seen, learnt, steps, seed):
        draws = np.random.default_rng(seed)
        self.seen, self.learnt = Scale(seen), Scale(learnt)
        sizes = [seen.shape[1], HIDDEN, HIDDEN, learnt.shape[1]]
        gains = [1.4, 1.4, 0.1]
        self.layers = [
            [draws.normal(0, gain / np.sqrt(a), (a, b)).astype(np.float32), np.zeros(b, np.float32)]
            for a, b, gain in zip(sizes, sizes[1:], gains)
        ]
        self.train(self.seen.apply(seen), self.learnt.apply(learnt), steps, draws)

    def forward(self, x):
        activations = [x]
        for number, (weights, constant) in enumerate(self.layers):
            x = x @ weights + constant
            x = np.maximum(x, 0) if number < 2 else x
            activations.append(x)
        return activations

    def train(self, x, y, steps, draws):
        """Adam (Kingma and Ba 2015) on the Huber loss; the rate falls to nothing along half a cosine."""
        means = [[np.zeros_like(part) for part in layer] for layer in self.layers]
        squares = [[np.zeros_like(part) for part in layer] for layer in self.layers]
        for step in range(steps):
            rows = draws.integers(len(x), size=BATCH)
            activations = self.forward(x[rows])
            slope = np.clip(activations[-1] - y[rows], -1, 1) / (BATCH * y.shape[1])
            rate = RATE * 0.5 * (1 + np.cos(np.pi * step / steps))
            for number in (2, 1, 0):
                gradients = [activations[number].T @ slope, slope.sum(axis=0)]
                slope = (slope @ self.layers[number][0].T) * (activations[number] > 0)
                for part, gradient in enumerate(gradients):
                    mean, square = means[number][part], squares[number][part]
                    mean += 0.1 * (gradient - mean)
                    square += 0.001 * (gradient * gradient - square)
                    unbiased = mean / (1 - 0.9 ** (step + 1)), square / (1 - 0.999 ** (step + 1))
                    self.layers[number][part] -= (rate * unbiased[0] / (np.sqrt(unbiased[1]) + 1e-8)).astype(np.float32)

    def deltas(self, x, current):
        """Predicted increments along the world's axes, from waypoint to waypoint."""
        return as_deltas(self.learnt.undo(self.forward(self.seen.apply(x))[-1]), current)


def errors(deltas, windows):
    """The metrics of every window, as `cosfly eval` defines them."""
    apart = deltas.cumsum(axis=1) - windows.deltas.cumsum(axis=1)
    distance = np.linalg.norm(apart[..., :3], axis=-1)
    yaw = np.abs(short_way(apart[..., 4]))
    return np.stack([distance.mean(axis=1), distance[:, -1], distance[:, -1] <= 1.0, yaw.mean(axis=1)], axis=1)


def difference(metric, of, than, walkers, resamples):
    """How much more `of` scores than `than`, and the middle 95 % over resamples of whole walkers."""
    column = METRICS.index(metric)
    more = np.mean([it[:, column] for it in of], axis=0) - np.mean([it[:, column] for it in than], axis=0)
    count = walkers.max() + 1
    sums, windows = np.bincount(walkers, more, count), np.bincount(walkers, minlength=count)
    drawn = np.random.default_rng(1).integers(count, size=(resamples, count))
    means = sums[drawn].sum(axis=1) / windows[drawn].sum(axis=1)
    return more.mean(), *np.percentile(means, [2.5, 97.5])


def write_predictions(path, deltas, windows):
    with path.open("w") as file:
        for name, frame, steps in zip(windows.trajectory_id, windows.start_frame, deltas):
            row = {"trajectory_id": name, "frame": frame, "waypoint_deltas": np.round(steps, 6).tolist()}
            file.write(json.dumps(row) + "\n")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("dataset", type=Path, help="folder of a finished dataset")
    arguments.add_argument("--predictions", type=Path, help="write the first network's predictions for `cosfly eval`")
    arguments.add_argument("--steps", type=tools.counted, default=4000, help="steps of training (default 4000)")
    arguments.add_argument("--depth", action="store_true", help="also read distances from the depth pictures of the logs")
    arguments.add_argument("--seeds", type=tools.counted, default=3, help="networks of each kind (default 3)")
    chosen = arguments.parse_args()
    splits = {file.name.split("-")[0] for file in (chosen.dataset / "data/windows").glob("*.parquet")}
    judged_splits = sorted(splits - {"train"})
    if "train" not in splits or not judged_splits:
        raise SystemExit(f"`{chosen.dataset}` has no windows of split train and of another split")
    judged = Windows(chosen.dataset, judged_splits, [PERTURBED])
    found, first = [], None
    print("| network | windows learnt | ADE, m | FDE, m | SR@1m, % | yaw MAE, degrees |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for name, sees_poses, sees_boxes, roles in KINDS + [WITH_DEPTH] * chosen.depth:
        lessons = Windows(chosen.dataset, ["train"], roles)
        if name == WITH_DEPTH[0]:
            lessons.read_depth(chosen.dataset)
            judged.read_depth(chosen.dataset)
        both = [lessons, lessons.mirrored()]
        seen = np.concatenate([features(part, sees_poses, sees_boxes) for part in both])
        learnt = np.concatenate([outcomes(part) for part in both])
        view = features(judged, sees_poses, sees_boxes)
        of_seeds = []
        for seed in range(chosen.seeds):
            deltas = Network(seen, learnt, chosen.steps, seed).deltas(view, judged.current)
            first = deltas if first is None else first
            of_seeds.append(errors(deltas, judged))
        means = np.array([it.mean(axis=0) for it in of_seeds]) * [1, 1, 100, 1]
        spread = means.std(axis=0, ddof=1) if chosen.seeds > 1 else np.zeros(4)
        cells = [f"{mean:.2f} ± {deviation:.2f}" for mean, deviation in zip(means.mean(axis=0), spread)]
        print(f"| {name} | {len(lessons)} | {' | '.join(cells)} |", flush=True)
        found.append(of_seeds)
    score = lambda kind, metric: np.mean([it[:, METRICS.index(metric)].mean() for it in found[kind]])
    print(f"\n{len(judged)} windows of {judged.walker.max() + 1} walkers judged, splits {', '.join(judged_splits)}.\n")
    value, low, high = difference("fde_m", found[WITHOUT_POSES], found[WITHOUT_BOXES], judged.walker, 1000)
    full, no_poses, no_boxes = (score(kind, "fde_m") for kind in (FULL, WITHOUT_POSES, WITHOUT_BOXES))
    holds = "holds" if low > 0 and no_poses > full else "does NOT hold"
    print(
        f"Pose history is the decisive input: the direction {holds}. FDE grows {no_poses / full:.2f} times without poses "
        f"(the paper: 3.1) and {no_boxes / full:.2f} times without boxes; {value:.2f} m [{low:.2f}, {high:.2f}] between the two."
    )
    value, low, high = difference("fde_m", found[WITHOUT_BOXES], found[FULL], judged.walker, 1000)
    holds = "holds" if low > 0 else "does NOT hold"
    print(f"Boxes add to poses: the direction {holds}. FDE is {value:.2f} m [{low:.2f}, {high:.2f}] larger without them.")
    if chosen.depth:
        value, low, high = difference("fde_m", found[WITHOUT_BOXES], found[-1], judged.walker, 1000)
        holds = "holds" if low > 0 else "does NOT hold"
        print(f"Boxes and depth add to poses: the direction {holds}. FDE is {value:.2f} m [{low:.2f}, {high:.2f}] larger without them.")
    value, low, high = difference("yaw_mae_deg", found[EXPERT_ONLY], found[FULL], judged.walker, 1000)
    holds = "holds" if low > 0 else "does NOT hold"
    ratio = score(EXPERT_ONLY, "yaw_mae_deg") / score(FULL, "yaw_mae_deg")
    print(
        f"Denoising beats learning from experts alone on yaw: the direction {holds}. Yaw MAE is {ratio:.2f} times as large after "
        f"experts alone (the paper: 1.7); {value:.2f} degrees [{low:.2f}, {high:.2f}] between the two."
    )
    if chosen.predictions:
        write_predictions(chosen.predictions, first, judged)
        print(f"\n{chosen.predictions}: predictions of the first network, for `cosfly eval`")


if __name__ == "__main__":
    tools.script(main)
