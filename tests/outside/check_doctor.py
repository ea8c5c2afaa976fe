"""Plants faults into copies of a dataset and of its exports; `cosfly doctor` must name each, and nothing in sound data.

Usage: `check_doctor.py COSFLY DATASET`. DATASET is what `cosfly run recipes/small.toml` delivers. Files are changed by pyarrow, numpy and json, not
by cosfly."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
import pyarrow
import pyarrow.parquet as parquet
from shared import end_with, require, run

cosfly, dataset = sys.argv[1], pathlib.Path(sys.argv[2])


def is_found(name, source, work, damage):
    """Copies `source`, damages the copy, and looks for `name` among the flags; without a name there must be none."""
    copy, verdict = work / "copy", work / "verdict.json"
    shutil.copytree(source, copy, copy_function=shutil.copy)
    for path in copy.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
    damage(copy)
    done = subprocess.run([cosfly, "doctor", copy, "--out", verdict], capture_output=True, text=True)
    require(done.returncode in (0, 1), f"{name}: exit code {done.returncode}: {done.stderr}")
    found = {flag["name"] for flag in json.loads(verdict.read_text())["flags"]}
    shutil.rmtree(copy)
    is_good = not found and done.returncode == 0 if name is None else name in found and done.returncode == 1
    print("found" if is_good else "MISSED", f"{name or 'nothing'}: {sorted(found)}, exit {done.returncode}", flush=True)
    return is_good


def tables(change, files="frames", by="trajectory_id"):
    """Damage of Parquet files: `change` gets the rows of each flight, dictionaries, and changes them in place."""

    def damage(folder):
        for path in folder.glob(f"data/{files}/*.parquet"):
            old, flights = parquet.read_table(path), {}
            rows = old.to_pylist()
            for row in rows:
                flights.setdefault(row[by], []).append(row)
            for flight in flights.values():
                change(flight)
            parquet.write_table(pyarrow.Table.from_pylist(rows, schema=old.schema), path)

    return damage


def of_lerobot(change):
    return tables(change, "*", "episode_index")


def of_v7(change):
    """Damage of every trajectory.json: `change` gets its points."""

    def damage(folder):
        for path in folder.rglob("trajectory.json"):
            document = json.loads(path.read_text())
            change(document["points"])
            path.write_text(json.dumps(document))

    return damage


def delayed(names):
    """The values of the frame before under those names of a row."""

    def change(rows):
        for before, row in zip([dict(row) for row in rows], rows[1:]):
            row.update({name: before[name] for name in names(row)})

    return change


def added(number, name, first=0):
    """A number more from a frame on."""

    def change(rows):
        for row in rows[first:]:
            row[name] += number

    return change


POSE = [f"{whose}_{what}" for whose, whats in (
    ("drone", ("x_m", "y_m", "z_m", "pitch_deg", "yaw_deg", "roll_deg")),
    ("camera", ("pitch_deg", "yaw_deg", "roll_deg")),
    ("target", ("x_m", "y_m", "z_m", "heading_deg", "speed_mps")),
) for what in whats] + ["action_in_world"]


def all_of_experts(row):
    """Shifted together, all numbers agree with each other and not with the images; experts alone, who fly smoothly."""
    return row.keys() - {"frame", "time_s", "preview"} if row["trajectory_id"].startswith("expert") else ()


def flip_yaw(rows):
    for row in rows:
        row["drone_yaw_deg"], row["camera_yaw_deg"] = -row["drone_yaw_deg"], -row["camera_yaw_deg"]


def lying(rows):
    swap = {"north": "south", "south": "north", "east": "west", "west": "east"}
    for row in rows:
        words = row["text"].replace("metres", "m").split(" ")
        row["text"] = " ".join(swap.get(word.strip(",.;"), word) for word in words) + " It walks 900 m."


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


def v7_yaw(points):
    for point in points:
        for pose in (point["drone_pose"], point.get("cosfly", {}).get("camera_pose", {})):
            pose["yaw"] = -pose.get("yaw", 0.0)


def v7_sunk(points):
    added(-0.5, "z")([point["target"]["world_location"] for point in points])


def v7_stop(points):
    points[7]["timing"]["trace_timestamp"] = points[6]["timing"]["trace_timestamp"]


def v7_waypoints(points):
    added(0.2, "x")([point["nav_waypoint"]["t1_world"] for point in points[:-1]])


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


def repeat_pictures(folder):
    for frames in folder.rglob("frames_playback"):
        shutil.copy(frames / "frame_00011/rgb.png", frames / "frame_00012/rgb.png")


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


def foreign_jump(rows):
    added(30.0, 0, 30)([row["observation.pose"] for row in rows])


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
            rows.append({"observation.pose": [*place, yaw], "action": [*speed, 0.05], "timestamp": frame / rate,
                         "frame_index": frame, "episode_index": number, "index": index, "task_index": 0})
            cos, sin = numpy.cos(yaw), numpy.sin(yaw)
            place = place + numpy.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]) @ speed / rate
            yaw, index = yaw + 0.05 / rate, index + 1
        episodes.append({
            "episode_index": number, "length": 40, "tasks": ["follow"], "dataset_from_index": first, "dataset_to_index": index,
            "videos/observation.images.front/chunk_index": 0, "videos/observation.images.front/file_index": 0,
            "videos/observation.images.front/from_timestamp": first / rate, "videos/observation.images.front/to_timestamp": index / rate,
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


NOTHING = {None: lambda folder: None}
OF_LEROBOT = {"timestamps": of_lerobot(added(0.7, "timestamp", 9)), "action-mismatch": of_lerobot(delayed(lambda _: ["action"]))}
PLANTS = {
    "dataset": {
        "frame-shift": tables(delayed(lambda _: POSE)), "image-shift": tables(delayed(all_of_experts)), "yaw-sign": tables(flip_yaw),
        "action-mismatch": tables(delayed(lambda row: ["action_in_world"] if row["action_in_world"] is not None else [])),
        "below-ground": tables(added(-0.5, "target_z_m")), "timestamps": tables(added(0.2, "time_s", 10)),
        "caption-mismatch": tables(lying, "captions"), "parquet-damaged": truncate, "log-damaged": flip_byte, "split-leak": leak,
    },
    "v7": {
        "yaw-sign": of_v7(v7_yaw), "below-ground": of_v7(v7_sunk), "timestamps": of_v7(v7_stop), "action-mismatch": of_v7(v7_waypoints),
        "depth-unit": millimetres, "image-shift": shift_pictures, "duplicate-frames": repeat_pictures,
    },
    "lerobot": {
        **OF_LEROBOT, "yaw-sign": of_lerobot(lerobot_yaw), "duplicate-frames": of_lerobot(lerobot_repeated), "index-mismatch": lerobot_gap,
        "parquet-damaged": lambda folder: truncate(folder, "*"),
    },
    "foreign": {
        **OF_LEROBOT, "pose-jump": of_lerobot(foreign_jump), "video-missing": lambda folder: (folder / VIDEO).unlink(),
        "video-damaged": lambda folder: (folder / VIDEO).write_bytes((folder / VIDEO).read_bytes()[:-40]),
    },
}

with tempfile.TemporaryDirectory() as place:
    work = pathlib.Path(place)
    for layout in ("v7", "lerobot"):
        run(cosfly, "export", dataset, "--format", layout, "--out", work / layout)
    foreign(work / "foreign")
    of_one_split = next(path for path in sorted((work / "lerobot").iterdir()) if path.is_dir())
    sources = {"dataset": dataset, "v7": work / "v7", "lerobot": of_one_split, "foreign": work / "foreign"}
    end_with([f"missed: {name} in {layout}" for layout, plants in PLANTS.items() for name, damage in (NOTHING | plants).items()
              if not is_found(name, sources[layout], work, damage)])
