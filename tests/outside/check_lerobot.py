"""Reads an export of format lerobot: file by file with pandas and datasets, and with the lerobot package where it is installed.

python check_lerobot.py DATASET EXPORT CACHE
"""

import glob
import json
import sys
from pathlib import Path

import datasets
import numpy as np
import pandas as pd
import pyarrow.parquet as parquet

dataset, root, cache = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
info = json.loads((root / "meta/info.json").read_text())
assert info["codebase_version"] == "v3.0" and isinstance(info["fps"], int)
tasks = pd.read_parquet(root / "meta/tasks.parquet")
assert tasks.index.name == "task" and list(tasks.columns) == ["task_index"] and len(tasks) == info["total_tasks"]
episodes = pd.concat(pd.read_parquet(path) for path in sorted(glob.glob(str(root / "meta/episodes/*/*.parquet"))))
assert len(episodes) == info["total_episodes"] and episodes["length"].sum() == info["total_frames"]
assert sorted(info["splits"]) == sorted(set(episodes["split"]))
for split, span in info["splits"].items():
    first, end = map(int, span.split(":"))
    assert set(episodes["split"].iloc[first:end]) == {split}

rows = datasets.load_dataset("parquet", data_files=str(root / "data/*/*.parquet"), split="train", cache_dir=cache)
assert len(rows) == info["total_frames"] and rows["index"][:] == list(range(len(rows)))
poses = {}
for path in glob.glob(str(dataset / "data/frames/*.parquet")):
    for row in parquet.read_table(path).drop(["preview"]).to_pylist():
        poses[row["trajectory_id"], row["frame"]] = row
experts = {
    row["trajectory_id"]: row["expert_id"] or row["trajectory_id"]
    for path in glob.glob(str(dataset / "data/trajectories/*.parquet"))
    for row in parquet.read_table(path).to_pylist()
}


def state(flight, frame):
    row = poses[flight, frame]
    return np.array([row[f"drone_{name}"] for name in ("x_m", "y_m", "z_m", "pitch_deg", "yaw_deg", "roll_deg")])


stats = json.loads((root / "meta/stats.json").read_text())
for row in rows:
    episode = episodes.iloc[row["episode_index"]]
    flight, frame = episode["trajectory_id"], row["frame_index"]
    assert episode["dataset_from_index"] + frame == row["index"] and abs(row["timestamp"] * info["fps"] - frame) < 1e-5
    assert row["observation.images.rgb"].size == tuple(info["features"]["observation.images.rgb"]["shape"][1::-1])
    assert np.abs(state(flight, frame) - row["observation.state"]).max() < 1e-9
    if frame + 1 < episode["length"]:
        gap = state(flight, frame) + row["action"] - state(experts[flight], frame + 1)
        assert np.abs(gap[:3]).max() < 1e-9 and np.abs((gap[3:] + 180) % 360 - 180).max() < 1e-9
    else:
        assert not any(row["action"])
for name in ("observation.state", "action"):
    values = np.array(rows[name])
    for key, want in (("mean", values.mean(0)), ("std", values.std(0)), ("min", values.min(0)), ("max", values.max(0))):
        assert np.abs(np.array(stats[name][key]) - want).max() < 1e-6, (name, key)
print(f"lerobot, file by file: {len(rows)} frames of {len(episodes)} episodes, {len(tasks)} tasks")

try:
    from lerobot.datasets.lerobot_dataset import LeRobotDataset
except ImportError:
    print("skipped: the package lerobot is not installed")
    sys.exit()
steps = [step / info["fps"] for step in range(-4, 6)]
loaded = LeRobotDataset(
    "cosfly/export", root=root, delta_timestamps={"observation.images.rgb": steps[:5], "action": steps[5:]}
)
assert loaded.num_frames == info["total_frames"] and loaded.num_episodes == info["total_episodes"]
item = loaded[6]
height, width, _ = info["features"]["observation.images.rgb"]["shape"]
assert tuple(item["observation.images.rgb"].shape) == (5, 3, height, width), item["observation.images.rgb"].shape
assert tuple(item["action"].shape) == (5, 6) and str(item["action"].dtype) == "torch.float32"
assert item["task"] in tasks.index, item["task"]
print(f"lerobot, with the package: windows of {tuple(item['observation.images.rgb'].shape)}, task {item['task']!r}")
