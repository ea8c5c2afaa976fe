#!/usr/bin/env python3
"""Writes the solid things of a running CARLA server's level as a map that cosfly reads (`cosfly-boxes/1`).

    pip install -r plugins/carla/requirements.txt
    ./CarlaUE4.sh -RenderOffScreen &
    python plugins/carla/export_level.py --map Town10HD --out Town10HD.json
    cosfly run recipes/small.toml --set stages.town.source=Town10HD.json --out out/Town10HD
    cosfly carla-job out/Town10HD --out job.json       # flights clear of the server's own houses

One box for each bounding box of `World.get_level_bbs`, asked for label by label; pavements and crossings from the level's
OpenDRIVE through `carla.Map`. CARLA's frame (left-handed, y to the right) becomes the file's (y to the left, yaw
counter-clockwise); the town in cosfly has CARLA's coordinates again.

Tested without a server (tests/outside/check_carla_level.py): everything but the connection, with the package's own
BoundingBox, Transform, Rotation and Map. Not run: `get_level_bbs` of a real server, and how long it takes.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import carla

FORMAT = "cosfly-boxes/1"
TIMEOUT_S = 60.0
# Labels of what is solid. Ground, sky, people and water are no obstacles.
LABELS = (
    "Bridge", "Buildings", "Dynamic", "Fences", "GuardRail", "Other", "Poles", "Static", "TrafficLight", "TrafficSigns",
    "Vegetation", "Walls", "Bicycle", "Bus", "Car", "Motorcycle", "Train", "Truck",
)  # fmt: skip
STEP_M = 2.0  # length of a piece of pavement
SMALLEST_M = 0.02  # thinner sides are made this thick


def box_of(label, box):
    """A bounding box in CARLA's world, as the file has it. Pitch and roll are enclosed by the reader."""
    numbers = [box.location.x, box.location.y, box.location.z, box.extent.x, box.extent.y, box.extent.z]
    numbers += [box.rotation.yaw, box.rotation.pitch, box.rotation.roll]
    if not all(math.isfinite(number) for number in numbers) or max(abs(number) for number in numbers[3:6]) > 5000.0:
        return None
    x, y, z, *half, yaw, pitch, roll = (round(number, 4) for number in numbers)
    size = [max(2.0 * abs(side), SMALLEST_M) for side in half]
    found = {"label": label, "center_m": [x, -y, z], "size_m": size, "yaw_deg": -yaw}
    found |= {name: angle for name, angle in (("pitch_deg", pitch), ("roll_deg", roll)) if angle}
    return found


def boxes_of(level_boxes):
    """Boxes of all labels. `level_boxes` gives the bounding boxes of a label, as `World.get_level_bbs` does."""
    boxes = []
    for label in LABELS:
        found = [box_of(label, box) for box in level_boxes(getattr(carla.CityObjectLabel, label))]
        boxes += [box for box in found if box]
    return boxes


def corner(location):
    return [round(location.x, 3), round(-location.y, 3), round(location.z, 3)]


def edges(waypoint):
    """Both edges of the lane at a waypoint."""
    right = waypoint.transform.get_right_vector()
    half, at = 0.5 * waypoint.lane_width, waypoint.transform.location
    return [carla.Location(at.x + side * half * right.x, at.y + side * half * right.y, at.z) for side in (-1, 1)]


def pavements(town_map):
    """Quads of all lanes of type Sidewalk."""
    seen, quads = set(), []
    for start in town_map.generate_waypoints(STEP_M):
        for step in ("get_left_lane", "get_right_lane"):
            lane, steps = start, 0
            while lane is not None and steps < 16:
                if lane.lane_type == carla.LaneType.Sidewalk:
                    name = (lane.road_id, lane.section_id, lane.lane_id, round(lane.s / STEP_M))
                    if name not in seen:
                        seen.add(name)
                        quads += piece(lane)
                lane, steps = getattr(lane, step)(), steps + 1
    return quads


def piece(lane):
    """Quads from a waypoint to the next one on its lane, or to the pavements that go on behind its end."""
    if lane.lane_width < 0.2:
        return []
    here = lane.transform.location
    quads, behind = [], []
    for step in (STEP_M + 0.05, 0.95 * STEP_M, 0.5 * STEP_M, 0.2 * STEP_M):  # shorter ones before the end of a road without a next one
        behind = behind or [it for it in lane.next(step) if it.lane_type == lane.lane_type]
    for other in behind:
        (a, b), (d, c) = edges(lane), edges(other)
        # Where the next lane runs the other way, its edges change sides.
        if lane.transform.get_right_vector().dot(other.transform.get_right_vector()) < 0.0:
            c, d = d, c
        if here.distance(other.transform.location) < 2.0 * STEP_M:
            quads.append({"kind": "sidewalk", "outline_m": [corner(it) for it in (a, b, c, d)]})
    return quads


def crossings(town_map):
    """Polygons of `Map.get_crosswalks`: each ends where its first corner comes again."""
    polygons, outline = [], []
    for location in town_map.get_crosswalks():
        if len(outline) > 2 and location.distance(outline[0]) < 0.01:
            polygons.append({"kind": "crossing", "outline_m": [corner(it) for it in outline]})
            outline = []
        else:
            outline.append(location)
    return polygons


def level(level_boxes, town_map):
    """The whole file."""
    walkable = pavements(town_map) + crossings(town_map)
    return {"format": FORMAT, "boxes": boxes_of(level_boxes), "walkable": walkable}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--host", default="localhost")
    parser.add_argument("--port", type=int, default=2000)
    parser.add_argument("--map", help="level to load first; default: the one that the server shows")
    parser.add_argument("--out", type=Path, required=True, help="file to write")
    arguments = parser.parse_args()
    try:
        client = carla.Client(arguments.host, arguments.port)
        client.set_timeout(TIMEOUT_S)
        world = client.load_world(arguments.map) if arguments.map else client.get_world()
        town = level(world.get_level_bbs, world.get_map())
    except RuntimeError as error:
        sys.exit(f"export_level: {error}")
    if not town["walkable"]:
        sys.exit("export_level: the level has no pavements; read its OpenDRIVE file instead")
    arguments.out.write_text(json.dumps(town))
    print(f"{arguments.out}: {len(town['boxes'])} boxes, {len(town['walkable'])} walkable polygons")


if __name__ == "__main__":
    main()
