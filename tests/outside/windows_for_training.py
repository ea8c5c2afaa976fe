"""Makes the four kinds of training data of the book's page "Training windows" from a dataset and checks them.

Usage: `windows_for_training.py COSFLY DATASET_FOLDER`. Reads with pyarrow alone. The increments of table `windows` are recomputed from the poses of
table `waypoints`, and handed to `cosfly eval` as predictions, which must then be perfect, along both kinds of axes."""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.dataset as ds
from shared import json_of, require, rows, said, turned


def steps(column, numbers=6):
    """A list column of increments as an array (windows, increments, 6); of boxes with 4 numbers."""
    column = column.combine_chunks()
    return column.flatten().to_numpy().reshape(len(column), -1, numbers)


def of_role(windows, role):
    return windows.filter(windows["role"].to_numpy() == role)


def check_contents(windows):
    """What is seen of a flight and what is learnt: the expert's poses in the same frames (`correction`) and what it does next. Twins have a window of
    their expert at each of their moments, for pairs of both."""
    experts, twins = (of_role(windows, role) for role in (0, 1))
    for name, part, answer in (("denoising", twins, "correction"), ("prediction", experts, "waypoint_deltas"), ("mixed", twins, "waypoint_deltas")):
        seen, answers = steps(part["input_steps_in_body"]), steps(part[f"{answer}_in_body"])
        require(len(seen) == len(answers) > 0 and np.isfinite(seen).all() and np.isfinite(answers).all(), name)
        said(name, f"{seen.shape} {answers.shape}")
    moments = lambda table: set(zip(table["expert_id"].to_pylist(), table["start_frame"].to_pylist()))
    require(moments(twins) <= moments(experts), "a window of a twin has no partner")


def way(of, to):
    """From a pose to another one: metres, degrees."""
    return np.concatenate([to[:3] - of[:3], turned(to[3:], of[3:])])


def check_against_poses(folder, windows):
    poses = {(row["trajectory_id"], row["step"]): np.array(row["pose_in_world"]) for row in rows(folder, "waypoints")}
    corrections, deltas = steps(windows["correction_in_world"]), steps(windows["waypoint_deltas_in_world"])
    for number, row in enumerate(windows.select(["trajectory_id", "expert_id", "start_frame"]).to_pylist()):
        history = corrections.shape[1]
        own = [poses[row["trajectory_id"], row["start_frame"] + k] for k in range(history)]
        expert = [poses[row["expert_id"], row["start_frame"] + k] for k in range(history + deltas.shape[1])]
        for k in range(history):
            require(np.allclose(corrections[number, k], way(own[k], expert[k]), atol=1e-4), f"correction {k} of {row}")
        reached = own[-1] + deltas[number].cumsum(axis=0)[-1]
        difference = way(expert[-1], reached)
        require(np.abs(difference).max() < 1e-3, f"the waypoints of {row} end {difference} away")


def check_eval(cosfly, folder, windows, axes):
    of_twins = of_role(windows, 1)
    deltas = steps(of_twins[f"waypoint_deltas_in_{axes}"])
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "perfect.jsonl"
        places = zip(of_twins["trajectory_id"].to_pylist(), of_twins["start_frame"].to_pylist())
        lines = [{"trajectory_id": name, "frame": frame, "waypoint_deltas": delta.tolist()} for (name, frame), delta in zip(places, deltas)]
        path.write_text("".join(json.dumps(line) + "\n" for line in lines))
        splits = sorted({path.name.split("-")[0] for path in (folder / "data" / "windows").iterdir()})
        options = [part for split in splits for part in ("--split", split)]
        report = json_of(cosfly, "eval", folder, path, "--frame", axes, "--json", "--out", Path(scratch) / "out", *options)
    method = next(it for it in report["methods"] if it["name"] == "predictions")
    fde, count = method["scores"]["fde_m"]["value"], report["rows"]["scored"]
    require(count == len(of_twins) and fde < 1e-4, f"{count} windows scored, FDE {fde} m")
    said(f"cosfly eval --frame {axes}", f"{count} windows, FDE {fde:.1e} m")


dataset = Path(sys.argv[2])
table = ds.dataset(dataset / "data" / "windows").to_table()
require(table.num_rows > 0, "there are no windows")
check_against_poses(dataset, table)
check_contents(table)
ranks = table["subset_rank"].to_numpy()
quarter, half = set(np.flatnonzero(ranks < 0.25)), set(np.flatnonzero(ranks < 0.5))
require(quarter <= half, "subsets do not nest")
require(steps(table["expert_boxes_px"], 4).shape[1] == steps(table["expert_steps_in_world"]).shape[1] + 1, "boxes")
for axes in ("world", "body"):
    check_eval(sys.argv[1], dataset, table, axes)
