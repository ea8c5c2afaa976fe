"""Makes the four kinds of training data of the book's page "Training windows" from a dataset and checks them.

    venv/bin/python tests/outside/windows_for_training.py COSFLY DATASET_FOLDER

Reads with pyarrow alone. The increments of table `windows` are recomputed from the poses of table `waypoints`, and
handed to `cosfly eval` as predictions, which must then be perfect, along both kinds of axes.
"""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.dataset as ds
from shared import json_of, require, rows, said, turned


def steps(column):
    """A list column of increments as an array (windows, increments, 6)."""
    column = column.combine_chunks()
    return column.flatten().to_numpy().reshape(len(column), -1, 6)


def boxes(column):
    column = column.combine_chunks()
    return column.flatten().to_numpy().reshape(len(column), -1, 4)


def denoising(windows):
    """The perturbed flight is seen, the expert's poses in the same frames are learnt."""
    of_twins = windows.filter(windows["role"].to_numpy() == 1)
    return steps(of_twins["input_steps_in_body"]), steps(of_twins["correction_in_body"])


def prediction(windows, role):
    """What the expert does next, seen from the expert's own (role 0) or the perturbed (role 1) flight."""
    of_role = windows.filter(windows["role"].to_numpy() == role)
    return steps(of_role["input_steps_in_body"]), steps(of_role["waypoint_deltas_in_body"])


def mixed(windows, share_of_experts, seed):
    """DAgger-style: the expert's windows and, for the rest, the perturbed ones with the expert's answer."""
    draws = np.random.default_rng(seed)
    inputs, answers = zip(*(prediction(windows, role) for role in (0, 1)))
    count = min(len(part) for part in inputs)
    from_expert = draws.random(count) < share_of_experts
    pick = lambda parts: np.where(from_expert[:, None, None], parts[0][:count], parts[1][:count])
    return pick(inputs), pick(answers)


def contrastive_pairs(windows):
    """The same moments as the expert and as the perturbed flight saw them."""
    columns = ["expert_id", "start_frame", "input_steps_in_body"]
    role = windows["role"].to_numpy()
    experts, twins = windows.filter(role == 0).select(columns), windows.filter(role == 1).select(columns)
    places = {key: row for row, key in enumerate(zip(experts["expert_id"].to_pylist(), experts["start_frame"].to_pylist()))}
    partner = [places[key] for key in zip(twins["expert_id"].to_pylist(), twins["start_frame"].to_pylist())]
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
    of_twins = windows.filter(windows["role"].to_numpy() == 1)
    deltas = steps(of_twins[f"waypoint_deltas_in_{axes}"])
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "perfect.jsonl"
        with path.open("w") as file:
            for row, delta in zip(of_twins.select(["trajectory_id", "start_frame"]).to_pylist(), deltas):
                line = {"trajectory_id": row["trajectory_id"], "frame": row["start_frame"], "waypoint_deltas": delta.tolist()}
                file.write(json.dumps(line) + "\n")
        splits = sorted({path.name.split("-")[0] for path in (folder / "data" / "windows").iterdir()})
        options = [part for split in splits for part in ("--split", split)]
        report = json_of(cosfly, "eval", folder, path, "--frame", axes, "--json", "--out", Path(scratch) / "out", *options)
    method = next(it for it in report["methods"] if it["name"] == "predictions")
    fde, count = method["scores"]["fde_m"]["value"], report["rows"]["scored"]
    require(count == len(of_twins) and fde < 1e-4, f"{count} windows scored, FDE {fde} m")
    said(f"cosfly eval --frame {axes}", f"{count} windows, FDE {fde:.1e} m")


def main():
    cosfly, folder = sys.argv[1], Path(sys.argv[2])
    windows = ds.dataset(folder / "data" / "windows").to_table()
    require(windows.num_rows > 0, "there are no windows")
    check_against_poses(folder, windows)
    for name, (seen, learnt) in {
        "denoising": denoising(windows),
        "prediction": prediction(windows, 0),
        "mixed": mixed(windows, 0.5, 0),
        "contrastive pairs": contrastive_pairs(windows),
    }.items():
        require(len(seen) == len(learnt) > 0 and np.isfinite(seen).all() and np.isfinite(learnt).all(), name)
        said(name, f"{seen.shape} {learnt.shape}")
    require(not prediction(windows.filter(windows["role"].to_numpy() == 0), 0)[0].size == 0, "no expert's windows")
    ranks = windows["subset_rank"].to_numpy()
    quarter, half = set(np.flatnonzero(ranks < 0.25)), set(np.flatnonzero(ranks < 0.5))
    require(quarter <= half, "subsets do not nest")
    require(boxes(windows["expert_boxes_px"]).shape[1] == steps(windows["expert_steps_in_world"]).shape[1] + 1, "boxes")
    for axes in ("world", "body"):
        check_eval(cosfly, folder, windows, axes)


main()
