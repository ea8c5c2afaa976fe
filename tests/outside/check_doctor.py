"""Plants faults into copies of a dataset and of its exports; `cosfly doctor` must name each, and nothing in sound data.

    python check_doctor.py COSFLY DATASET

DATASET is what `cosfly run recipes/small.toml` delivers. Files are changed by pyarrow, numpy and json, not by cosfly.
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
import pyarrow
import pyarrow.parquet as parquet

cosfly, dataset = sys.argv[1], pathlib.Path(sys.argv[2])
failures = []


def names(folder, work):
    """The names of all flags, and the exit code."""
    verdict = work / "verdict.json"
    done = subprocess.run([cosfly, "doctor", folder, "--out", verdict], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        return {f"exit {done.returncode}: {done.stderr.strip()[:300]}"}, done.returncode
    return {flag["name"] for flag in json.loads(verdict.read_text())["flags"]}, done.returncode


def planted(name, source, work, damage):
    """Copies `source`, damages the copy, and looks for `name` among the flags."""
    copy = work / "copy"
    shutil.copytree(source, copy, copy_function=shutil.copy)
    for path in copy.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
    damage(copy)
    found, code = names(copy, work)
    good = found == set() and code == 0 if name is None else name in found and code == 1
    print("found" if good else "MISSED", f"{name or 'nothing'}: {sorted(found)}, exit {code}")
    if not good:
        failures.append(name)
    shutil.rmtree(copy)


def tables(folder, table, change):
    """Rewrites all files of a table, row dictionaries in and out."""
    for path in (folder / "data" / table).glob("*.parquet"):
        old = parquet.read_table(path)
        parquet.write_table(pyarrow.Table.from_pylist(change(old.to_pylist()), schema=old.schema), path)


POSE = [f"{whose}_{what}" for whose, whats in (
    ("drone", ("x_m", "y_m", "z_m", "pitch_deg", "yaw_deg", "roll_deg")),
    ("camera", ("pitch_deg", "yaw_deg", "roll_deg")),
    ("target", ("x_m", "y_m", "z_m", "heading_deg", "speed_mps")),
) for what in whats] + ["action_in_world"]


def shift_frames(rows):
    """Poses of the frame before beside boxes and images of this one."""
    moved = [dict(row) for row in rows]
    for before, row in zip(rows, moved[1:]):
        if before["trajectory_id"] == row["trajectory_id"]:
            row.update({name: before[name] for name in POSE})
    return moved


def shift_all(rows):
    """All numbers of the frame before, consistent with each other and not with the images; experts alone, who fly smoothly."""
    moved = [dict(row) for row in rows]
    for before, row in zip(rows, moved[1:]):
        if before["trajectory_id"] == row["trajectory_id"] and row["trajectory_id"].startswith("expert"):
            row.update({name: value for name, value in before.items() if name not in ("frame", "time_s", "preview")})
    return moved


def flip_yaw(rows):
    for row in rows:
        row["drone_yaw_deg"], row["camera_yaw_deg"] = -row["drone_yaw_deg"], -row["camera_yaw_deg"]
    return rows


def sunk(rows):
    """Feet half a metre below the drawn ground."""
    for row in rows:
        row["target_z_m"] -= 0.5
    return rows


def wrong_actions(rows):
    """The action of the frame before in every frame."""
    actions = [row["action_in_world"] for row in rows]
    for action, before, row in zip(actions, rows, rows[1:]):
        if before["trajectory_id"] == row["trajectory_id"] and row["action_in_world"] is not None:
            row["action_in_world"] = action
    return rows


def late(rows):
    for row in rows:
        row["time_s"] += 0.2 * (row["frame"] > 9)
    return rows


def lying(rows):
    swap = {"north": "south", "south": "north", "east": "west", "west": "east"}
    for row in rows:
        words = row["text"].replace("metres", "m").split(" ")
        row["text"] = " ".join(swap.get(word.strip(",.;"), word) for word in words) + " It walks 900 m."
    return rows


def truncate(folder):
    path = sorted((folder / "data" / "frames").glob("*.parquet"))[0]
    path.write_bytes(path.read_bytes()[:-700])


def flip_byte(folder):
    path = sorted((folder / "mcap").rglob("*.mcap"))[0]
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 1
    path.write_bytes(data)


def leak(folder):
    """The flights of one split under the name of another as well."""
    for table in ("trajectories", "frames"):
        path = sorted((folder / "data" / table).glob("*.parquet"))[0]
        other = "test" if not path.name.startswith("test") else "train"
        shutil.copy(path, path.with_name(f"{other}-00007-of-00008.parquet"))


def documents(folder, change):
    """Rewrites every trajectory.json."""
    for path in folder.rglob("trajectory.json"):
        document = json.loads(path.read_text())
        change(document["points"])
        path.write_text(json.dumps(document))


def v7_yaw(points):
    for point in points:
        for pose in (point["drone_pose"], point.get("cosfly", {}).get("camera_pose", {})):
            pose["yaw"] = -pose.get("yaw", 0.0)


def v7_sunk(points):
    for point in points:
        point["target"]["world_location"]["z"] -= 0.5


def v7_stop(points):
    points[7]["timing"]["trace_timestamp"] = points[6]["timing"]["trace_timestamp"]


def v7_waypoints(points):
    for point in points[:-1]:
        point["nav_waypoint"]["t1_world"]["x"] += 0.2


def millimetres(folder):
    for path in folder.rglob("depth.npy"):
        numpy.save(path, numpy.load(path) * numpy.float32(1000.0))


def shift_pictures(folder):
    """Every frame folder gets the pictures of the frame after it."""
    for frames in folder.rglob("frames_playback"):
        folders = sorted(frames.iterdir())
        for target, source in zip(folders, folders[1:]):
            for name in ("rgb.png", "depth.npy"):
                shutil.copy(source / name, target / name)


def lerobot(folder, change):
    """Rewrites the frames of a LeRobot dataset, episode by episode: lists of row dictionaries, changed in place."""
    for path in folder.glob("data/*/*.parquet"):
        old = parquet.read_table(path)
        rows = old.to_pylist()
        for number in {row["episode_index"] for row in rows}:
            change([row for row in rows if row["episode_index"] == number])
        parquet.write_table(pyarrow.Table.from_pylist(rows, schema=old.schema), path)


def lerobot_jump(rows):
    for row in rows[9:]:
        row["timestamp"] += 0.7


def lerobot_actions(rows):
    """The action of the frame before in every frame."""
    actions = [row["action"] for row in rows]
    for action, row in zip(actions, rows[1:]):
        row["action"] = action


def lerobot_yaw(rows):
    for row in rows:
        row["privileged.pose"][4] *= -1


def lerobot_repeated(rows):
    rows[12]["observation.images.rgb"] = rows[11]["observation.images.rgb"]


def lerobot_gap(folder):
    """A row less than told."""
    path = sorted(folder.glob("data/*/*.parquet"))[0]
    table = parquet.read_table(path)
    parquet.write_table(pyarrow.concat_tables([table.slice(0, 5), table.slice(6)]), path)


def truncate_data(folder):
    path = sorted(folder.glob("data/*/*.parquet"))[0]
    path.write_bytes(path.read_bytes()[:-700])


def box(kind, body):
    """A box of an MP4 file."""
    return (len(body) + 8).to_bytes(4, "big") + kind + body


VIDEO = "videos/observation.images.front/chunk-000/file-000.mp4"


def foreign(folder):
    """A LeRobot dataset as others make them: other names, radians, velocities of the body as actions, video, no target."""
    rate, episodes, index = 10, [], 0
    rows, random = [], numpy.random.default_rng(7)
    for number in range(3):
        place, yaw, first = random.normal(size=3) * 20, random.uniform(-3, 3), index
        for frame in range(40):
            speed = numpy.array([3.0 + numpy.sin(frame / 5), 0.4 * numpy.cos(frame / 7), 0.2])
            rows.append({
                "observation.pose": [*place, yaw],
                "action": [*speed, 0.05],
                "timestamp": frame / rate,
                "frame_index": frame,
                "episode_index": number,
                "index": index,
                "task_index": 0,
            })
            cos, sin = numpy.cos(yaw), numpy.sin(yaw)
            place = place + numpy.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]) @ speed / rate
            yaw, index = yaw + 0.05 / rate, index + 1
        episodes.append({
            "episode_index": number, "length": 40, "tasks": ["follow"], "dataset_from_index": first, "dataset_to_index": index,
            "videos/observation.images.front/chunk_index": 0, "videos/observation.images.front/file_index": 0,
            "videos/observation.images.front/from_timestamp": first / rate,
            "videos/observation.images.front/to_timestamp": index / rate,
        })
    vector = lambda names: {"dtype": "float64", "shape": [len(names)], "names": {"axes": names}}
    info = {
        "codebase_version": "v3.0", "robot_type": "uav", "fps": rate, "total_episodes": 3, "total_frames": index, "splits": {"train": "0:3"},
        "chunks_size": 1000, "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4",
        "features": {
            "observation.images.front": {"dtype": "video", "shape": [48, 64, 3], "names": ["height", "width", "channels"]},
            "observation.pose": vector(["pos_x", "pos_y", "pos_z", "yaw_rad"]),
            "action": vector(["vx", "vy", "vz", "yaw_rate"]),
        },
    }
    for name in ("data/chunk-000", "meta/episodes/chunk-000", pathlib.Path(VIDEO).parent):
        (folder / name).mkdir(parents=True)
    parquet.write_table(pyarrow.Table.from_pylist(rows), folder / "data/chunk-000/file-000.parquet")
    parquet.write_table(pyarrow.Table.from_pylist(episodes), folder / "meta/episodes/chunk-000/file-000.parquet")
    (folder / "meta/info.json").write_text(json.dumps(info))
    # The boxes of a video: 12 s at 600 ticks a second. It is not decoded here or there.
    header = bytes(12) + (600).to_bytes(4, "big") + (12 * 600).to_bytes(4, "big")
    moov = box(b"moov", box(b"trak", box(b"mdia", box(b"mdhd", header))))
    (folder / VIDEO).write_bytes(box(b"ftyp", b"isom") + box(b"mdat", bytes(4000)) + moov)


def foreign_actions(rows):
    for row, action in reversed(list(zip(rows[1:], [row["action"] for row in rows]))):
        row["action"] = action


def foreign_jump(rows):
    for row in rows[30:]:
        row["observation.pose"][0] += 30.0


def repeat_pictures(folder):
    for frames in folder.rglob("frames_playback"):
        shutil.copy(frames / "frame_00011/rgb.png", frames / "frame_00012/rgb.png")


with tempfile.TemporaryDirectory() as place:
    work = pathlib.Path(place)
    v7 = work / "v7"
    subprocess.run([cosfly, "export", dataset, "--format", "v7", "--out", v7], check=True, capture_output=True)
    planted(None, dataset, work, lambda folder: None)
    planted("frame-shift", dataset, work, lambda folder: tables(folder, "frames", shift_frames))
    planted("image-shift", dataset, work, lambda folder: tables(folder, "frames", shift_all))
    planted("yaw-sign", dataset, work, lambda folder: tables(folder, "frames", flip_yaw))
    planted("action-mismatch", dataset, work, lambda folder: tables(folder, "frames", wrong_actions))
    planted("below-ground", dataset, work, lambda folder: tables(folder, "frames", sunk))
    planted("timestamps", dataset, work, lambda folder: tables(folder, "frames", late))
    planted("caption-mismatch", dataset, work, lambda folder: tables(folder, "captions", lying))
    planted("parquet-damaged", dataset, work, truncate)
    planted("log-damaged", dataset, work, flip_byte)
    planted("split-leak", dataset, work, leak)
    planted(None, v7, work, lambda folder: None)
    planted("yaw-sign", v7, work, lambda folder: documents(folder, v7_yaw))
    planted("below-ground", v7, work, lambda folder: documents(folder, v7_sunk))
    planted("timestamps", v7, work, lambda folder: documents(folder, v7_stop))
    planted("action-mismatch", v7, work, lambda folder: documents(folder, v7_waypoints))
    planted("depth-unit", v7, work, millimetres)
    planted("image-shift", v7, work, shift_pictures)
    planted("duplicate-frames", v7, work, repeat_pictures)

    export = work / "lerobot"
    subprocess.run([cosfly, "export", dataset, "--format", "lerobot", "--out", export], check=True, capture_output=True)
    ours = next(path for path in sorted(export.iterdir()) if path.is_dir())  # the dataset of one split
    planted(None, ours, work, lambda folder: None)
    planted("timestamps", ours, work, lambda folder: lerobot(folder, lerobot_jump))
    planted("action-mismatch", ours, work, lambda folder: lerobot(folder, lerobot_actions))
    planted("yaw-sign", ours, work, lambda folder: lerobot(folder, lerobot_yaw))
    planted("duplicate-frames", ours, work, lambda folder: lerobot(folder, lerobot_repeated))
    planted("index-mismatch", ours, work, lerobot_gap)
    planted("parquet-damaged", ours, work, truncate_data)
    others = work / "foreign"
    foreign(others)
    planted(None, others, work, lambda folder: None)
    planted("timestamps", others, work, lambda folder: lerobot(folder, lerobot_jump))
    planted("action-mismatch", others, work, lambda folder: lerobot(folder, foreign_actions))
    planted("pose-jump", others, work, lambda folder: lerobot(folder, foreign_jump))
    planted("video-missing", others, work, lambda folder: (folder / VIDEO).unlink())
    planted("video-damaged", others, work, lambda folder: (folder / VIDEO).write_bytes((folder / VIDEO).read_bytes()[:-40]))

sys.exit(f"missed: {failures}" if failures else 0)
