"""Plants faults into copies of a dataset and of its v7 export; `cosfly doctor` must name each, and nothing in sound data.

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
    done = subprocess.run([cosfly, "doctor", folder, "--json", verdict], capture_output=True, text=True, check=False)
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


def flip_yaw(rows):
    for row in rows:
        row["drone_yaw_deg"], row["camera_yaw_deg"] = -row["drone_yaw_deg"], -row["camera_yaw_deg"]
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


def repeat_pictures(folder):
    for frames in folder.rglob("frames_playback"):
        shutil.copy(frames / "frame_00011/rgb.png", frames / "frame_00012/rgb.png")


with tempfile.TemporaryDirectory() as place:
    work = pathlib.Path(place)
    v7 = work / "v7"
    subprocess.run([cosfly, "export", dataset, "--format", "v7", "--out", v7], check=True, capture_output=True)
    planted(None, dataset, work, lambda folder: None)
    planted("frame-shift", dataset, work, lambda folder: tables(folder, "frames", shift_frames))
    planted("yaw-sign", dataset, work, lambda folder: tables(folder, "frames", flip_yaw))
    planted("action-mismatch", dataset, work, lambda folder: tables(folder, "frames", wrong_actions))
    planted("timestamps", dataset, work, lambda folder: tables(folder, "frames", late))
    planted("caption-mismatch", dataset, work, lambda folder: tables(folder, "captions", lying))
    planted("parquet-damaged", dataset, work, truncate)
    planted("log-damaged", dataset, work, flip_byte)
    planted("split-leak", dataset, work, leak)
    planted(None, v7, work, lambda folder: None)
    planted("yaw-sign", v7, work, lambda folder: documents(folder, v7_yaw))
    planted("timestamps", v7, work, lambda folder: documents(folder, v7_stop))
    planted("action-mismatch", v7, work, lambda folder: documents(folder, v7_waypoints))
    planted("depth-unit", v7, work, millimetres)
    planted("image-shift", v7, work, shift_pictures)
    planted("duplicate-frames", v7, work, repeat_pictures)

sys.exit(f"missed: {failures}" if failures else 0)
