"""Times `cosfly eval` on a million predictions for a made-up dataset that has just the columns that it reads.

    venv/bin/python tests/outside/million_predictions.py target/release/cosfly [--windows N] [--parquet] [--folder DIR]

Prints wall time, CPU time and the largest memory of the command, and how many rows it scored.
"""

import argparse
import json
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

FRAMES, STRIDE, SIZE = 200, 3, 10
WINDOWS = (FRAMES - SIZE) // STRIDE + 1


def walk(rng, flights):
    """Poses of experts: smooth random motion."""
    speed = np.cumsum(rng.normal(0, 0.15, (flights, FRAMES, 3)), axis=1) * [1, 1, 0.1]
    position = np.cumsum(speed * 0.5, axis=1) + [0, 0, 30]
    yaw = np.cumsum(rng.normal(0, 2, (flights, FRAMES)), axis=1)
    return position, yaw


def write_dataset(folder, rng, flights):
    position, yaw = walk(rng, flights)
    seen = position + rng.normal(0, 1, position.shape)
    ids = [f"{role}-p{number:06}" for role in ("expert", "perturbed") for number in range(flights)]
    pedestrians = [f"p{number:06}" for number in range(flights)] * 2
    rows, half = 2 * flights, flights
    constant = lambda value: pa.array([value] * rows)
    trajectories = pa.table({
        "trajectory_id": ids, "expert_id": pa.array([None] * half + ids[:half], pa.string()), "pedestrian_id": pedestrians,
        "town": constant("made-up"), "town_geometry_blake3": constant("0" * 64),
        "town_offset_m": pa.FixedSizeListArray.from_arrays(pa.array(np.zeros(3 * rows)), 3),
        "weather_preset": constant("ClearNoon"), "frames": pa.array([FRAMES] * rows, pa.int64()), "dt_s": constant(0.5),
        "camera_width_px": pa.array([1280] * rows, pa.int64()), "camera_height_px": pa.array([720] * rows, pa.int64()),
        "camera_fov_deg": constant(90.0), "target_height_m": constant(1.7), "target_radius_m": constant(0.3),
        "mcap_path": constant("mcap/none.mcap"),
    })
    places = np.concatenate([position, seen]).reshape(-1, 3)
    turns = np.concatenate([yaw, yaw + rng.normal(0, 2, yaw.shape)]).reshape(-1)
    count = rows * FRAMES
    feet = np.concatenate([position, position]).reshape(-1, 3) - [20, 0, 25]
    own = np.tile(np.arange(FRAMES), rows)
    boxes = pa.FixedSizeListArray.from_arrays(pa.array(np.tile([600, 300, 640, 400], count).astype(np.float32)), 4)
    frames = pa.table({
        "trajectory_id": pa.array(ids).take(pa.array(np.repeat(np.arange(rows), FRAMES))), "frame": pa.array(own, pa.int64()),
        **{f"drone_{axis}_m": places[:, k] for k, axis in enumerate("xyz")},
        "drone_pitch_deg": np.full(count, -45.0), "drone_yaw_deg": turns, "drone_roll_deg": np.zeros(count),
        **{f"target_{axis}_m": feet[:, k] for k, axis in enumerate("xyz")},
        "target_heading_deg": turns, "visible_by_rays": rng.random(count) * 0.6 + 0.4, "visible_box_px": boxes,
        "expert_frame": pa.array(own, pa.int64()),
    })
    # A tenth of the flights is there to learn from.
    order = np.arange(rows) % half < half // 10
    for split, wanted in [("train", order), ("test", ~order)]:
        for name, table, mask in [("trajectories", trajectories, wanted), ("frames", frames, np.repeat(wanted, FRAMES))]:
            path = folder / "data" / name / f"{split}-00000-of-00001.parquet"
            path.parent.mkdir(parents=True, exist_ok=True)
            pq.write_table(table.filter(pa.array(mask)), path)
    return ids[half:], position, seen, yaw


def predictions(rng, flights, position, seen, yaw, limit):
    """(trajectory, frame, increments): the truth with noise."""
    made = 0
    for number in range(len(flights) // 10, len(flights)):
        for start in range(0, FRAMES - SIZE + 1, STRIDE):
            if made == limit:
                return
            path = np.concatenate([seen[number, start + 4 : start + 5], position[number, start + 5 : start + 10]])
            deltas = np.zeros((5, 6))
            deltas[:, :3] = np.diff(path, axis=0)
            deltas[:, 4] = np.diff(yaw[number, start + 4 : start + 10])
            yield flights[number], start, np.round(deltas + rng.normal(0, 0.1, (5, 6)), 4)
            made += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--windows", type=int, default=1_000_000)
    parser.add_argument("--parquet", action="store_true", help="predictions as Parquet instead of JSON lines")
    parser.add_argument("--folder", type=Path, help="where to make the files; a scratch folder unless given")
    arguments = parser.parse_args()
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.folder or Path(scratch)
        flights = -(-arguments.windows // WINDOWS) * 10 // 9 + 10
        made = predictions(rng, *write_dataset(folder, rng, flights), arguments.windows)
        if arguments.parquet:
            path, rows = folder / "predictions.parquet", list(made)
            pq.write_table(pa.table({"trajectory_id": [r[0] for r in rows], "frame": [r[1] for r in rows], "waypoint_deltas": [r[2].tolist() for r in rows]}), path)
        else:
            path = folder / "predictions.jsonl"
            with path.open("w") as file:
                for name, start, deltas in made:
                    file.write(f'{{"trajectory_id": "{name}", "frame": {start}, "waypoint_deltas": {json.dumps(deltas.tolist())}}}\n')
        command = [arguments.binary, "eval", str(folder), str(path), "--out", str(folder / "scores")]
        began = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True)
        wall, used = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1):  # 1: some windows have no prediction
            raise SystemExit(f"million_predictions: exit code {done.returncode}\n{done.stderr}")
        report = json.loads((folder / "scores" / "report.json").read_text())
        print(
            f"{report['rows']['scored']} predictions of {path.stat().st_size / 1e6:.0f} MB scored beside {len(report['methods']) - 1} baselines: "
            f"{wall:.1f} s wall, {used.ru_utime + used.ru_stime:.1f} s CPU, {used.ru_maxrss / 1e6:.2f} GB"
        )


if __name__ == "__main__":
    main()
