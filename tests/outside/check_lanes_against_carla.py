"""Lane centres, headings, widths and crosswalks of our OpenDRIVE reader against the `carla` package (no server needed).

Usage: `check_lanes_against_carla.py DUMP_LANES_BINARY FILE.xodr...` (pip install carla==0.9.16). Exits 1 when a lane differs by more than 1 mm plus
the float32 step of its coordinates. Two things are known of carla: it replaces paramPoly3 by chords of 0.3 m (10 mm and 0.1 degrees are allowed
there, 3 mm for 97 of 100 samples), and it adds the slope of a lane's edge to its heading as if it were an angle (headings are compared where the
slope is below 0.02). Maps in far coordinates (UTM) are moved near the origin first, because carla works in float32."""

import decimal
import math
import re
import sys
import tempfile

import carla
from shared import json_of, turned

MOST_SHOWN = 5
LEAST_CROSSWALKS = 0.85
FAR = 10_000
GEOMETRY = re.compile(r"<geometry\b[^>]*>")


def float32_step(value):
    """Distance between neighbouring float32 numbers at this size."""
    return 2.0 ** (math.floor(math.log2(max(abs(value), 1.0))) - 23)


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else 0.0


def near_origin(text):
    """The text with the plan view moved by whole kilometres when it lies far away."""
    shift = {}
    for axis in "xy":
        found = re.search(rf'\b{axis}="([^"]+)"', GEOMETRY.search(text).group())
        value = float(found.group(1))
        shift[axis] = decimal.Decimal(round(value / 1000) * 1000 if abs(value) > FAR else 0)

    def moved(match):
        axis, number = match.group(1), decimal.Decimal(match.group(2))
        return f'{axis}="{number - shift[axis]}"'

    return GEOMETRY.sub(lambda geometry: re.sub(r'\b([xy])="([^"]+)"', moved, geometry.group()), text)


def dumped(binary, text):
    with tempfile.NamedTemporaryFile("w", suffix=".xodr", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        return json_of(binary, file.name, 2.5, "shoulders")


def compare_crosswalks(town, dump):
    """Share of carla's crosswalk corners that lie at ours. carla measures t from the shifted centre lane where a road
    has a lane offset, against the standard; so a few crosswalks stand elsewhere there."""
    ours = [corner for polygon in dump["walkable"] if polygon["kind"] == "Crossing" for corner in polygon["outline"]]
    theirs = town.get_crosswalks()
    if not theirs:
        return 1.0
    near = sum(any(math.hypot(corner.x - x, corner.y - y) < 0.01 for x, y, _ in ours) for corner in theirs)
    return near / len(theirs)


def compare(binary, path):
    with open(path, encoding="utf-8-sig") as file:
        text = near_origin(file.read())
    town = carla.Map("town", text)
    dump = dumped(binary, text)
    has_cubics = "<paramPoly3" in text
    limit, heading_limit = (1e-2, 0.1) if has_cubics else (1e-3, 0.01)
    offsets, headings, widths, bad, missing = [], [], [], [], 0
    for sample in dump["lanes"]:
        if sample["width"] < 1e-3:
            continue
        try:
            road = int(sample["road"])
        except ValueError:
            return print(f"{path}: road ids are no numbers: carla cannot be asked") or True
        other = town.get_waypoint_xodr(road, sample["lane"], sample["s"])
        if other is None:
            missing += 1
            continue
        location = other.transform.location
        x, y, _ = sample["position"]
        off = math.hypot(location.x - x, location.y - y)
        allowed = limit + 2.0 * max(float32_step(x), float32_step(y))
        yaw = sample["yaw_deg"] + (180.0 if sample["lane"] > 0 else 0.0)
        heading = abs(turned(other.transform.rotation.yaw, yaw))
        width = abs(other.lane_width - sample["width"])
        steady = abs(sample["drift"]) < 0.02
        offsets.append(off)
        headings += [heading] * steady
        widths.append(width)
        if off > allowed or width > 1e-3 or (steady and heading > heading_limit):
            bad.append((off, width, heading, sample))
    print(
        f"{path}: {len(offsets)} samples, {missing} unknown to carla, worst offset {max(offsets) * 1e3:.3f} mm, "
        f"width {max(widths) * 1e3:.3f} mm, heading {max(headings):.4f} deg (99 %: {quantile(headings, 0.99):.4f}), "
        f"{len(bad)} beyond the limit"
    )
    crosswalks = compare_crosswalks(town, dump) if dump["walkable"] else 1.0
    if crosswalks < 1.0:
        print(f"    only {crosswalks:.4f} of carla's crosswalk corners lie at ours")
    for off, width, heading, sample in sorted(bad, key=lambda entry: -entry[0])[:MOST_SHOWN]:
        place = f"road {sample['road']} lane {sample['lane']} s {sample['s']:.3f} at {sample['position']}"
        print(f"    {place}: {off:.5f} m off, width {width:.5f} m off, heading {heading:.4f} deg off")
    # Surveys shift the centre lane nearly everywhere, so there carla's crosswalks say nothing.
    crosswalks_agree = has_cubics or crosswalks >= LEAST_CROSSWALKS
    return not bad and crosswalks_agree and quantile(offsets, 0.97) < (3e-3 if has_cubics else limit)


sys.exit(not all([compare(sys.argv[1], path) for path in sys.argv[2:]]))
