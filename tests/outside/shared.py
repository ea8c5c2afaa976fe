"""What several of these scripts need: tables, logs, rotations, runs of programs. Shares no code with cosfly."""

import argparse
import hashlib
import json
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np

COLOURS = "black grey white red orange yellow green blue purple pink brown beige".split()
IN_CHINESE = dict(zip(COLOURS, "黑色 灰色 白色 红色 橙色 黄色 绿色 蓝色 紫色 粉色 棕色 米色".split()))
# Kinds of a number and numbers of a pixel.
# A point of a sweep in column `cloud`.
POINT = np.dtype([("place", "<f4", 3), ("intensity", "<f4"), ("time", "<f4"), ("ring", "<u2"), ("label", "<u2"), ("instance", "<u4")])
ENCODINGS = {"mono8": ("u1", 1), "rgb8": ("u1", 3), "16UC1": ("<u2", 1), "32UC1": ("<u4", 1), "32FC1": ("<f4", 1), "32FC2": ("<f4", 2)}


def command_line(places, **options):
    """Arguments of a script: `places` names files and folders, with a + for several; options have a default or a kind, in a list where several are given."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in places.split():
        parser.add_argument(name.rstrip("+"), type=Path, nargs="+" if name.endswith("+") else None)
    for name, default in options.items():
        one = default[0] if isinstance(default, list) else default
        more = {"type": one} if isinstance(one, type) else {"type": type(one), "default": default}
        if isinstance(default, list):
            more["nargs"] = "+"
        if default is False:
            more = {"action": "store_true"}
        parser.add_argument(f"--{name.replace('_', '-')}", **more)
    return parser.parse_args()


def require(condition, message):
    """Ends the script with its name and a message where a condition does not hold."""
    if not condition:
        sys.exit(f"{Path(sys.argv[0]).stem}: {message}")


def said(check, detail=""):
    print(f"ok  {check:<28} {detail}", flush=True)


def agree(name, ours, theirs, tolerance=1e-9):
    """Numbers of one shape that are equal to the tolerance."""
    ours, theirs = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    worst = np.abs(ours - theirs).max() if ours.size else 0.0
    require(ours.shape == theirs.shape and worst <= tolerance, f"{name} differs by {worst}:\n ours {ours}\n theirs {theirs}")
    said(f"{name:<60}", f"{ours.size} numbers, largest difference {worst:.1e}")


def run(*command, code=0, **options):
    """What a program prints; another exit code ends the script with its words."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, **options}
    done = subprocess.run([str(part) for part in command], **options)
    require(done.returncode == code, f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}{(done.stderr or '')[-2000:]}")
    return done.stdout


def json_lines(path):
    return list(map(json.loads, Path(path).read_text(encoding="utf-8").splitlines()))


