"""Towns of point clouds against the clouds themselves, which laspy reads: `check_clouds.py INSPECT_JSON FILE...`.

INSPECT_JSON is the example of `cosfly-maps`. Points of buildings must lie in boxes or within 0.5 m of one, points of the ground in none; the surface
of the ground must pass through them; open ground must be walkable."""

import sys
import tempfile

import laspy
import numpy as np
from scipy.spatial import cKDTree
from shapely import Polygon, contains_xy
from shared import ground_of_boxes, json_of

FOOT = 0.3048


def distance_to_boxes(points, boxes, most):
    """Distance of each point to the nearest box, at most `most`."""
    out = np.full(len(points), most)
    order = np.argsort(points[:, 0])
    sorted_x = points[order, 0]
    for box in boxes:
        center, half, cos, sin = np.array(box["center_m"]), np.array(box["half_m"]), np.cos(box["yaw_rad"]), np.sin(box["yaw_rad"])
        reach = np.hypot(half[0], half[1]) + most
        near = order[slice(*np.searchsorted(sorted_x, [center[0] - reach, center[0] + reach]))]
        near = near[np.abs(points[near, 1] - center[1]) <= reach]
        away = points[near] - center
        local = np.stack([cos * away[:, 0] + sin * away[:, 1], cos * away[:, 1] - sin * away[:, 0], away[:, 2]], axis=1)
        outside = np.abs(local) - half
        distance = np.linalg.norm(np.maximum(outside, 0), axis=1)
        # Inside: the depth, negative.
        distance = np.where((outside < 0).all(axis=1), outside.max(axis=1), distance)
        out[near] = np.minimum(out[near], distance)
    return out


def ground_error(surfaces, points):
    """Median distance of points of the ground, of some thousands of them, to the nearest vertex of its surface in plan, metres."""
    vertices = np.concatenate([np.array(one["vertices_m"]) for one in surfaces if not one["synthetic"]])
    some = points[:: max(1, len(points) // 4000)]
    _, nearest = cKDTree(vertices[:, :2]).query(some[:, :2], distance_upper_bound=16.0)
    there = nearest < len(vertices)
    return float(np.median(np.abs(vertices[nearest[there], 2] - some[there, 2])))


def check(inspect, path):
    report = json_of(inspect, path, "--surfaces")
    cloud = laspy.read(path)
    unit = FOOT if any(b"foot" in vlr.record_data_bytes().lower() for vlr in cloud.header.vlrs if vlr.record_id == 2112) else 1.0
    x, y, z = (np.asarray(values) * unit for values in (cloud.x, cloud.y, cloud.z))
    points = np.stack([x, -y, z], axis=1) - np.array(report["offset_m"])
    classes = np.asarray(cloud.classification)
    boxes = report["boxes"]
    buildings = [box for box in boxes if box["kind"] == "Building"]
    failures = []

    def expect(what, value, holds):
        print(f"  {what}: {value}")
        if not holds:
            failures.append(f"{path}: {what}: {value}")

    print(path, report["counts"], "planning boxes", report["planning_boxes"], "plazas", len(report["walkable"]))
    for line in report["notes"] + report["warnings"]:
        print("   ", line)
    low, high = points.min(axis=0), points.max(axis=0)
    expect("extent of points in the bounds", low, (low >= np.array(report["min_m"]) - 1.0).all())
    expect("to", high, (high <= np.array(report["max_m"]) + 1.0).all())
    roofs = points[classes == 6]
    if len(roofs):
        distance = distance_to_boxes(roofs, buildings, 5.0)
        inside = float((distance <= 0.5).mean())
        expect("points of buildings within 0.5 m of a box of a building", round(inside, 4), inside >= 0.99)
        print(f"  in a box: {(distance <= 0).mean():.4f}; median depth {-np.median(distance):.2f} m")
        top = max(box["center_m"][2] + box["half_m"][2] for box in buildings)
        expect("highest box above the highest point of a building, m", round(top - roofs[:, 2].max(), 3), abs(top - roofs[:, 2].max()) < 0.01)
        # Area of the boxes' footprints against cells of 1 m that hold points of buildings.
        covered = roof_cells(buildings)
        cells = {tuple(cell) for cell in np.floor(roofs[:, :2]).astype(int)}
        share = len(cells - covered) / len(cells)
        expect("cells of 1 m with roof that no building covers", round(share, 4), share < 0.1)
        if len(roofs) > 8 * len(cells):
            share = len(covered & cells) / len(covered | cells)
            expect("intersection over union of roof cells and covered cells", round(share, 3), share >= 0.9)
    ground = points[classes == 2]
    outside = float((distance_to_boxes(ground, boxes, 1.0) >= 0).mean())
    expect("points of the ground outside all boxes", round(outside, 4), outside >= 0.99)
    error = ground_error(report["surfaces"], ground)
    expect("median distance of points of the ground to its surface, m", round(error, 3), error < 0.3)
    plants = points[(classes >= 4) & (classes <= 5)]
    if len(plants):
        crowns = [box for box in boxes if box["kind"] in ("TreeCrown", "Bush", "Building")]
        near = float((distance_to_boxes(plants, crowns, 5.0) <= 0.5).mean())
        expect("points of plants within 0.5 m of a crown", round(near, 4), near >= 0.9)
    area = sum(Polygon(one["outline_m"]).area for one in report["walkable"])
    extent = np.ptp(points[:, :2], axis=0).prod()
    expect("walkable share of the extent", round(area / extent, 3), area / extent > 0.05)
    return failures


def check_without_classes(inspect, path):
    """The ground is estimated where a file has no classes: its classes are taken away, and judge what comes out."""
    cloud = laspy.read(path)
    classes = np.array(cloud.classification)
    if not (classes == 6).any():
        return []
    cloud.classification[:] = 1
    with tempfile.TemporaryDirectory() as folder:
        stripped = f"{folder}/stripped.laz"
        cloud.write(stripped)
        report = json_of(inspect, stripped, "--surfaces")
    points = np.stack([np.asarray(cloud.x), -np.asarray(cloud.y), np.asarray(cloud.z)], axis=1) - np.array(report["offset_m"])
    ground = points[classes == 2]
    error = ground_error(report["surfaces"], ground)
    outside = float((distance_to_boxes(ground, report["boxes"], 1.0) >= 0).mean())
    roofs = points[classes == 6]
    held = float((distance_to_boxes(roofs, report["boxes"], 5.0) <= 0.5).mean())
    buildings = [box for box in report["boxes"] if box["kind"] == "Building"]
    found = float((distance_to_boxes(roofs, buildings, 5.0) <= 0.5).mean())
    print(f"  without classes: ground {error:.3f} m off, {outside:.4f} of it outside all boxes; roofs {held:.4f} in boxes, {found:.3f} in buildings")
    is_good = error < 0.1 and outside >= 0.99 and held >= 0.9
    return [] if is_good else [f"{path}: the estimated ground or what stands on it is off"]


def roof_cells(buildings):
    """Cells of 1 m whose middle lies in the footprint of a building's box."""
    cells = set()
    for shape in ground_of_boxes(buildings):
        west, south, east, north = np.floor(shape.bounds).astype(int)
        column, row = (grid.ravel() for grid in np.meshgrid(np.arange(west, east + 1), np.arange(south, north + 1)))
        hit = contains_xy(shape, column + 0.5, row + 0.5)
        cells.update(zip(column[hit].tolist(), row[hit].tolist()))
    return cells


sys.exit("\n".join(one for path in sys.argv[2:] for test in (check, check_without_classes) for one in test(sys.argv[1], path)) or 0)
