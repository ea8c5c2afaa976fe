#!/usr/bin/env python3
"""Simulates traffic with the real SUMO on nets that its `netconvert` makes of our towns, and compares what our reader of floating-car data says,
frame by frame, with the file as Python reads it.

Usage: `check_sumo.py FCD_FRAMES FILE.xodr...`. Positions and angles must agree to a millimetre and a milliradian: at SUMO's own steps, and between
them where frames lie between steps. Cars must drive on the lanes that our reader of maps finds, too, but at dead ends: there `netconvert` drops the
ways around a turning circle, and SUMO turns on the spot."""

import csv
import io
import json
import math
import random
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

import sumo
from shared import require, run

sys.path.append(str(Path(sumo.SUMO_HOME) / "tools"))
import sumolib  # noqa: E402

SIZES = {
    "car": ("passenger", "car", [4.6, 1.8, 1.5]),
    "van": ("delivery", "van", [5.5, 2.0, 2.4]),
    "line": ("bus", "bus", [12.0, 2.5, 3.1]),
    "cycle": ("bicycle", "bicycle", [1.8, 0.65, 1.75]),
}
STEP_S = 0.5
END_S = 90
# Where SUMO turns on the spot: this far from the middle of a dead end, which lies in our turning circle.
TURNS_M = 12.0
LEAST_ON_LANE = 0.99


def tool(name):
    return Path(sumo.SUMO_HOME) / "bin" / name


def trips(net, stream):
    """Trips of all types between random edges, and people who walk along edges."""
    edges = [edge for edge in net.getEdges() if edge.getFunction() == "" and edge.getLength() > 20]
    lines = ["<routes>"]
    for name, (kind, _, (length, width, height)) in SIZES.items():
        lines.append(f'<vType id="{name}" vClass="{kind}" length="{length}" width="{width}" height="{height}"/>')
    for number in range(120):
        name = stream.choice(list(SIZES))
        kind = SIZES[name][0]
        open_to = [edge for edge in edges if edge.allows(kind)]
        if len(open_to) < 2:
            continue
        start, end = stream.sample(open_to, 2)
        if net.getShortestPath(start, end, vClass=kind)[0] is None:
            continue
        lines.append(f'<trip id="{name}.{number}" type="{name}" depart="{number * 0.4:.2f}" from="{start.getID()}" to="{end.getID()}"/>')
        if number % 4 == 0:
            walked = [edge for edge in edges if edge.allows("pedestrian")]
            if walked:
                edge = stream.choice(walked).getID()
                lines.append(f'<person id="p{number}" depart="{number * 0.4:.2f}"><walk edges="{edge}" departPos="1" arrivalPos="-1"/></person>')
    return "\n".join([*lines, "</routes>"])


def samples(fcd, offset):
    """World positions by time and name: middle, yaw, speed."""
    steps = {}
    for step in ElementTree.parse(fcd).getroot().iter("timestep"):
        bodies = steps[round(float(step.get("time")), 6)] = {}
        for body in step:
            angle = math.radians(float(body.get("angle")))
            ahead = (math.sin(angle), math.cos(angle))
            back = 0.0 if body.tag == "person" else 0.5 * SIZES[body.get("type")][2][0]
            x = float(body.get("x")) - offset[0] - back * ahead[0]
            y = float(body.get("y")) - offset[1] - back * ahead[1]
            bodies[body.get("id")] = (x, -y, math.atan2(-ahead[1], ahead[0]), float(body.get("speed")))
    return steps


def turned(angle):
    return math.remainder(angle, 2 * math.pi)


def expected(steps, time):
    """Everybody who is in the step before and the step after a time."""
    before = round(math.floor(time / STEP_S + 1e-9) * STEP_S, 6)
    share = (time - before) / STEP_S
    here = steps.get(before, {})
    if share < 1e-9:
        return here
    after, out = steps.get(round(before + STEP_S, 6), {}), {}
    for name in here.keys() & after.keys():
        ways = [b - a for a, b in zip(here[name], after[name])]
        ways[2] = turned(ways[2])
        out[name] = [a + share * way for a, way in zip(here[name], ways)]
    return out


