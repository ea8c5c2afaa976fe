"""Towns of OpenStreetMap extracts against what pyosmium, PROJ and GEOS make of the same files.

Usage: `check_osm.py INSPECT FOLDER`. INSPECT is the example `inspect_json` of cosfly-maps, FOLDER holds extracts. Compared are counts of buildings,
trees and lamps, footprints (intersection over union), stated heights, and whether the middle lines of footpaths are walkable."""

import math
import statistics
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

import numpy
import osmium
from pyproj import Proj
from shapely import Point, Polygon, STRtree, distance, get_coordinates, points, transform, wkb
from shapely.ops import unary_union
from shared import ground_of_boxes, json_of, overlap

STOREY_M, BUILDING_MARGIN_M, THING_MARGIN_M = 3.0, 1000.0, 100.0
# Widest half of a street, beyond which a path that ends at its middle line has reached the kerb.
KERB_M = 8.0
PATHS = ("footway", "steps", "pedestrian", "path")
STREETS = (
    "motorway trunk primary secondary tertiary unclassified residential road living_street service motorway_link trunk_link "
    "primary_link secondary_link tertiary_link busway"
).split()
NOT_THERE = ("proposed", "planned", "demolished", "destroyed", "razed", "removed", "underground")


def rows(path):
    """Building areas, stretches of footpaths, trees and lamps of a file, in degrees.

    Ends of a stretch where its path ends at a street, and no other path goes on there, are marked: it ends at the kerb.
    """
    factory = osmium.geom.WKBFactory()
    areas, paths, points = [], [], []
    streets, arms, crossings = set(), Counter(), set()
    for one in in_order(path):
        tags = dict(one.tags)
        if one.is_node() and one.location.valid():
            if tags.get("natural") == "tree" or tags.get("highway") == "street_lamp":
                points.append((tags, one.location.lon, one.location.lat))
            if tags.get("highway") == "crossing":
                crossings.add(one.id)
        elif one.is_way() and tags.get("highway") in STREETS:
            streets.update(node.ref for node in one.nodes)
        elif one.is_way() and tags.get("highway") in PATHS and not is_area(tags) and not is_hidden(tags) and tags.get("foot") != "no":
            known = [(node.ref, (node.lon, node.lat)) if node.location.valid() else (node.ref, None) for node in one.nodes]
            refs = [ref for ref, _ in known]
            arms.update(refs[:-1] + refs[1:])
            if tags["highway"] != "path":
                paths += [pair for pair in zip(known, known[1:]) if all(place for _, place in pair)]
        elif one.is_area() and any(tags.get(key, "no") != "no" for key in ("building", "building:part")):
            name = f"{'way' if one.from_way() else 'relation'} {one.orig_id()}"
            areas += [(name, tags, polygon) for polygon in wkb.loads(factory.create_multipolygon(one), hex=True).geoms]
    ends = {ref for ref, count in arms.items() if count == 1 and ref in streets and ref not in crossings}
    return areas, [[(place, ref in ends) for ref, place in pair] for pair in paths], points


def in_order(path):
    """The content of a file with its areas; pyosmium makes them of content that is sorted by kind and number."""
    with tempfile.TemporaryDirectory() as folder:
        out, reader = f"{folder}/sorted.osm.pbf", osmium.MergeInputReader()
        with osmium.SimpleWriter(out) as writer:
            reader.add_file(str(path))
            reader.apply(writer)
        yield from osmium.FileProcessor(out).with_locations().with_areas()


def is_area(tags):
    return tags.get("area") == "yes" or "area:highway" in tags


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return None


def is_below(tags):
    return any((number(tags.get(key)) or 0) < 0 for key in ("layer", "level"))


def is_hidden(tags):
    indoor = tags.get("indoor", "no") != "no" or tags.get("location") in ("underground", "indoor")
    return is_below(tags) or indoor or tags.get("tunnel", "no") not in ("no", "building_passage", "avalanche_protector")


def is_kept(tags):
    return tags.get("location") != "underground" and not is_below(tags) and tags.get("building") not in NOT_THERE


def stated_top_m(tags):
    levels = number(tags.get("building:levels"))
    if number(tags.get("height")):
        return number(tags["height"])
    if levels and not any(key in ("height", "est_height", "building:height") or key.startswith("roof:") for key in tags):
        return levels * STOREY_M
    return None


