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


def learnt(windows, role, answer):
    """What is seen of a flight and what is learnt: `correction`, the expert's poses in the same frames; `waypoint_deltas`, what the expert does
    next. The flight is the expert's own (role 0) or the perturbed one (role 1)."""
    chosen = of_role(windows, role)
    return steps(chosen["input_steps_in_body"]), steps(chosen[f"{answer}_in_body"])


def mixed(windows, share_of_experts, seed):
    """DAgger-style: the expert's windows and, for the rest, the perturbed ones with the expert's answer."""
    draws = np.random.default_rng(seed)
    inputs, answers = zip(*(learnt(windows, role, "waypoint_deltas") for role in (0, 1)))
    count = min(len(part) for part in inputs)
    from_expert = draws.random(count) < share_of_experts
    pick = lambda parts: np.where(from_expert[:, None, None], parts[0][:count], parts[1][:count])
    return pick(inputs), pick(answers)


def contrastive_pairs(windows):
    """The same moments as the expert and as the perturbed flight saw them."""
    experts, twins = (of_role(windows, role) for role in (0, 1))
    moments = lambda table: zip(table["expert_id"].to_pylist(), table["start_frame"].to_pylist())
    places = {moment: row for row, moment in enumerate(moments(experts))}
    partner = [places[moment] for moment in moments(twins)]
    return steps(experts["input_steps_in_body"])[partner], steps(twins["input_steps_in_body"])


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
for name, (seen, answers) in {
    "denoising": learnt(table, 1, "correction"), "prediction": learnt(table, 0, "waypoint_deltas"),
    "mixed": mixed(table, 0.5, 0), "contrastive pairs": contrastive_pairs(table),
}.items():
    require(len(seen) == len(answers) > 0 and np.isfinite(seen).all() and np.isfinite(answers).all(), name)
    said(name, f"{seen.shape} {answers.shape}")
ranks = table["subset_rank"].to_numpy()
quarter, half = set(np.flatnonzero(ranks < 0.25)), set(np.flatnonzero(ranks < 0.5))
require(quarter <= half, "subsets do not nest")
require(steps(table["expert_boxes_px"], 4).shape[1] == steps(table["expert_steps_in_world"]).shape[1] + 1, "boxes")
for axes in ("world", "body"):
    check_eval(sys.argv[1], dataset, table, axes)
