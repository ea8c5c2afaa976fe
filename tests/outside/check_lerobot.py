"""Reads an export of format lerobot: file by file with pandas and datasets, and with the lerobot package where it is installed.

Usage: `check_lerobot.py DATASET EXPORT CACHE`."""

import importlib.util
import json
import sys
from pathlib import Path

import datasets
import numpy as np
import pandas as pd
from shared import flown, messages, pixels, turned, world_from_body
from shared import rows as rows_of

dataset, export, cache = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
RGB, DEPTH, SENSORS = "observation.images.rgb", "observation.images.depth", "observation.sensors"
QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}
flights, poses, _ = flown(dataset, of_bodies=["kind"])


def state(flight, frame):
    row = poses[flight][frame]
    return np.array([row[f"drone_{name}"] for name in ("x_m", "y_m", "z_m", "pitch_deg", "yaw_deg", "roll_deg")])


def expert(flight, frame):
    """The expert's pose that belongs to a frame of a flight; at the end of the flight, the expert waits."""
    row = poses[flight][min(frame, flights[flight]["frames"] - 1)]
    expert_id = flights[flight]["expert_id"] or flight
    return state(expert_id, row["expert_frame"] if row["expert_frame"] is not None else row["frame"])


def moved(pose, increment):
    """A pose moved along the axes of its own body; angles are differences."""
    return np.concatenate([pose[:3] + world_from_body(*pose[3:]) @ increment[:3], pose[3:] + increment[3:]])


def gap(a, b):
    """Largest difference of two poses, metres and degrees."""
    return max(np.abs(a[:3] - b[:3]).max(), np.abs(turned(a[3:], b[3:])).max())


def as_lerobot_reads(root, info):
    """How version 0.6 of the package opens the frames: its features of `datasets`, 32-bit floats in vectors of fixed lengths."""
    def feature(it):
        if it["dtype"] == "image":
            return datasets.Image()
        value = datasets.Value(it["dtype"])
        return value if it["shape"] == [1] else datasets.Sequence(length=it["shape"][0], feature=value)

    features = datasets.Features({name: feature(it) for name, it in info["features"].items()})
    paths = sorted(map(str, root.glob("data/*/*.parquet")))
    return datasets.Dataset.from_parquet(paths, features=features, cache_dir=cache)


def statistics(values):
    wanted = {"mean": values.mean(0), "std": values.std(0), "min": values.min(0), "max": values.max(0)}
    return wanted | {key: np.quantile(values, share, axis=0) for key, share in QUANTILES.items()}


def check(split):
    root = export / split
    info = json.loads((root / "meta/info.json").read_text())
    assert info["codebase_version"] == "v3.0" and isinstance(info["fps"], int)
    tasks = pd.read_parquet(root / "meta/tasks.parquet")
    assert tasks.index.name == "task" and list(tasks.columns) == ["task_index"] and len(tasks) == info["total_tasks"]
    episodes = pd.concat(map(pd.read_parquet, sorted(root.glob("meta/episodes/*/*.parquet"))))
    assert len(episodes) == info["total_episodes"] and episodes["length"].sum() == info["total_frames"]
    assert info["splits"] == {split: f"0:{len(episodes)}"} and set(episodes["split"]) == {split}
    assert all(flights[flight]["split"] == split for flight in episodes["trajectory_id"])
    inputs = sorted(name for name in info["features"] if name.startswith("observation") and name != SENSORS)
    assert inputs in ([RGB, "observation.state"], [DEPTH, RGB, "observation.state"]), "policies take these as inputs"

    rows = datasets.load_dataset("parquet", data_files=str(root / "data/*/*.parquet"), split="train", cache_dir=cache)
    typed = as_lerobot_reads(root, info)
    assert len(typed) == len(rows) and np.abs(np.array(typed["action"]) - np.array(rows["action"])).max() < 1e-4
    assert len(rows) == info["total_frames"] and rows["index"][:] == list(range(len(rows)))
    for row in rows:
        episode = episodes.iloc[row["episode_index"]]
        flight, frame = episode["trajectory_id"], row["frame_index"]
        assert episode["dataset_from_index"] + frame == row["index"] and abs(row["timestamp"] * info["fps"] - frame) < 1e-5
        assert row[RGB].size == tuple(info["features"][RGB]["shape"][1::-1])
        own, seen = state(flight, frame), np.array(row["observation.state"])
        assert np.abs(own - row["privileged.pose"]).max() < 1e-9 and np.abs(seen[6:] - own[[3, 5]]).max() < 1e-9
        step = np.concatenate([world_from_body(*own[3:]) @ seen[:3], seen[3:6]])
        assert gap(state(flight, max(frame - 1, 0)) + step, own) < 1e-9
        # The sum of the first k increments leads from the own pose to the expert's, k frames later.
        sums = np.cumsum(np.array(row["action"]).reshape(5, 6), axis=0)
        for ahead, increment in enumerate(sums, 1):
            assert gap(moved(own, increment), expert(flight, frame + ahead)) < 1e-6, (flight, frame, ahead)

    stats = json.loads((root / "meta/stats.json").read_text())
    assert set(stats) == set(info["features"])
    for name in ("observation.state", "action", "privileged.target"):
        wanted = statistics(np.array(rows[name]))
        assert stats[name]["count"] == [len(rows)] and set(stats[name]) == {*wanted, "count"}
        for key, want in wanted.items():
            assert np.abs(np.array(stats[name][key]) - want).max() < 1e-6, (name, key)
    for key in ("min", "max", "mean", "std", *QUANTILES):
        assert np.array(stats[RGB][key]).shape == (3, 1, 1)
    check_episodes(episodes, info, rows, stats)
    if SENSORS in info["features"]:
        check_sensors(info, rows, episodes)
    if DEPTH in inputs:
        check_depth(info, rows, episodes, stats[DEPTH])
    print(f"lerobot, {split}, file by file: {len(rows)} frames of {len(episodes)} episodes, {len(tasks)} tasks")
    return info, tasks


