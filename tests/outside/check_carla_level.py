#!/usr/bin/env python3
"""Exports a level through `plugins/carla/export_level.py` without a server, and reads it with cosfly.

Usage: `check_carla_level.py INSPECT_JSON FILE.xodr...`. Bounding boxes with every label and any rotation are the `carla` package's own; a function
stands in for `World.get_level_bbs`. Their corners, as the package computes them, must lie in the boxes of cosfly's town at CARLA's own coordinates;
pavements come from `carla.Map`, and the middles of its sidewalk lanes must lie on walkable ground."""

import json
import random
import sys
import tempfile
from pathlib import Path

import carla
from shapely import Point
from shared import ground_of_boxes, is_in, json_of, module

NOT_SOLID = {"NONE", "Any", "Ground", "Pedestrians", "RailTrack", "Rider", "RoadLines", "Roads", "Sidewalks", "Sky", "Terrain", "Water"}


def some_box(stream):
    box = carla.BoundingBox(
        carla.Location(stream.uniform(-90, 90), stream.uniform(-90, 90), stream.uniform(0, 9)),
        carla.Vector3D(*(stream.uniform(0.2, 6) for _ in range(3))),
    )
    tilt = stream.choice([0.0, 1.0])
    box.rotation = carla.Rotation(tilt * stream.uniform(-25, 25), stream.uniform(-180, 180), tilt * stream.uniform(-25, 25))
    return box


def lies_in(box, point, slack=2e-3):
    (plan,) = ground_of_boxes([box])
    is_level = abs(point.z - box["center_m"][2]) <= box["half_m"][2] + slack
    return is_level and plan.distance(Point(point.x, point.y)) <= slack


def is_on(outline, transform):
    """Whether a place lies in a polygon; the first and last ones of a lane lie on its edge."""
    at, ahead = transform.location, transform.get_forward_vector()
    return any(is_in(outline, at.x + step * ahead.x, at.y + step * ahead.y) for step in (0.0, 0.2, -0.2))


def check(inspect, path):
    stream = random.Random(7)
    names = [name for name in carla.CityObjectLabel.names if name not in ("NONE", "Any")]
    boxes = {name: [some_box(stream) for _ in range(4)] for name in names}
    exporter = module("plugins/carla/export_level.py")
    by_label = {carla.CityObjectLabel.names[name]: found for name, found in boxes.items()}
    town_map = carla.Map(path.stem, path.read_text(encoding="utf-8-sig"))
    level = exporter.level(lambda label: by_label[label], town_map)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "level.json"
        file.write_text(json.dumps(level))
        town = json_of(inspect, file)
    assert town["offset_m"] == [0.0, 0.0, 0.0], town["offset_m"]
    assert set(exporter.LABELS) == set(names) - NOT_SOLID, set(names) ^ set(exporter.LABELS)
    # A crown is drawn within its box.
    solid = [(name, box) for name in exporter.LABELS for box in boxes[name] if name != "Vegetation"]
    corners = [(name, point) for name, box in solid for point in box.get_world_vertices(carla.Transform())]
    for name, point in corners:
        assert any(lies_in(own, point) for own in town["boxes"]), f"{name}: {point} lies in no box"
    trees = [it for it in boxes["Vegetation"] if it.extent.z > 1.5]
    assert town["counts"].get("TreeTrunk", 0) == len(trees), (town["counts"], len(trees))
    walks = [it for it in town["walkable"] if it["kind"] == "Sidewalk"]
    lanes = list(all_sidewalks(town_map))
    missed = [it for it in lanes if not any(is_on(w["outline_m"], it) for w in walks)]
    crossings = sum(it["kind"] == "Crossing" for it in town["walkable"])
    print(f"{path.name}: {len(corners)} corners in {len(town['boxes'])} boxes; {len(walks)} pieces of pavement, {crossings} crossings")
    assert len(missed) <= 0.02 * len(lanes), f"{len(missed)} of {len(lanes)} middles of sidewalk lanes lie beside them"


def all_sidewalks(town_map):
    """Middles of sidewalk lanes beside every driving lane, every 20 m."""
    for waypoint in town_map.generate_waypoints(20.0):
        for step in ("get_left_lane", "get_right_lane"):
            lane, steps = waypoint, 0
            while lane is not None and lane.lane_type != carla.LaneType.Sidewalk:
                lane, steps = getattr(lane, step)() if steps < 16 else None, steps + 1
            if lane is not None and lane.lane_width > 0.5:
                yield lane.transform


for argument in sys.argv[2:]:
    check(sys.argv[1], Path(argument))