def union_of(shapes, index, shape):
    """Plan of the boxes that touch a shape."""
    return unary_union([shapes[at] for at in index.query(shape, predicate="intersects")])


class Town:
    """A town as `inspect_json` prints it, and the extract in its frame."""

    def __init__(self, inspect, path):
        self.name = path.name
        self.town = json_of(inspect, path)
        assert self.town["format"] == "OpenStreetMap", self.town["format"]
        projection = Proj(self.town["geo_reference"])
        self.plan = lambda lon, lat: (lambda x, y: (x, -y))(*projection(lon, lat))
        areas, paths, points = rows(path)
        moved = lambda shape: transform(shape, lambda at: numpy.column_stack(self.plan(at[:, 0], at[:, 1])))
        self.areas = [(name, tags, moved(shape)) for name, tags, shape in areas if is_kept(tags)]
        self.paths = [[(*self.plan(*place), is_end) for place, is_end in pair] for pair in paths]
        self.points = [(tags, self.plan(lon, lat)) for tags, lon, lat in points]
        box = osmium.io.Reader(str(path)).header().box()
        corners = [self.plan(lon, lat) for lon in (box.bottom_left.lon, box.top_right.lon) for lat in (box.bottom_left.lat, box.top_right.lat)]
        self.low, self.high = ([pick(corner[axis] for corner in corners) for axis in (0, 1)] for pick in (min, max))

    def holds(self, point, margin):
        return all(low - margin <= at <= high + margin for low, at, high in zip(self.low, point, self.high))

    def check(self):
        boxes = [box for box in self.town["boxes"] if box["kind"] == "Building"]
        shapes = list(ground_of_boxes(boxes))
        index = STRtree(shapes)
        near = [(name, tags, shape) for name, tags, shape in self.areas if any(self.holds(at, BUILDING_MARGIN_M) for at in shape.exterior.coords)]
        outlines = [one for one in near if one[1].get("building", "no") != "no"]
        parts = [one for one in near if one[1].get("building:part", "no") != "no"]
        outline_index = STRtree([shape for _, _, shape in outlines])
        parents = [[int(at) for at in outline_index.query(shape.representative_point(), predicate="within")] for _, _, shape in parts]
        expected = len(outlines) + sum(not own for own in parents)
        objects = len({box["object"] for box in boxes})
        assert abs(objects - expected) <= max(2, 0.01 * expected), f"{self.name}: {objects} buildings, the file has {expected}"

        of_parent, overlaps, heights = defaultdict(list), [], []
        for part, own in zip(parts, parents):
            for parent in own:
                of_parent[parent].append(part)
        for number_, (name, tags, shape) in enumerate(outlines):
            own = of_parent[number_]
            covered = unary_union([part for _, _, part in own]).intersection(shape).area / shape.area if own else 0.0
            if covered < 0.4 or not own:
                overlaps.append((self.overlap(shape, shapes, index, boxes), name))
                heights += self.height(name, tags, shape, shapes, index, boxes) if not own else []
        for name, tags, shape in parts:
            heights += self.height(name, tags, shape, shapes, index, boxes)
        # Of nothing it is no number, which is neither above nor below a limit.
        median = lambda values: statistics.median(values) if values else math.nan
        middle = median([value for value, _ in overlaps])
        assert not middle < 0.9, f"{self.name}: median overlap {middle:.3f}, worst {sorted(overlaps)[:5]}"
        wrong = [one for one in heights if one[0] > 0.05]
        assert len(wrong) <= 0.02 * len(heights), f"{self.name}: heights {wrong[:5]}"
        courts = self.courts([shape for *_, shape in outlines + parts], shapes, index)
        covered = [union_of(shapes, index, shape).intersection(shape).area / shape.area for _, _, shape in parts]
        assert not median(courts) > 0.05, f"{self.name}: courts are built up: {sorted(courts)[-5:]}"
        assert not median(covered) < 0.95, f"{self.name}: parts are not covered: {sorted(covered)[:5]}"
        far, farthest = self.overhang(shapes)
        assert far <= 0.002 * len(shapes) and farthest <= 1.0, f"{self.name}: {far} boxes stand over their outlines, one by {farthest:.2f} m"
        self.check_points()
        share = self.check_paths()
        print(f"{self.name}: {objects} buildings ({len(parts)} parts), overlap {middle:.3f} "
              f"over {len(overlaps)}, {len(heights)} heights, {len(wrong)} wrong, {share:.3f} of the footpaths walkable")
        if courts or covered:
            print(f"  {len(courts)} courts, built up {median(courts):.3f} in the median; parts covered {median(covered):.3f}")

    def overhang(self, shapes):
        """How many boxes reach farther beyond all outlines than half a metre, and the farthest reach."""
        areas = [shape for *_, shape in self.areas]
        tree, far, farthest = STRtree(areas), 0, 0.0
        for box in shapes:
            near = union_of(areas, tree, box)
            beyond = box.difference(near)
            reach = 0.0 if near.is_empty or beyond.is_empty else distance(points(get_coordinates(beyond)), near).max()
            far, farthest = far + (reach > 0.51), max(farthest, reach)
        return far, farthest

    def courts(self, areas, shapes, index):
        """Share of each court that boxes of buildings cover, 0.5 m and more from its walls and from houses in it."""
        tree, shares = STRtree(areas), []
        for ring in (hole for area in areas for hole in area.interiors):
            hole = Polygon(ring)
            inside = [areas[at] for at in tree.query(hole, predicate="intersects")]
            free = hole.difference(unary_union([one for one in inside if not one.equals(hole)])).buffer(-0.5)
            if free.area >= 10.0:
                shares.append(union_of(shapes, index, free).intersection(free).area / free.area)
        return shares

    def overlap(self, shape, shapes, index, boxes):
        """Intersection over union with the boxes of the object that covers most of the shape."""
        there, covered = index.query(shape, predicate="intersects"), Counter()
        for at in there:
            covered[boxes[at]["object"]] += shapes[at].intersection(shape).area
        best = max(covered, key=covered.get, default=None)
        # All boxes of the object, also those that do not touch the shape, where it has few.
        own = [at for at in (range(len(boxes)) if len(there) < 40 else there) if boxes[at]["object"] == best]
        return overlap(shape, unary_union([shapes[at] for at in own])) if own else 0.0

    def height(self, name, tags, shape, shapes, index, boxes):
        """Difference between a stated height and the nearest top of the boxes over the middle of a shape."""
        stated = stated_top_m(tags)
        if stated is None or not 0.5 <= stated <= 1000:
            return []
        tops = (boxes[at]["center_m"][2] + boxes[at]["half_m"][2] for at in index.query(shape, predicate="intersects"))
        return [(min((abs(top - stated) for top in tops), default=math.inf), name, stated)]

    def check_points(self):
        for key, value, kind in (("natural", "tree", "TreeTrunk"), ("highway", "street_lamp", "Lamp")):
            expected = sum(tags.get(key) == value and self.holds(at, THING_MARGIN_M) for tags, at in self.points)
            notes = [note for note in self.town["notes"] if "trees in rows" in note and kind == "TreeTrunk"]
            in_rows = int(notes[0].split("places of ")[1].split()[0]) if notes else 0
            found = sum(box["kind"] == kind and not box["synthetic"] for box in self.town["boxes"]) - in_rows
            assert found == expected, f"{self.name}: {found} {kind}, the file has {expected}"

    def check_paths(self):
        ground = [Polygon([corner[:2] for corner in one["outline_m"]]).buffer(0.01) for one in self.town["walkable"]]
        index = STRtree(ground)
        is_walkable = []
        for (ax, ay, begins), (bx, by, ends) in self.paths:
            length = math.hypot(bx - ax, by - ay)
            for share in (0.25, 0.5, 0.75):
                at = (ax + share * (bx - ax), ay + share * (by - ay))
                before_kerb = begins and share * length < KERB_M or ends and (1 - share) * length < KERB_M
                if self.holds(at, 0.0) and not before_kerb:
                    is_walkable.append(len(index.query(Point(at), predicate="intersects")) > 0)
        share = sum(is_walkable) / max(len(is_walkable), 1)
        assert share >= 0.98 or not is_walkable, f"{self.name}: only {share:.3f} of the footpaths are walkable"
        return share


files = sorted(path for path in Path(sys.argv[2]).iterdir() if ".osm" in path.name)
assert files, f"no extracts in {sys.argv[2]}"
for path in files:
    Town(sys.argv[1], path).check()
print(f"{len(files)} extracts agree with pyosmium")
