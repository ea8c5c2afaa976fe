"""The same flights through the same class: cosfly's own layout, the published v7, LeRobot."""

import io
import json
import shutil

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from PIL import Image

import cosfly


@pytest.fixture(scope="module")
def exports(folder):
    """Exports of the dataset, by format."""
    for name in ("v7", "lerobot"):
        cosfly.export("data", name, f"exports/{name}", progress=False)
    return {name: f"exports/{name}" for name in ("v7", "lerobot")}


def same_flight(ours, theirs):
    """Pairs of ids: flights with a pose that no other has."""
    places, columns = {}, ("drone_x_m", "drone_y_m", "drone_z_m", "drone_yaw_deg")
    for dataset, key in ((ours, 0), (theirs, 1)):
        table = dataset.table("frames")
        values = [table["trajectory_id"], table["frame"], *(table[name] for name in columns)]
        for name, frame, *pose in zip(*values):
            if frame in (0, 7, 14, 21):
                places.setdefault((int(frame), *(round(float(it), 1) + 0.0 for it in pose)), {})[key] = name
    pairs = {it[0]: it[1] for it in places.values() if len(it) == 2}  # a twin that shares a pose has others alone
    assert len(pairs) == len(theirs.trajectory_ids) > 2
    return pairs


@pytest.mark.parametrize("name,channels", [("v7", ("rgb", "depth", "semantic", "instance")), ("lerobot", ("rgb",))])
def test_frames_are_those_of_the_dataset(exports, name, channels):
    columns = ("drone_x_m", "drone_y_m", "drone_yaw_deg", "target_x_m", "target_z_m", "action_in_world", "visible_box_px")
    ours = cosfly.Dataset("data", channels=channels, columns=columns)
    theirs = cosfly.Dataset(exports[name], channels=channels, columns=columns)
    pairs, places = same_flight(ours, theirs), {key: place for place, key in enumerate(ours._index)}
    other = {key: place for place, key in enumerate(theirs._index)}
    for mine, its in pairs.items():
        assert theirs.channels_of(its) == list(channels)
        for frame in (0, 5):
            a, b = ours[places[mine, frame]], theirs[other[its, frame]]
            for channel in channels:
                assert np.array_equal(a[channel], b[channel]), (name, channel)
            for column in columns:
                if a[column] is not None and np.size(a[column]):
                    assert np.allclose(a[column], b[column], atol=2e-3), (name, column, a[column], b[column])
        small = [it.frame(key, 3, channels=("rgb",), size=(40, 24))["rgb"] for it, key in ((ours, mine), (theirs, its))]
        assert small[0].shape == small[1].shape == (24, 40, 3)


@pytest.mark.parametrize("name", ["v7", "lerobot"])
def test_windows_are_cut_as_the_dataset_cuts_them(exports, name):
    ours = cosfly.Dataset("data", channels=("rgb",), size=(40, 24), captions="en").windows()
    theirs = cosfly.Dataset(exports[name], channels=("rgb",), size=(40, 24), captions="en").windows()
    pairs = same_flight(ours, theirs)
    known = {(pairs.get(mine), start): place for place, (mine, start) in enumerate(ours._index)}
    assert len(theirs) == sum(key[0] is not None for key in known) > 10
    for place in range(0, len(theirs), 3):
        b = theirs[place]
        a = ours[known[b["trajectory_id"], b["start_frame"]]]
        assert a["role"] == b["role"] and b["captions"] and b["rgb"].shape == a["rgb"].shape
        for column in ("input_steps_in_world", "correction_in_body", "waypoint_deltas_in_body", "waypoint_deltas_in_world", "input_boxes_px"):
            assert np.allclose(a[column], b[column], atol=5e-3), (name, column, place)
    batch = next(iter(theirs.loader(4, seed=1)))
    assert batch["rgb"].shape == (4, 5, 24, 40, 3)


