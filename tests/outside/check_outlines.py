#!/usr/bin/env python3
"""Compares the houses of OpenDRIVE files with their outlines, which this script reads on its own.

Usage: `check_outlines.py INSPECT_JSON FILE...`. INSPECT_JSON is the example `inspect_json` of the room `maps`. Each building with an outline has
boxes there; its footprint has an intersection over union of at least 0.9 in the median. Without guessed roofs its top is the highest corner's, within
0.3 m for 98 in 100, and its foot is no higher than the lowest corner's; guessed roofs only add to it. Bus stops are no houses."""

import json
import math
import statistics
import sys
import tempfile
import xml.etree.ElementTree as ET

import numpy as np
from check_cityjson import things_of
from shapely import STRtree, make_valid, union_all
from shapely.geometry import Polygon
from shared import json_of, overlap


def numbers(element, *names):
    return [float(element.get(name) or 0.0) for name in names]


def cubic(pieces, s):
    """The value of piecewise cubics at a distance; 0 without any."""
    before = [one for one in pieces if one[0] <= s + 1e-9] or pieces[:1] or [[0.0] * 5]
    start, *parts = before[-1]
    return float(np.polyval(parts[::-1], s - start))


class Road:
    """The reference line of a road, by small steps along it."""

    def __init__(self, road):
        pieces = [(numbers(it, "s", "x", "y", "hdg", "length"), it[0]) for it in road.find("planView")]
        self.pieces = sorted(pieces, key=lambda piece: piece[0][0])
        self.heights = sorted(numbers(it, "s", "a", "b", "c", "d") for it in road.iter("elevation"))
        self.rolls = sorted(numbers(it, "s", "a", "b", "c", "d") for it in road.iter("superelevation"))

    def height(self, s, t):
        """Height of the road's plane at a distance along it and to its left."""
        return cubic(self.heights, s) + t * math.sin(cubic(self.rolls, s))

    def at(self, s):
        """Place and direction at a distance along the road."""
        (start, x, y, heading, length), shape = [p for p in self.pieces if p[0][0] <= s + 1e-9 or p is self.pieces[0]][-1]
        way = s - start
        if shape.tag == "paramPoly3":
            p = way / length if shape.get("pRange", "normalized") == "normalized" else way
            u, v = (np.poly1d(numbers(shape, *(f"{part}{axis}" for part in "dcba"))) for axis in "UV")
            u, v, turn = u(p), v(p), math.atan2(v.deriv()(p), u.deriv()(p))
            cos, sin = math.cos(heading), math.sin(heading)
            return x + cos * u - sin * v, y + sin * u + cos * v, heading + turn
        from_bend, to_bend = {
            "line": lambda: (0.0, 0.0),
            "arc": lambda: numbers(shape, "curvature", "curvature"),
            "spiral": lambda: numbers(shape, "curvStart", "curvEnd"),
        }[shape.tag]()
        direction = lambda t: heading + t * (from_bend + 0.5 * t / length * (to_bend - from_bend))
        steps = max(1, math.ceil(abs(way) / 0.02))
        for k in range(steps):
            middle = direction(way * (k + 0.5) / steps)
            x, y = x + way / steps * math.cos(middle), y + way / steps * math.sin(middle)
        return x, y, direction(way)

    def beside(self, s, t):
        x, y, heading = self.at(s)
        return x - t * math.sin(heading), y + t * math.cos(heading)


def ring(road, item, outline):
    """Corners in plan and the heights of their feet and tops."""
    corners = []
    x, y, heading = road.at(float(item.get("s")))
    t, aside, above = numbers(item, "t", "hdg", "zOffset")
    above += road.height(float(item.get("s")), t)
    x, y = x - t * math.sin(heading), y + t * math.cos(heading)
    turn = heading + aside + (math.pi if item.get("orientation") == "-" else 0.0)
    for corner in outline:
        if corner.tag == "cornerLocal":
            u, v, z, height = numbers(corner, "u", "v", "z", "height")
            place = x + math.cos(turn) * u - math.sin(turn) * v, y + math.sin(turn) * u + math.cos(turn) * v
            corners.append((place, above + z, above + z + height))
        elif corner.tag == "cornerRoad":
            s, t, dz, height = numbers(corner, "s", "t", "dz", "height")
            foot = road.height(s, t) + dz
            corners.append((road.beside(s, t), foot, foot + height))
    return corners


def houses(path):
    """Footprint, foot and top of each building that has an outline."""
    for element in ET.parse(path).getroot().iter("road"):
        road = Road(element)
        for item in element.iter("object"):
            if item.get("type") != "building" or "busstop" in (item.get("name") or "").lower():
                continue
            rings = [(it.get("outer") != "false", ring(road, item, it)) for it in item.iter("outline")]
            rings = [(outer, corners) for outer, corners in rings if len(corners) >= 3]
            shapes = [(outer, make_valid(Polygon([place for place, *_ in corners]))) for outer, corners in rings]
            if not shapes:
                continue
            plan = union_all([shape for outer, shape in shapes if outer])
            plan = plan.difference(union_all([shape for outer, shape in shapes if not outer]))
            corners = [corner for outer, some in rings if outer for corner in some]
            if plan.area > 1.0:
                yield item.get("id"), plan, min(foot for _, foot, _ in corners), max(top for *_, top in corners)


def town_of(inspect, path, roofs):
    """Plan, foot and top of each building's boxes, in the file's frame."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as options:
        json.dump({"roofs": roofs}, options)
        options.flush()
        town = json_of(inspect, path, options.name)
    lift = town["offset_m"][2]
    return [(plan, low + lift, high + lift) for plan, low, high, _ in things_of(town, "Building")]


def compare(truth, found):
    """Intersection over union, and feet and tops above the truth's, by building."""
    tree = STRtree([plan for plan, *_ in found])
    overlaps, feet, tops = [], [], []
    for _, plan, foot, top in truth:
        share, best = max(((overlap(found[k][0], plan), k) for k in tree.query(plan, "intersects")), default=(0.0, None))
        overlaps.append(share)
        if best is not None:
            feet.append(found[best][1] - foot)
            tops.append(found[best][2] - top)
    return overlaps, feet, tops


inspect, *paths = sys.argv[1:]
for path in paths:
    name, truth = path.rsplit("/", 1)[-1], list(houses(path))
    if not truth:
        print(f"{name}: no outlines of buildings")
        continue
    flat, pitched = (compare(truth, town_of(inspect, path, roofs)) for roofs in ("flat", "pitched"))
    overlaps, feet, tops = flat
    missing = [identity for (identity, *_), share in zip(truth, overlaps) if share == 0.0]
    off = [one for one in tops if abs(one) > 0.3]
    median, added = statistics.median(overlaps), statistics.median(pitched[2])
    print(
        f"{name}: {len(truth)} outlines; footprints: median {median:.3f}, least {min(overlaps):.3f}; feet {statistics.median(feet):+.2f} m, "
        f"tops {statistics.median(tops):+.2f} m, {len(off)} off by more than 0.3 m; with guessed roofs {added:+.2f} m"
    )
    assert not missing, f"{name}: no boxes at {missing[:5]}"
    assert median >= 0.9, f"{name}: {median}"
    assert len(off) <= 0.02 * len(truth), f"{name}: {len(off)} tops are off: {off[:5]}"
    assert max(feet) < 0.1, f"{name}: a house hangs {max(feet):.2f} m over its lowest corner"
    assert added >= -0.01, f"{name}: guessed roofs take {added} m away"
