"""What plugins added to a dataset (recipes/extras.toml), read by others: pyarrow, datasets, mlcroissant, evo.

Usage: `check_extras.py DATASET CACHE`."""

import json
import math
import sys
from pathlib import Path

import datasets
import mlcroissant
import numpy
import pyarrow
import pyarrow.parquet as parquet
from evo.core import metrics
from evo.tools import file_interface
from shared import rows

folder, cache = Path(sys.argv[1]), Path(sys.argv[2])
flights = rows(folder, "trajectories", ["trajectory_id", "frames", "mcap_path"])
ids = {flight["trajectory_id"] for flight in flights}

# One row per flight, typed columns.
viewpoint = parquet.read_table(folder / "data/viewpoint")
kinds = {field.name: field.type for field in viewpoint.schema}
assert kinds == {
    "trajectory_id": pyarrow.string(), "side": pyarrow.string(), "instruction": pyarrow.string(), "always_in_view": pyarrow.bool_(),
    "mean_distance_m": pyarrow.float64(), "mean_elevation_deg": pyarrow.float64(), "longest_loss_s": pyarrow.float64(), "losses": pyarrow.int64(),
}, kinds
assert sorted(viewpoint["trajectory_id"].to_pylist()) == sorted(ids)
frames = parquet.read_table(folder / "data/frames").to_pandas()
of_flight = {name: own.sort_values("frame") for name, own in frames.groupby("trajectory_id")}
captions = {(row["trajectory_id"], row["text"]) for row in rows(folder, "captions") if (row["language"], row["style"]) == ("en", "instruction")}
for row in viewpoint.to_pylist():
    own = of_flight[row["trajectory_id"]]
    assert math.isclose(row["mean_distance_m"], own.distance_m.mean(), abs_tol=1e-9), row
    assert row["always_in_view"] == bool(own.in_view.all()), row
    assert (row["trajectory_id"], row["instruction"]) in captions, row

# Any number of rows per flight: each loss is where `frames` has it.
losses = rows(folder, "losses")
assert [(row["trajectory_id"], row["row"]) for row in losses] == sorted({(row["trajectory_id"], row["row"]) for row in losses})
lost = frames.visible_by_rays < 0.95
assert sum(row["frames"] for row in losses) == int(lost.sum()), (len(losses), int(lost.sum()))
for row in losses:
    first = of_flight[row["trajectory_id"]].iloc[row["first_frame"]]
    assert first.visible_by_rays < 0.95 and first.occluder_instance == row["occluder_instance"], row

# The same through others' loaders.
loaded = datasets.load_dataset(str(folder), "viewpoint", cache_dir=str(cache))
assert sum(split.num_rows for split in loaded.values()) == len(ids)
croissant = mlcroissant.Dataset(str(folder / "croissant.json"))
assert not croissant.metadata.ctx.issues.errors, croissant.metadata.ctx.issues.errors
records = list(croissant.records("viewpoint"))
assert {record["viewpoint/trajectory_id"].decode() for record in records} == ids
document = json.loads((folder / "croissant.json").read_text())
assert any(it["@id"] == "tum-files" for it in document["distribution"])

# TUM files: evo reads them, and they are where the tables say.
for flight in flights:
    place = folder / "extras" / "tum" / flight["mcap_path"].removeprefix("mcap/").removesuffix(".mcap")
    camera, target = (file_interface.read_tum_trajectory_file(str(place / f"{name}.txt")) for name in ("camera", "target"))
    assert camera.check()[0] and target.check()[0] and camera.num_poses == flight["frames"]
    own = of_flight[flight["trajectory_id"]]
    wanted = own[["drone_x_m", "drone_y_m", "drone_z_m"]].to_numpy() * [1, -1, 1]
    assert numpy.abs(camera.positions_xyz - wanted).max() < 1e-8
    # Where the camera looks (x ahead) goes along the line to the target, as in the table's angles.
    ahead = numpy.array([pose[:3, 0] for pose in camera.poses_se3])
    yaw, pitch = numpy.radians(own.camera_yaw_deg), numpy.radians(own.camera_pitch_deg)
    looks = numpy.stack([numpy.cos(pitch) * numpy.cos(yaw), -numpy.cos(pitch) * numpy.sin(yaw), numpy.sin(pitch)], axis=1)
    assert numpy.abs(ahead - looks).max() < 1e-6
    error = metrics.APE(metrics.PoseRelation.translation_part)
    error.process_data((camera, target))
    assert abs(error.get_statistic(metrics.StatisticsType.mean) - own.distance_m.mean()) < 1e-6

print(f"{len(ids)} flights annotated, {len(losses)} losses, {2 * len(flights)} TUM files: read by pyarrow, datasets, mlcroissant and evo")
