"""Reads an export of format v7 with other people's software and holds it to every rule that is known of the release.

Usage: `check_v7.py EXPORT`."""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from PIL import Image
from shared import world_from_body


def numbers_of(point):
    return [float(point["drone_pose"][key]) for key in ("x", "y", "z", "pitch", "yaw", "roll")]


def by_points(document, _):
    """As readers do that look for `points` and `trace_timestamp`, and refuse gaps: times and places of the drone."""
    points = document["points"]
    assert [point["index"] for point in points] == list(range(len(points)))
    return [float(point["timing"]["trace_timestamp"]) for point in points], [numbers_of(point) for point in points]


def by_waypoints(document, folder):
    """As readers do that look for `waypoints` and `timing.timestamp`, and make velocities of them."""
    times, poses = [it["timing"]["timestamp"] for it in document["waypoints"]], list(map(numbers_of, document["waypoints"]))
    assert all((folder / f"frames_playback/frame_{it['index']:05d}/rgb.png").is_file() for it in document["waypoints"])
    velocities = np.diff(poses, axis=0) / np.diff(times)[:, None]
    assert np.isfinite(velocities).all() and (np.linalg.norm(velocities[:, :3], axis=1) < 60).all()
    return times, poses


TOWN = re.compile(r"(Town0[1-7]|Town10HD)(_Opt)?")
root = Path(sys.argv[1]) / "data_v7"
groups = defaultdict(set)
pairs = frames = seen = debugs = 0
for folder in sorted(root.glob("Town*/trajectory_*")):
    pairs += 1
    town = folder.parent.name
    assert TOWN.fullmatch(town), town
    assert re.fullmatch(r"trajectory_\d{10}", folder.name), folder
    documents = {}
    for trace in ("ORI", "aug_001"):
        documents[trace] = document = json.loads((folder / trace / "trajectory.json").read_text())
        report = json.loads((folder / trace / "perturbation_report.json").read_text())
        assert document["schema"] == "drone_nav_traj_v7" and document["schema_version"] == "7.0.0"
        assert document["trace_dir"] == trace and report["trace_dir"] == trace
        camera, points = document["camera"], document["points"]
        width, height = camera["width"], camera["height"]
        K = np.array(camera["intrinsic"], float)
        assert K.shape == (3, 3) and np.isfinite(K).all() and K[0, 0] == K[1, 1] == camera["focal_length_px"]
        assert points and report["num_points"] == len(points)
        times, _ = read = by_points(document, folder / trace)
        assert read == by_waypoints(document, folder / trace) and len(times) == len(points) and min(times) > -1 and (np.diff(times) > 0).all()
        for point, waypoint in zip(points, document["waypoints"], strict=True):
            assert waypoint["drone_pose"] == point["drone_pose"] and waypoint["timing"] == point["timing"]
            assert waypoint["timing"]["timestamp"] == point["timing"]["trace_timestamp"]
        for i, point in enumerate(points):
            frames += 1
            assert np.isfinite(numbers_of(point)).all()
            waypoint = point["nav_waypoint"]["t1_world"]
            if i + 1 < len(points):
                following = points[i + 1]["drone_pose"]
                assert max(abs(waypoint[axis] - following[axis]) for axis in "xyz") <= 1e-5
            else:
                assert waypoint is None
            assert point["is_perturbed"] == (trace != "ORI" and any(point["perturbation"][k] for k in ("drone_position", "drone_rotation")))
            here = folder / trace / "frames_playback" / f"frame_{i:05d}"
            with Image.open(here / "rgb.png") as image:
                image.load()
                assert image.size == (width, height) and image.mode == "RGB"
            depth = np.load(here / "depth.npy", allow_pickle=False)
            assert depth.dtype == np.float32 and depth.shape == (height, width)
            assert np.isfinite(depth).all() and depth.min() >= 0 and depth.max() <= 1000
            instance = np.asarray(Image.open(here / "instance.png")).astype(int)
            assert instance.shape == (height, width, 3) and instance[..., 0].max() <= 28
            ids = instance[..., 1] + 256 * instance[..., 2]
            if (here / "debug.png").exists():  # not in exports with `--no-debug`
                assert Image.open(here / "debug.png").size == (width, height)
                debugs += 1
            # The target: id 1 has CARLA's label for people, lies in its box, at its depth, and where its middle projects to.
            target = point["target"]
            rows, columns = np.nonzero(ids == 1)
            assert target["visible"] == (len(rows) > 0), (here, len(rows))
            if len(rows):
                assert set(instance[rows, columns, 0]) == {12}
                box = target["bbox_2d"]
                edges = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
                assert [box[key] for key in ("xmin", "ymin", "xmax", "ymax")] == edges
                assert abs(np.median(depth[rows, columns]) - target["depth"]) < 1.5
                seen += 1
            camera_pose = point["cosfly"]["camera_pose"]
            away = [target["world_location"][axis] - camera_pose[axis] for axis in "xyz"]
            ahead, right, up = world_from_body(*(camera_pose[key] for key in ("pitch", "yaw", "roll"))).T @ away
            assert abs(ahead - target["depth"]) < 1e-6
            if target["image_uv"] is not None:
                u, v, one = K @ np.array([right / ahead, -up / ahead, 1.0])
                assert abs(u - target["image_uv"][0]) < 1e-6 and abs(v - target["image_uv"][1]) < 1e-6
    ori, aug = documents["ORI"], documents["aug_001"]
    assert len(ori["points"]) == len(aug["points"])
    source = tuple(ori["source"][key] for key in ("path_index", "scenario_id", "scenario_name"))
    assert source == tuple(aug["source"][key] for key in ("path_index", "scenario_id", "scenario_name"))
    groups[(town.removesuffix("_Opt"), *source)].add(ori["cosfly"]["split"])
assert pairs and seen, "nothing was found"
assert debugs in (0, frames), "some frames alone have `debug.png`"
assert all(len(splits) == 1 for splits in groups.values()), "a scenario straddles a split"
print(f"v7: {pairs} pairs, {frames} frames, the target seen in {seen}: every rule holds")