def check_sensors(info, rows, episodes):
    """The last reading of each sensor at the time of each frame, without the true numbers."""
    names, found = info["features"][SENSORS]["names"], np.array(rows[SENSORS], np.float32)
    assert found.shape[1] == len(names) and not any(".true_" in name for name in names)
    for sensor in {name.split(".")[0] for name in names}:
        own = [number for number, name in enumerate(names) if name.split(".")[0] == sensor]
        columns = [names[number].split(".", 1)[1] for number in own]
        readings = pd.DataFrame(rows_of(dataset, sensor)).sort_values(["trajectory_id", "row"])
        for _, episode in episodes.iterrows():
            flight = episode["trajectory_id"]
            of_flight = readings[readings["trajectory_id"] == flight]
            for frame in range(episode["length"]):
                last = of_flight[of_flight["time_s"] <= poses[flight][frame]["time_s"] + 1e-9].iloc[-1]
                wanted = np.float32(last[columns].astype(float))
                assert np.array_equal(found[episode["dataset_from_index"] + frame][own], wanted, equal_nan=True), (sensor, flight, frame)
    print(f"lerobot, {len(names)} numbers of sensors of {len(found)} frames are the last ones of the tables")


def depths(flight):
    """Depth of all frames of a flight, from its log."""
    return np.stack([pixels(image) for _, image, _, _ in messages(dataset / flights[flight]["mcap_path"], ["/camera/depth/image"])])


