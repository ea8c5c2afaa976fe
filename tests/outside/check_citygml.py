#!/usr/bin/env python3
"""Compares the town of a surveyed OpenDRIVE file with a CityGML model of the same houses; no code is shared with cosfly.

    check_citygml.py INSPECT_JSON MAP.xodr CITYGML...

INSPECT_JSON is the example `inspect_json` of the room `maps`. Both files must be in one projection.

The town is judged by the survey's outlines: it cannot be truer than they are. How far these are from the model is printed
for houses one by one, and for groups: what is one outline in one file may be several houses in the other one.
"""

import statistics
import sys
import xml.etree.ElementTree as xml

import check_outlines
import numpy as np
from check_cityjson import things_of
from shapely import STRtree, make_valid, union_all
from shapely.geometry import Polygon
from shared import json_of


def local(element):
    return element.tag.rsplit("}", 1)[-1]


def rings_of(surface):
    """Rings of coordinates of a surface: positions in one list, or one element a position."""
    for ring in (one for one in surface.iter() if local(one) == "LinearRing"):
        text = " ".join(one.text for one in ring if local(one) in ("posList", "pos"))
        yield np.array(text.split(), float).reshape(-1, 3)


def houses(path):
    """(footprint, lowest, highest point) of each building of a CityGML file, in its projection."""
    for building in (one for one in xml.parse(path).iter() if local(one) == "Building"):
        kinds = {"GroundSurface": [], "RoofSurface": [], "WallSurface": []}
        for surface in building.iter():
            if local(surface) in kinds:
                kinds[local(surface)] += rings_of(surface)
        grounds, roofs, walls = kinds.values()
        plan = [make_valid(Polygon(ring[:, :2])) for ring in grounds or roofs]
        footprint = union_all([shape for shape in plan if shape.area > 1e-6])
        if roofs and footprint.area >= 1.0:
            low = min(ring[:, 2].min() for ring in grounds + walls + roofs)
            yield footprint, low, max(ring[:, 2].max() for ring in roofs)


def overlap(one, other):
    return one.intersection(other).area / one.union(other).area


def groups(left, right):
    """Places in `left` and `right` of shapes that belong together: the smaller one of a pair lies in the other by half or more."""
    tree, parent = STRtree(right), list(range(len(left) + len(right)))

    def root(at):
        return at if parent[at] == at else root(parent[at])

    for at, shape in enumerate(left):
        for other in tree.query(shape, "intersects"):
            shared = shape.intersection(right[other]).area
            if shared >= 0.5 * min(shape.area, right[other].area):
                parent[root(at)] = root(len(left) + int(other))
    found = {}
    for at in range(len(parent)):
        found.setdefault(root(at), ([], []))[at >= len(left)].append(at if at < len(left) else at - len(left))
    return [pair for pair in found.values() if pair[0] and pair[1]]


def quartiles(values):
    low, middle, high = statistics.quantiles(values, n=4)
    return f"median {middle:.2f}, quartiles {low:.2f} to {high:.2f} of {len(values)}"


def main():
    inspect, survey, *models = sys.argv[1:]
    things = list(things_of(json_of(inspect, survey), "Building"))
    plans, (names, drawn) = [plan for plan, *_ in things], zip(*(house[:2] for house in check_outlines.houses(survey)))
    tree = STRtree(plans)
    fidelity = [max((overlap(shape, plans[at]) for at in tree.query(shape, "intersects")), default=0.0) for shape in drawn]
    print(f"town and outlines of the survey, intersection over union: {quartiles(fidelity)}, least {min(fidelity):.2f}")

    bad = [f"{name}: {share:.2f}" for name, share in zip(names, fidelity) if share < 0.7]
    print(f"  less than 0.7: {', '.join(bad) or 'none'}")

    truth = [house for path in models for house in houses(path)]
    shapes = [shape for shape, *_ in truth]
    drawn_tree = STRtree(drawn)
    medians = []
    for name, others, index in (("town", plans, tree), ("outlines of the survey", drawn, drawn_tree)):
        single = [max((overlap(shape, others[at]) for at in index.query(shape, "intersects")), default=0.0) for shape in shapes]
        medians.append(statistics.median(single))
        pairs = groups(shapes, others)
        grouped = [overlap(union_all([shapes[at] for at in a]), union_all([others[at] for at in b])) for a, b in pairs]
        print(f"{name} and the model's houses: {quartiles(single)}; in groups: {quartiles(grouped)}")
    pairs = groups(shapes, plans)
    print(f"houses of the model: {len(shapes)}, of them in no group: {len(shapes) - sum(len(a) for a, _ in pairs)}")
    bases = [min(things[at][1] for at in b) - min(truth[at][1] for at in a) for a, b in pairs]
    tops = [max(things[at][2] for at in b) - max(truth[at][2] for at in a) for a, b in pairs]
    print(f"base above the model's, m: {quartiles(bases)}; top above the model's, m: {quartiles(tops)}")
    assert statistics.median(fidelity) >= 0.9 and min(fidelity) >= 0.7, "the town is not as the survey draws it"
    assert abs(medians[0] - medians[1]) <= 0.02, "the town is further from the model than the survey is"
    assert abs(statistics.median(bases)) <= 0.5 and abs(statistics.median(tops)) <= 1.0, "heights are off"


main()
