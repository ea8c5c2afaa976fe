#!/usr/bin/env python3
"""Compares towns read from CityJSON with the files themselves, which this script parses on its own as plain JSON.

Usage: `check_cityjson.py INSPECT_JSON FILE...`. INSPECT_JSON is the example `inspect_json` of the room `maps`. For each file: every building is
there, its footprint (the ground surface, else the lowest level faces) has an intersection over union of at least 0.9 in the median, its plan with the
roofs that reach over it one of at least 0.97, and its lowest and highest points agree within 0.3 m; footpaths and roads cover the same ground."""

import json
import sys
from pathlib import Path

import numpy as np
from shapely import STRtree, make_valid, union_all
from shapely.geometry import Polygon
from shared import ground_of_boxes, json_of, overlap


def faces_of(geometry):
    """(semantic kind, rings of vertex indices) of each face of a geometry."""
    depth = {"MultiSurface": 1, "CompositeSurface": 1, "Solid": 2, "MultiSolid": 3, "CompositeSolid": 3}
    boundaries, values = geometry["boundaries"], geometry.get("semantics", {}).get("values")
    for _ in range(depth[geometry["type"]] - 1):
        boundaries = [face for shell in boundaries for face in shell]
        values = values and [value for shell in values for value in (shell or [])]
    surfaces = geometry.get("semantics", {}).get("surfaces", [])
    kinds = [surfaces[v]["type"] if v is not None else None for v in values] if values else [None] * len(boundaries)
    return zip(kinds, boundaries)


def polygon(rings, points):
    """A face in plan, y to the north; none without an area."""
    outer, *holes = [[tuple(points[i][:2]) for i in ring] for ring in rings]
    shape = make_valid(Polygon(outer, holes))
    return shape if shape.area > 1e-6 else None


def vertical_share(rings, points):
    ring = points[rings[0]]
    normal = sum(np.cross(ring[i] - ring[0], ring[i + 1] - ring[0]) for i in range(1, len(ring) - 1))
    length = np.linalg.norm(normal)
    return abs(normal[2]) / length if length > 1e-9 else 0.0


class Source:
    def __init__(self, path):
        self.file = json.loads(Path(path).read_text(encoding="utf-8"))
        transform = self.file.get("transform", {"scale": [1, 1, 1], "translate": [0, 0, 0]})
        self.points = np.array(self.file["vertices"], float) * transform["scale"] + transform["translate"]

    def objects(self, *kinds):
        return {name: it for name, it in self.file["CityObjects"].items() if it["type"] in kinds and it.get("geometry")}

    def buildings(self):
        """Footprint, plan with the roofs, lowest and highest point of each building with its parts."""
        groups = {}
        for name, it in self.objects("Building", "BuildingPart").items():
            groups.setdefault(it.get("parents", [name])[0], []).append(it)
        for name, members in sorted(groups.items()):
            lows, highs, footprints, plans = [], [], [], []
            for it in members:
                faces = [face for geometry in it["geometry"] for face in faces_of(geometry)]
                # Roofs without an area, at the height of a neighbour, are slips of the survey.
                level = [rings for _, rings in faces if vertical_share(rings, self.points) >= 0.1]
                level = [rings for rings in level if (shape := polygon(rings, self.points)) and shape.area > 1e-3]
                lows += [self.points[i][2] for _, rings in faces for i in rings[0]]
                highs += [self.points[i][2] for rings in level or [r for _, r in faces] for i in rings[0]]
                footprints += self.footprint(faces)
                plans += [polygon(rings, self.points) for rings in level]
            yield name, union_all(footprints), union_all(footprints + plans), min(lows), max(highs)

    def footprint(self, faces):
        ground = [rings for kind, rings in faces if kind == "GroundSurface"]
        level = [rings for _, rings in faces if vertical_share(rings, self.points) >= 0.1]
        lowest = min((self.points[i][2] for rings in level for i in rings[0]), default=0.0)
        if not ground:
            ground = [rings for rings in level if max(self.points[i][2] for i in rings[0]) <= lowest + 0.3] or level
        return [shape for shape in (polygon(rings, self.points) for rings in ground) if shape]


def things_of(town, kind):
    """Plan, lowest and highest point of each thing's boxes."""
    groups = {}
    for box in town["boxes"]:
        if box["kind"] == kind:
            groups.setdefault(box["object"], []).append(box)
    for boxes in groups.values():
        plan = union_all(list(ground_of_boxes(boxes, town["offset_m"], -1)))
        low = min(box["center_m"][2] - box["half_m"][2] for box in boxes)
        yield plan, low, max(box["center_m"][2] + box["half_m"][2] for box in boxes), len(boxes)


def check_buildings(name, source, town):
    truth = list(source.buildings())
    things = list(things_of(town, "Building"))
    assert len(truth) == len(things), f"{name}: {len(truth)} buildings in the file, {len(things)} in the town"
    tree = STRtree([plan for plan, *_ in things])
    found, missing = [], []
    for identity, footprint, whole, low, high in truth:
        share, best = max(((overlap(things[at][0], footprint), at) for at in tree.query(footprint, "intersects")), default=(0.0, None))
        if best is None:
            missing.append(identity)
        else:
            found.append((share, overlap(things[best][0], whole), things[best][1] - low, things[best][2] - high))
    overlaps, plans, lows, highs = np.array(found).T
    boxes = sum(count for *_, count in things)
    print(
        f"{name}: {len(truth)} buildings, {boxes} boxes; footprints: median {np.median(overlaps):.3f}, least {min(overlaps):.3f}; "
        f"with roofs: median {np.median(plans):.3f}, least {min(plans):.3f}; base {np.median(lows):+.3f} m, top {np.median(highs):+.3f} m"
    )
    off = np.mean((np.abs(highs) > 0.3) | (np.abs(lows) > 0.3))
    assert not missing, f"{name}: no boxes at {missing[:5]}"
    assert np.median(overlaps) >= 0.9 and np.median(plans) >= 0.97, f"{name}: {np.median(overlaps)}, {np.median(plans)} with the roofs"
    assert off <= 0.02, f"{name}: {off:.3f} of the buildings are too high or low"


def check_ground(name, source, town):
    walks = {"voetpad", "voetgangersgebied", "voetpad op trap"}
    for kind, is_of_kind in (("Sidewalk", lambda f: f in walks), ("Road", lambda f: f not in walks)):
        roads = [it for it in source.objects("Road").values() if is_of_kind(it["attributes"].get("function"))]
        faces = [polygon(rings, source.points) for it in roads for geometry in it["geometry"] for _, rings in faces_of(geometry)]
        truth = union_all([face for face in faces if face])
        offset = town["offset_m"]
        outlines = [it["outline_m"] for it in town["walkable"] if it["kind"] == kind]
        found = union_all([make_valid(Polygon([(x + offset[0], -(y + offset[1])) for x, y, _ in it])) for it in outlines])
        if truth.area == 0.0:
            continue
        print(f"{name}: {kind} {truth.area:.0f} m2, intersection over union {overlap(truth, found):.3f}")
        assert overlap(truth, found) > 0.97, f"{name}: {kind} {overlap(truth, found)}"


if __name__ == "__main__":
    for path in sys.argv[2:]:
        described = path.rsplit("/", 1)[-1], Source(path), json_of(sys.argv[1], path)
        check_buildings(*described)
        check_ground(*described)