def test_splits_and_tables_are_those_of_the_layout(exports):
    splits = {name: {split: len(cosfly.Dataset(path, split=split)) for split in ("train", "val")} for name, path in
              {"ours": "data", **exports}.items()}  # fmt: skip
    assert splits["lerobot"] == splits["ours"]
    v7 = cosfly.Dataset(exports["v7"])
    assert pa.table(v7.table("trajectories")).num_rows == len(v7.trajectory_ids) and v7.table("trajectories").files == []
    with pytest.raises(cosfly.Error, match="objects") as caught:
        v7.table("objects")
    assert caught.value.code == "dataset-none" and "frames" in caught.value.hints[0]


def test_what_a_layout_does_not_hold_is_an_error(exports, tmp_path):
    with pytest.raises(cosfly.Error, match="depth") as caught:
        cosfly.Dataset(exports["lerobot"])[0]
    assert caught.value.code == "dataset-channel" and "rgb" in caught.value.hints[0]
    shutil.copytree(exports["lerobot"] + "/train", tmp_path / "one")
    assert len(cosfly.Dataset(tmp_path / "one", channels=("rgb",))) > 0
    info = json.loads((tmp_path / "one/meta/info.json").read_text())
    (tmp_path / "one/meta/info.json").write_text(json.dumps({**info, "total_frames": 3}))
    with pytest.raises(cosfly.Error, match="total_frames") as caught:
        cosfly.Dataset(tmp_path / "one", channels=("rgb",))
    assert caught.value.code == "dataset-damaged"
    info["splits"] = {}
    (tmp_path / "one/meta/info.json").write_text(json.dumps(info))
    with pytest.raises(ValueError, match="no splits"):
        cosfly.Dataset(tmp_path / "one", split="val", channels=("rgb",))
    data = next((tmp_path / "one/data").rglob("*.parquet"))
    dataset = cosfly.Dataset(tmp_path / "one", channels=("rgb",))
    data.write_bytes(data.read_bytes()[:5000])
    with pytest.raises(cosfly.Error, match="parquet"):
        list(dataset)
    data.write_bytes(b"")
    with pytest.raises(cosfly.Error, match="damaged"):
        cosfly.Dataset(tmp_path / "one", channels=("rgb",))


def lerobot_of_others(folder, features, rows, version="v3.0", tasks=("follow the person", "跟着行人")):
    """A dataset as other tools write it, with pyarrow."""
    info = {
        "codebase_version": version, "fps": 10, "total_episodes": 2, "total_frames": 12, "total_tasks": len(tasks),
        "splits": {"train": "0:1", "val": "1:2"}, "features": features,
    }  # fmt: skip
    (folder / "meta").mkdir(parents=True)
    (folder / "meta/info.json").write_text(json.dumps(info))
    (folder / "meta/tasks.jsonl").write_text("".join(json.dumps({"task_index": i, "task": it}, ensure_ascii=False) + "\n" for i, it in enumerate(tasks)))
    base = {
        "episode_index": [0] * 6 + [1] * 6, "frame_index": list(range(6)) * 2, "index": list(range(12)),
        "timestamp": [0.1 * it for it in list(range(6)) * 2], "task_index": [0] * 6 + [1] * 6,
    }  # fmt: skip
    for number in range(2):
        part = {name: values[6 * number :][:6] for name, values in {**base, **rows}.items()}
        (folder / "data/chunk-000").mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.table(part), folder / f"data/chunk-000/episode_{number:06}.parquet")
    return folder


