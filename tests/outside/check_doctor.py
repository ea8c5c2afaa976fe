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


def tables(folder, files, change):
    """Rewrites Parquet files, lists of row dictionaries in and out."""
    for path in folder.glob(f"data/{files}/*.parquet"):
        old = parquet.read_table(path)
        parquet.write_table(pyarrow.Table.from_pylist(change(old.to_pylist()), schema=old.schema), path)


POSE = [f"{whose}_{what}" for whose, whats in (
    ("drone", ("x_m", "y_m", "z_m", "pitch_deg", "yaw_deg", "roll_deg")),
    ("camera", ("pitch_deg", "yaw_deg", "roll_deg")),
    ("target", ("x_m", "y_m", "z_m", "heading_deg", "speed_mps")),
) for what in whats] + ["action_in_world"]


def pairs_of(rows):
    """Rows as they were, each with the next one of the same flight, which may be changed."""
    return [(dict(before), row) for before, row in zip(rows, rows[1:]) if before["trajectory_id"] == row["trajectory_id"]]


def shift_frames(rows):
    """Poses of the frame before beside boxes and images of this one."""
    for before, row in pairs_of(rows):
        row.update({name: before[name] for name in POSE})
    return rows


def shift_all(rows):
    """All numbers of the frame before, consistent with each other and not with the images; experts alone, who fly smoothly."""
    for before, row in pairs_of(rows):
        if row["trajectory_id"].startswith("expert"):
            row.update({name: value for name, value in before.items() if name not in ("frame", "time_s", "preview")})
    return rows


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
    for before, row in pairs_of(rows):
        if row["action_in_world"] is not None:
            row["action_in_world"] = before["action_in_world"]
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


def truncate(folder, files="frames"):
    path = sorted(folder.glob(f"data/{files}/*.parquet"))[0]
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
    def changed(rows):
        for number in {row["episode_index"] for row in rows}:
            change([row for row in rows if row["episode_index"] == number])
        return rows

    tables(folder, "*", changed)


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


def foreign_jump(rows):
    for row in rows[30:]:
        row["observation.pose"][0] += 30.0


def repeat_pictures(folder):
    for frames in folder.rglob("frames_playback"):
        shutil.copy(frames / "frame_00011/rgb.png", frames / "frame_00012/rgb.png")


def each(change, files="frames"):
    """A change of tables of a dataset of cosfly."""
    return lambda folder: tables(folder, files, change)


def of_v7(change):
    return lambda folder: documents(folder, change)


def of_lerobot(change):
    return lambda folder: lerobot(folder, change)


PLANTS = {
    "dataset": {
        None: lambda folder: None, "frame-shift": each(shift_frames), "image-shift": each(shift_all), "yaw-sign": each(flip_yaw),
        "action-mismatch": each(wrong_actions), "below-ground": each(sunk), "timestamps": each(late),
        "caption-mismatch": each(lying, "captions"), "parquet-damaged": truncate, "log-damaged": flip_byte, "split-leak": leak,
    },
    "v7": {
        None: lambda folder: None, "yaw-sign": of_v7(v7_yaw), "below-ground": of_v7(v7_sunk), "timestamps": of_v7(v7_stop),
        "action-mismatch": of_v7(v7_waypoints), "depth-unit": millimetres, "image-shift": shift_pictures, "duplicate-frames": repeat_pictures,
    },
    "lerobot": {
        None: lambda folder: None, "timestamps": of_lerobot(lerobot_jump), "action-mismatch": of_lerobot(lerobot_actions),
        "yaw-sign": of_lerobot(lerobot_yaw), "duplicate-frames": of_lerobot(lerobot_repeated), "index-mismatch": lerobot_gap,
        "parquet-damaged": lambda folder: truncate(folder, "*"),
    },
    "foreign": {
        None: lambda folder: None, "timestamps": of_lerobot(lerobot_jump), "action-mismatch": of_lerobot(lerobot_actions),
        "pose-jump": of_lerobot(foreign_jump), "video-missing": lambda folder: (folder / VIDEO).unlink(),
        "video-damaged": lambda folder: (folder / VIDEO).write_bytes((folder / VIDEO).read_bytes()[:-40]),
    },
}

with tempfile.TemporaryDirectory() as place:
    work = pathlib.Path(place)
    for layout in ("v7", "lerobot"):
        subprocess.run([cosfly, "export", dataset, "--format", layout, "--out", work / layout], check=True, capture_output=True)
    foreign(work / "foreign")
    of_one_split = next(path for path in sorted((work / "lerobot").iterdir()) if path.is_dir())
    for layout, plants in PLANTS.items():
        source = {"dataset": dataset, "lerobot": of_one_split}.get(layout, work / layout)
        for name, damage in plants.items():
            planted(name, source, work, damage)

sys.exit(f"missed: {failures}" if failures else 0)