def bytes_of(folder):
    """Digests of all files of a folder by name."""
    files = sorted(path for path in Path(folder).rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def program(path, text):
    """A script of the shell that can be called."""
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def imported_by_rerun(log, *words):
    """The importer of Rerun knows the types of a log: what it prints of it has these words."""
    rerun = Path(sys.executable).with_name("rerun")
    run(rerun, "analytics", "disable")
    with tempfile.TemporaryDirectory() as scratch:
        run(rerun, "mcap", "convert", log, "-o", f"{scratch}/bag.rrd")
        printed = run(rerun, "rrd", "print", "-vv", f"{scratch}/bag.rrd")
    require(all(word in printed for word in words), f"Rerun finds not all of {words} in {log}")
    said("Rerun imports", ", ".join(words))


def json_of(*command, **options):
    return json.loads(run(*command, **options))


def end_with(wrong):
    """Prints the first faults; the exit code is 1 where there are any."""
    print(*wrong[:20], sep="\n")
    sys.exit(bool(wrong))


def blocks(page, *languages):
    """Pairs of language and text of the code blocks of a page."""
    return re.findall(rf"^```({'|'.join(languages)})\n(.*?)^```$", Path(page).read_text(encoding="utf-8"), re.M | re.S)


def rows(folder, table, columns=None):
    """Rows of a table of a dataset: these columns, or all but previews."""
    import pyarrow.dataset

    found = pyarrow.dataset.dataset(Path(folder) / "data" / table, format="parquet")
    return found.to_table(columns or [name for name in found.schema.names if name != "preview"]).to_pylist()


def readings(folder, name):
    """Rows of a table of a sensor, or of frames, by flight, in order, as tables of pandas."""
    import pyarrow.parquet

    frame = pyarrow.parquet.read_table(Path(folder) / "data" / name).to_pandas()
    return {flight: own.sort_values([it for it in ("frame", "row") if it in own]) for flight, own in frame.groupby("trajectory_id")}


def allan(errors, step_s, tau_s):
    """Overlapping Allan variance of each column, from sums of readings."""
    n = max(round(tau_s / step_s), 1)
    sums = np.concatenate([np.zeros((1, errors.shape[1])), np.cumsum(errors, 0)]) * step_s
    return np.mean((sums[2 * n:] - 2 * sums[n:-n] + sums[:-2 * n]) ** 2, 0) / (2 * (n * step_s) ** 2)


def flown(folder, of_frames=None, of_bodies=None):
    """Flights by id, their frames by id and number, and the bodies that a frame shows by id and number; columns as in `rows`."""
    flights = {row["trajectory_id"]: row for row in rows(folder, "trajectories")}
    frames, seen, key = defaultdict(dict), defaultdict(list), ["trajectory_id", "frame"]
    for row in rows(folder, "frames", of_frames and key + of_frames):
        frames[row["trajectory_id"]][row["frame"]] = row
    for row in rows(folder, "bodies", of_bodies and [*key, "visible_pixels", *of_bodies]):
        if row["visible_pixels"]:
            seen[row["trajectory_id"], row["frame"]].append(row)
    return flights, frames, seen


def messages(path, topics=None):
    """Topic, decoded message, time and schema of each message of a log."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with open(path, "rb") as file:
        for schema, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages(topics):
            yield channel.topic, decoded, message.log_time, schema.data


def pixels(image):
    """A raw image of a log as an array."""
    kind, parts = ENCODINGS[image.encoding]
    return np.frombuffer(image.data, kind).reshape((image.height, image.width) + ((parts,) if parts > 1 else ()))


def picture(message):
    """A compressed image of a log."""
    import io

    from PIL import Image

    return Image.open(io.BytesIO(message.data))


def turned(to, of):
    """Difference of angles, degrees, -180 to 180."""
    return (to - of + 180) % 360 - 180


def xyz(message):
    return np.array([message.x, message.y, message.z])


def place(row, of):
    return np.array([row[f"{of}_{axis}_m"] for axis in "xyz"])


def world_from_body(pitch, yaw, roll):
    """CARLA's matrix, of degrees: columns are the body's axes ahead, right and up in the world (left-handed, z up)."""
    (sp, sy, sr), (cp, cy, cr) = np.sin(np.radians([pitch, yaw, roll])), np.cos(np.radians([pitch, yaw, roll]))
    return np.array([
        [cp * cy, cy * sp * sr - sy * cr, -cy * sp * cr - sy * sr],
        [cp * sy, sy * sp * sr + cy * cr, -sy * sp * cr + cy * sr],
        [sp, -cp * sr, cp * cr],
    ])


def axes_of(row, of="camera"):
    return world_from_body(*(row[f"{of}_{name}_deg"] for name in ("pitch", "yaw", "roll")))


def pixel(flight, frame, point):
    """Place of a point in the picture of a camera without a lens, pixels; none behind the camera."""
    ahead, right, up = axes_of(frame).T @ (point - place(frame, "drone"))
    middle = np.array([flight["camera_width_px"], flight["camera_height_px"]]) / 2
    return None if ahead <= 0 else middle + flight["camera_focal_px"] * np.array([right, -up]) / ahead


class Town:
    """The boxes of a town from table `objects`."""

    def __init__(self, boxes):
        self.kind, self.instance = (np.array([row[name] for row in boxes]) for name in ("kind", "instance"))
        self.center, size = (np.array([row[name] for row in boxes], float).reshape(-1, 3) for name in ("center_in_world_m", "size_m"))
        self.half, yaw = size / 2, np.radians([row["yaw_deg"] for row in boxes])
        self.cos, self.sin = np.cos(yaw), np.sin(yaw)
        self.reach = np.hypot(self.half[:, 0], self.half[:, 1])

    @staticmethod
    def all_of(folder):
        """The towns of a dataset by name."""
        boxes = defaultdict(list)
        for row in rows(folder, "objects"):
            boxes[row["town"]].append(row)
        return {name: Town(of_town) for name, of_town in boxes.items()}

    def own(self, which, vectors):
        """Vectors along the axes of boxes."""
        cos, sin = self.cos[which], self.sin[which]
        x, y, z = np.moveaxis(vectors, -1, 0)
        return np.stack([cos * x + sin * y, cos * y - sin * x, z + 0 * cos], -1)

    def span(self, which, start, way):
        """How many ways from a start a ray enters each box by each axis (it is in by the last of them) and leaves it, and the way along the axes of each."""
        begin, step = self.own(which, start - self.center[which]), self.own(which, way)
        step = np.where(np.abs(step) < 1e-12, 1e-12, step)
        near, far = np.sort([(-self.half[which] - begin) / step, (self.half[which] - begin) / step], axis=0)
        return near, far.min(-1), step

    def nearest(self, kind, feet, heading, reach_m):
        """Boxes of a kind, and the ways along the ground from the feet to their footprints: ahead and to the right of a heading, radians."""
        away = np.hypot(*(self.center[:, :2] - feet[:2]).T) - self.reach
        which = np.flatnonzero((self.kind == kind) & (away < reach_m))
        local = self.own(which, feet - self.center[which])
        way = np.clip(local, -self.half[which], self.half[which]) - local
        cos, sin = self.cos[which], self.sin[which]
        x, y = cos * way[:, 0] - sin * way[:, 1], sin * way[:, 0] + cos * way[:, 1]
        return which, np.cos(heading) * x + np.sin(heading) * y, np.cos(heading) * y - np.sin(heading) * x


def ground_of_boxes(boxes, offset=(0, 0), mirror=1):
    """Plans of boxes that `inspect_json` prints; with `mirror` -1 in a file's frame, whose y goes to the north."""
    from shapely import Polygon

    for box in boxes:
        (x, y, _), (a, b, _), cos, sin = box["center_m"], box["half_m"], np.cos(box["yaw_rad"]), np.sin(box["yaw_rad"])
        corners = [(a, b), (-a, b), (-a, -b), (a, -b)]
        yield Polygon([(x + offset[0] + cos * u - sin * v, mirror * (y + offset[1] + sin * u + cos * v)) for u, v in corners])


def overlap(a, b):
    """Intersection over union of two shapes of shapely."""
    return a.intersection(b).area / a.union(b).area


def is_in(outline, x, y):
    """Whether a point lies in a polygon: it has an odd number of sides that a ray along x meets."""
    sides = zip(outline, [*outline[1:], outline[0]])
    return sum((a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) for a, b in sides) % 2 == 1


def module(path):
    """A script of the repository as a module."""
    import importlib.util

    file = Path(__file__).resolve().parents[2] / path
    specification = importlib.util.spec_from_file_location(file.stem, file)
    loaded = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(loaded)
    return loaded


def with_column(table, name, values):
    """A table of pyarrow with other values in a column."""
    import pyarrow

    at = table.schema.get_field_index(name)
    return table.set_column(at, table.schema.field(at), pyarrow.array(values, table.schema.field(at).type))


def chromium_of(playwright):
    """Chromium without a window: that of the PATH, or that of playwright."""
    import shutil

    found = filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome")))
    return playwright.chromium.launch(executable_path=next(found, None), args=["--no-sandbox", "--enable-unsafe-swiftshader"])


def in_windows(address, problems, **options):
    """Names of windows and a page in each: wide and narrow, light and dark; notes what must hold in every window."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = chromium_of(playwright)
        for width, scheme in [(width, scheme) for width in (1280, 400) for scheme in ("light", "dark")]:
            name = f"{width} px, {scheme}"
            page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme, **options)
            watch(page, name, problems, address)
            page.goto(address)
            yield name, page
            problems.extend(faults_of_page(page, name))
            page.close()
        browser.close()


def watch(page, name, problems, own, is_fault=lambda it: True):
    """Notes errors of a page, requests to others, and messages on the console that are faults."""
    page.on("console", lambda it: is_fault(it) and problems.append(f"{name}: console: {it.text}"))
    page.on("pageerror", lambda it: problems.append(f"{name}: error: {it}"))
    page.on("request", lambda it: it.url.startswith(("data:", own)) or problems.append(f"{name}: loads {it.url}"))


def faults_of_page(page, name):
    """What must hold in every window: nothing is cut off, everybody can read it."""
    from axe_playwright_python.sync_playwright import Axe

    width, inside = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
    if width > inside:
        yield f"{name}: the page is {width} px wide in a window of {inside}"
    for fault in Axe().run(page).response["violations"]:
        yield f"{name}: {fault['id']}: {fault['help']} ({len(fault['nodes'])} times, first {fault['nodes'][0]['html'][:120]})"