def test_lerobot_data_of_others(tmp_path):
    rng = np.random.default_rng(3)
    pixels = [rng.integers(0, 255, (20, 30, 3), np.uint8) for _ in range(12)]

    def png(image):
        file = io.BytesIO()
        Image.fromarray(image).save(file, "PNG")
        return file.getvalue()

    state = [[0.3 * it, 0.1 * it, 5.0, 0.01 * it] for it in range(12)]
    features = {
        "observation.images.front": {"dtype": "image", "shape": [3, 20, 30], "names": ["channels", "height", "width"]},
        "observation.state": {"dtype": "float32", "shape": [4], "names": ["x", "y", "z", "yaw"]},
    }
    stored = {"observation.images.front": [{"bytes": png(it), "path": None} for it in pixels], "observation.state": state}
    dataset = cosfly.Dataset(lerobot_of_others(tmp_path / "stored", features, stored, "v2.1"), channels=("rgb",), columns=("drone_x_m",), captions="zh")
    assert len(dataset) == 12 and np.array_equal(dataset[7]["rgb"], pixels[7]) and list(dataset[7]["captions"].values()) == ["跟着行人"]
    assert np.isclose(dataset[7]["drone_x_m"], 2.1, atol=1e-6) and len(cosfly.Dataset(tmp_path / "stored", split="val", channels=())) == 6
    # Pictures as files that the table names.
    named = {**stored, "observation.images.front": [{"bytes": None, "path": f"images/{it}.png"} for it in range(12)]}
    lerobot_of_others(tmp_path / "named", features, named, "v2.1")
    (tmp_path / "named/images").mkdir()
    for number, image in enumerate(pixels):
        (tmp_path / f"named/images/{number}.png").write_bytes(png(image))
    dataset = cosfly.Dataset(tmp_path / "named", channels=("rgb",))
    assert np.array_equal(dataset[9]["rgb"], pixels[9])
    (tmp_path / "named/images/9.png").unlink()
    with pytest.raises(cosfly.Error, match="9.png"):
        dataset[9]
    outside = {**stored, "observation.images.front": [{"bytes": None, "path": "../stored/meta/info.json"}] * 12}
    with pytest.raises(cosfly.Error, match="outside"):
        cosfly.Dataset(lerobot_of_others(tmp_path / "outside", features, outside), channels=("rgb",))[0]
    # Videos are not decoded; all else loads. Without poses there are no windows.
    features = {
        "observation.images.front": {"dtype": "video", "shape": [20, 30, 3], "names": ["height", "width", "channels"]},
        "observation.state": {"dtype": "float32", "shape": [2], "names": ["battery", "light"]},
    }
    video = cosfly.Dataset(lerobot_of_others(tmp_path / "video", features, {"observation.state": [[1.0, 2.0]] * 12}), channels=())
    assert len(video) == 12 and "drone_x_m" not in video.table("frames").columns
    with pytest.raises(cosfly.Error, match="rgb") as caught:
        cosfly.Dataset(tmp_path / "video", channels=("rgb",))[0]
    assert "videos" in caught.value.hints[0]
    with pytest.raises(cosfly.Error, match="poses"):
        cosfly.Dataset(tmp_path / "video", channels=()).windows()


def test_v7_data_of_others(exports, tmp_path):
    """A trace with the keys that known readers need, and nothing of ours."""
    shutil.copytree(exports["v7"] + "/data_v7", tmp_path / "data_v7")
    ids = cosfly.Dataset(exports["v7"]).trajectory_ids
    for name in ids:
        path = tmp_path / "data_v7" / name / "trajectory.json"
        document = json.loads(path.read_text())
        for key in ("cosfly", "waypoints", "dataset_format"):
            document.pop(key)
        for point in document["points"]:
            point.pop("cosfly")
        path.write_text(json.dumps(document))
    dataset = cosfly.Dataset(tmp_path / "data_v7", columns=("drone_x_m",), channels=("rgb", "depth"))
    assert dataset.trajectory_ids == ids and set(dataset[0]) >= {"rgb", "depth", "drone_x_m"}
    assert len(cosfly.Dataset(tmp_path, channels=()).windows()) > 0
    with pytest.raises(ValueError, match="no splits"):
        cosfly.Dataset(tmp_path, split="train")
    with pytest.raises(ValueError, match="caption"):
        cosfly.Dataset(tmp_path, captions="en")
    (tmp_path / "data_v7" / ids[0] / "frames_playback/frame_00003/depth.npy").unlink()
    with pytest.raises(cosfly.Error, match="frame_00003/depth.npy"):
        dataset.frame(ids[0], 3)
    (tmp_path / "data_v7" / ids[0] / "trajectory.json").write_text("{")
    with pytest.raises(cosfly.Error, match="not JSON"):
        cosfly.Dataset(tmp_path)
