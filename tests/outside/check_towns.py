"""Reads a dataset of several towns with pyarrow alone: names, joins by town, splits by town, logs by town.

    python tests/outside/check_towns.py DATASET_FOLDER
"""

import sys
from collections import defaultdict
from pathlib import Path

from shared import rows

folder = Path(sys.argv[1])
flights = rows(folder, "trajectories")
town_of = {row["trajectory_id"]: row["town"] for row in flights}
assert len(town_of) == len(flights), "two flights have the same name"
towns = set(town_of.values())
assert len(towns) > 1, f"this is a dataset of one town: {towns}"
for column in ("town_layout_blake3", "town_geometry_blake3"):
    assert len({(row["town"], row[column]) for row in flights}) == len(towns), column

# A pedestrian has one name within a town, and may have it in another one, too.
for row in flights:
    expert = row["expert_id"]
    assert expert is None or town_of[expert] == row["town"], f"{row['trajectory_id']} and its expert are in two towns"
    assert row["mcap_path"].startswith(f"mcap/{row['town']}/") and (folder / row["mcap_path"]).is_file()

# Instance ids are those of the flight's own town.
objects = {(row["town"], row["instance"]) for row in rows(folder, "objects", ["town", "instance"])}
assert {town for town, _ in objects} == towns
bodies = {(row["trajectory_id"], row["instance"]) for row in rows(folder, "bodies", ["trajectory_id", "instance"])}
for row in rows(folder, "frames", ["trajectory_id", "frame", "occluder_instance"]):
    flight, occluder = row["trajectory_id"], row["occluder_instance"]
    known = occluder == 0 or (town_of[flight], occluder) in objects or (flight, occluder) in bodies
    assert known, f"nothing in {town_of[flight]} is called {occluder}: {row}"

# Seen are the towns of split `train`, and no others.
trained, splits = set(), defaultdict(set)
for row in flights:
    splits[row["split_group"]].add(row["split"])
    if row["split"] == "train":
        trained.add(town_of[row["trajectory_id"]])
assert all(len(of_group) == 1 for of_group in splits.values()), "a group is in two splits"
for table in ("trajectories", "windows"):
    for row in rows(folder, table, ["trajectory_id", "scene"]):
        assert (row["scene"] == 0) == (town_of[row["trajectory_id"]] in trained), row
print(f"{len(flights)} flights in {', '.join(sorted(towns))}; seen in training: {', '.join(sorted(trained)) or 'none'}")