def check_depth(info, rows, episodes, stats):
    """Every pixel is that of the log, up to a greatest depth, which the sky has; statistics to a millimetre."""
    assert info["features"][DEPTH]["info"] == {"is_depth_map": True, "depth_unit": "m"}
    sampled, most = [], max(np.array(row[DEPTH]).max() for row in rows)
    for _, episode in episodes.iterrows():
        logged = np.minimum(depths(episode["trajectory_id"]), most)
        own = rows.select(range(episode["dataset_from_index"], episode["dataset_to_index"]))
        for row, wanted in zip(own, logged, strict=True):
            assert row[DEPTH].mode == "F" and (np.array(row[DEPTH]) == wanted).all(), (episode["trajectory_id"], row["frame_index"])
        step = min(max(len(logged) // 10, 1), 10)
        sampled.append(np.concatenate([it.ravel()[::16] for it in logged[::step]]).astype(float))
        for key, want in statistics(sampled[-1]).items():
            assert abs(nested(episode[f"stats/{DEPTH}/{key}"]).item() - want) < 1e-3, key
    for key, want in statistics(np.concatenate(sampled)).items():
        assert abs(np.array(stats[key]).item() - want) < 1e-3, key
    print(f"lerobot, depth of {len(rows)} frames is that of the logs, up to {most} m")


def check_episodes(table, info, rows, stats):
    """Statistics of each episode: those of its rows, and together those of the dataset, as LeRobot puts them together."""
    keys = ["min", "max", "mean", "std", *QUANTILES, "count"]
    wanted = {f"stats/{name}/{key}" for name in info["features"] for key in keys}
    assert {name for name in table.columns if name.startswith("stats/")} == wanted
    numbers = np.array(rows["episode_index"])
    for name, feature in info["features"].items():
        shape = (feature["shape"][2], 1, 1) if name.startswith("observation.images") else tuple(feature["shape"])
        parts = {key: np.stack(list(map(nested, table[f"stats/{name}/{key}"]))) for key in keys}
        assert all(parts[key].shape == (len(table), *shape) for key in keys[:-1]), name
        if name in ("observation.state", "action", "privileged.box", "timestamp", "index"):
            for at, episode in enumerate(table["episode_index"]):
                values = np.array(rows[name])[numbers == episode]
                for key, it in (statistics(values.reshape(len(values), -1)) | {"count": [len(values)]}).items():
                    assert np.abs(parts[key][at] - it).max() < 1e-5, (name, key)
        weights = parts["count"].reshape(-1, *[1] * len(shape)) / parts["count"].sum()
        mean = (parts["mean"] * weights).sum(0)
        variance = ((parts["std"] ** 2 + (parts["mean"] - mean) ** 2) * weights).sum(0)
        together = {"mean": mean, "std": np.sqrt(variance), "min": parts["min"].min(0), "max": parts["max"].max(0), "count": parts["count"].sum(0)}
        for key, it in together.items():
            assert np.abs(np.array(stats[name][key]) - it).max() < 1e-5 * max(1, np.abs(it).max()), (name, key)


def nested(value):
    """A cell of lists of lists as one array."""
    return np.array([nested(it) for it in value] if getattr(value, "dtype", None) == object else value)


def load_depth(split, loaded, info):
    """Depth as the package gives it: metres, from 0.6 on millimetres unless it is asked for metres; 12-bit video by its own tool."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    flight, stats = loaded.meta.episodes[0]["trajectory_id"], json.loads((export / split / "meta/stats.json").read_text())
    wanted = np.minimum(depths(flight)[6], stats[DEPTH]["max"][0][0][0])
    knows_depth = hasattr(loaded.meta, "depth_keys")
    for unit, per_m in ([("m", 1), ("mm", 1000)] if knows_depth else [(None, 1)]):
        loaded = LeRobotDataset(f"cosfly/{split}", root=export / split, **({"depth_output_unit": unit} if unit else {}))
        found, mean = loaded[6][DEPTH], loaded.meta.stats[DEPTH]["mean"].item()
        assert str(found.dtype) == "torch.float32" and found.shape[0] == 1
        assert np.abs(found.numpy()[0] / per_m - wanted).max() < 1e-4, unit
        assert abs(mean / per_m - stats[DEPTH]["mean"][0][0][0]) < 1e-6, unit
    if knows_depth:
        assert loaded.meta.depth_keys == [DEPTH]
        from lerobot.configs import DepthEncoderConfig
        from lerobot.datasets.dataset_tools import convert_image_to_video_dataset

        film = Path(cache) / f"lerobot-film-{split}"
        convert_image_to_video_dataset(loaded, film, f"cosfly/{split}-film", depth_encoder=DepthEncoderConfig(depth_min=0.5, depth_max=float(wanted.max())))
        filmed = LeRobotDataset(f"cosfly/{split}-film", root=film, depth_output_unit="m")[6][DEPTH].numpy()[0]
        assert (np.abs(filmed - wanted) / wanted).max() < 2e-3
    print(f"lerobot, {split}: depth in {'metres, millimetres and 12-bit video' if knows_depth else 'metres'}")


def load(split, info, tasks):
    """The package itself: windows of five pictures, and chunks."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    loaded = LeRobotDataset(f"cosfly/{split}", root=export / split, delta_timestamps={RGB: [step / info["fps"] for step in range(-4, 1)]})
    assert loaded.num_frames == info["total_frames"] and loaded.num_episodes == info["total_episodes"]
    item = loaded[6]
    height, width, _ = info["features"][RGB]["shape"]
    assert tuple(item[RGB].shape) == (5, 3, height, width), item[RGB].shape
    assert tuple(item["action"].shape) == (30,) and str(item["action"].dtype) == "torch.float32"
    assert item["task"] in tasks.index, item["task"]
    assert {"q01", "q99"} <= set(loaded.meta.stats["action"])
    if DEPTH in info["features"]:
        load_depth(split, loaded, info)
    # LeRobot's own tool writes a part of the dataset, with true statistics; that of 0.4 takes all pictures for colours.
    if loaded.num_episodes > 1 and (DEPTH not in info["features"] or hasattr(loaded.meta, "depth_keys")):
        from lerobot.datasets.dataset_tools import delete_episodes

        part = delete_episodes(loaded, [0], output_dir=Path(cache) / f"lerobot-part-{split}", repo_id=f"cosfly/{split}-part")
        assert set(part.meta.stats) == set(info["features"]), set(part.meta.stats)
        left = part.num_frames
        assert left < info["total_frames"] and part.meta.stats["action"]["count"].tolist() == [left]
    print(f"lerobot, {split}, with the package: windows of {tuple(item['observation.images.rgb'].shape)}, task {item['task']!r}")


splits = sorted(path.name for path in export.iterdir() if path.is_dir())
assert splits == sorted({flight["split"] for flight in flights.values()})
checked = {split: check(split) for split in splits}
if importlib.util.find_spec("lerobot") is None:
    print("skipped: the package lerobot is not installed")
    sys.exit()
for split, (info, tasks) in checked.items():
    load(split, info, tasks)