def dead_ends(read):
    """World positions (y north) of the nodes at which cars can only turn back."""
    offset = read.getLocationOffset()
    ends = []
    for node in read.getNodes():
        ways = [way for edge in node.getIncoming() for ways in edge.getOutgoing().values() for way in ways if way.getFromLane().allows("passenger")]
        if ways and all(way.getDirection() == "t" for way in ways):
            ends.append([node.getCoord()[axis] - offset[axis] for axis in (0, 1)])
    return ends


def compare(frames_of, town, net, fcd, steps, dt, ends):
    frames = int(END_S / dt)
    config = {"types": {name: {"kind": kind, "size_m": size} for name, (_, kind, size) in SIZES.items()}}
    table = run(frames_of, town, net, fcd, dt, frames, json.dumps(config))
    rows = list(csv.DictReader(io.StringIO(table)))
    seen, off = defaultdict(set), []
    for row in rows:
        frame = int(row["frame"])
        there = expected(steps, frame * dt)
        require(row["source"] in there, f"{row['source']} is in frame {frame}, but not in the file at {frame * dt} s")
        x, y, yaw, speed = there[row["source"]]
        away_m = math.hypot(float(row["x"]) - x, float(row["y"]) - y)
        off.append((away_m, abs(turned(float(row["heading_rad"]) - yaw)), abs(float(row["speed_mps"]) - speed)))
        seen[frame].add(row["source"])
    for frame in range(frames):
        missing = set(expected(steps, frame * dt)) - seen[frame]
        require(not missing, f"frame {frame} lacks {sorted(missing)[:5]}")
    worst_m, worst_rad, worst_mps = map(max, zip(*off))
    turns = lambda row: any(math.hypot(float(row["x"]) - x, float(row["y"]) + y) < TURNS_M for x, y in ends)
    cars = [row for row in rows if row["kind"] in ("car", "van", "bus")]
    off_lane = [float(row["from_lane_m"]) for row in cars if not turns(row)]
    require(max(worst_m, worst_rad, worst_mps) < 1e-3, f"off by {worst_m} m, {worst_rad} rad, {worst_mps} m/s")
    on_lane = sum(away < 1.0 for away in off_lane) / len(off_lane)
    require(on_lane >= LEAST_ON_LANE, f"only {on_lane:.4f} of the cars' places lie within 1 m of our lanes")
    require(len(off_lane) >= 0.75 * len(cars), f"{len(cars) - len(off_lane)} of {len(cars)} places of cars are at dead ends")
    kinds = sorted({row["kind"] for row in rows})
    print(
        f"ok  {Path(town).name} at {dt} s: {len(rows)} states in {frames} frames ({', '.join(kinds)}), off by at most "
        f"{1000 * worst_m:.2f} mm and {1000 * worst_rad:.2f} mrad; {100 * on_lane:.1f} % of {len(off_lane)} fronts of cars within 1 m of our "
        f"lanes, without {len(cars) - len(off_lane)} at {len(ends)} dead ends",
        flush=True,
    )


frames_of, *towns = sys.argv[1:]
for town in towns:
    with tempfile.TemporaryDirectory() as folder:
        net, routes, fcd = (Path(folder) / name for name in ("town.net.xml", "trips.xml", "fcd.xml"))
        run(tool("netconvert"), "--opendrive", town, "-o", net, "--sidewalks.guess", "--no-warnings")
        read = sumolib.net.readNet(str(net))
        routes.write_text(trips(read, random.Random(7)))
        run(
            tool("sumo"), "-n", net, "-r", routes, "--fcd-output", fcd, "--step-length", STEP_S, "--end", END_S + 1,
            "--ignore-route-errors", "--no-step-log", "--no-warnings", "--precision", 6, "--seed", 7,
        )  # fmt: skip
        for dt in (STEP_S, 0.2):
            compare(frames_of, town, net, fcd, samples(fcd, read.getLocationOffset()), dt, dead_ends(read))
