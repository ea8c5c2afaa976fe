"""Reads the instructions of table `windows` and compares every claim with the other tables.

    venv/bin/python tests/outside/check_window_texts.py DATASET_FOLDER

Shares no code with cosfly. A claim is found by its words, in English and in Chinese, and judged by the boxes, pixels, places and
clothes of tables `frames`, `bodies` and `trajectories` in the last frame of the input, and by the boxes of table `objects`: a
landmark must be there, be alone there, and rays from the camera must reach it inside of the picture. Prints how often each claim
occurs.
"""

import re
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pyarrow.dataset as ds

COLOURS = dict(zip(
    "black grey white red orange yellow green blue purple pink brown beige".split(),
    "黑色 灰色 白色 红色 橙色 黄色 绿色 蓝色 紫色 粉色 棕色 米色".split(),
))
NUMBERS = {word: count for words in (["no", "one", "two", "three", "four", "five", "six"], "零一两三四五六") for count, word in enumerate(words)}


LANDMARKS = {  # words, and kind in table `objects`
    "traffic_light": ("a traffic light", "一处红绿灯"), "lamp": ("a street lamp", "一盏路灯"),
    "traffic_sign": ("a traffic sign", "一块交通标志牌"), "tree_trunk": ("a tree", "一棵树"),
    "car": ("a parked car", "一辆停着的汽车"), "building": ("a building", "一栋楼房"),
}
RELATIONS = {  # {} stands for the landmark; sides come after it in English and before it in Chinese
    "passes": (r"(?:passing|walking past) {}(?: on the (left|right))?(?=[,.])", "从(?:(左|右)侧的)?{}旁走过"),
    "approaches": ("approaching {}(?=[,.])", "走近{}"),
    "next to": ("next to {}(?=[,.])", "在{}旁(?!走)"),
    "in front of": ("in front of {}(?=[,.])", "位于{}前"),
}
RAYS = 40


class Town:
    """The boxes of a town from table `objects`."""

    def __init__(self, rows):
        self.kind = np.array([row["kind"] for row in rows])
        self.instance = np.array([row["instance"] for row in rows])
        self.center, self.half = (np.array([row[name] for row in rows], float).reshape(-1, 3) for name in ("center_in_world_m", "size_m"))
        self.half = self.half / 2
        yaw = np.radians([row["yaw_deg"] for row in rows])
        self.cos, self.sin = np.cos(yaw), np.sin(yaw)
        self.reach = np.hypot(self.half[:, 0], self.half[:, 1])

    def own(self, which, vectors):
        """Vectors along the axes of boxes."""
        cos, sin = self.cos[which], self.sin[which]
        x, y, z = np.moveaxis(vectors, -1, 0)
        return np.stack([cos * x + sin * y, cos * y - sin * x, z], -1)

    def nearest(self, kind, feet, reach_m):
        """Boxes of a kind, and the ways along the ground from the feet to their footprints."""
        away = np.hypot(*(self.center[:, :2] - feet[:2]).T) - self.reach
        which = np.flatnonzero((self.kind == kind) & (away < reach_m))
        local = self.own(which, feet - self.center[which])
        way = np.clip(local, -self.half[which], self.half[which]) - local
        cos, sin = self.cos[which], self.sin[which]
        return which, np.stack([cos * way[:, 0] - sin * way[:, 1], sin * way[:, 0] + cos * way[:, 1]], -1)

    def first_hit(self, start, end):
        """The first box between two points, and where; none where the way is free."""
        middle, length = (start + end) / 2, np.linalg.norm(end - start)
        which = np.flatnonzero(np.hypot(*(self.center[:, :2] - middle[:2]).T) < self.reach + length / 2)
        begin, step = self.own(which, start - self.center[which]), self.own(which, np.broadcast_to(end - start, (len(which), 3)))
        step = np.where(np.abs(step) < 1e-12, 1e-12, step)
        near, far = np.sort([(-self.half[which] - begin) / step, (self.half[which] - begin) / step], axis=0)
        enters, leaves = near.max(-1), far.min(-1)
        hit = np.where((enters <= leaves) & (leaves >= 0) & (enters <= 1), np.maximum(enters, 0), np.inf)
        if not len(which) or not np.isfinite(hit.min()):
            return None
        return which[hit.argmin()], start + hit.min() * (end - start)


def turned_deg(to, of):
    return (to - of + 180) % 360 - 180


class Picture:
    """Facts of one frame from the tables, by words."""

    def __init__(self, flight, frame, first, people, town):
        self.flight, self.frame, self.people, self.town = flight, frame, people, town
        self.width = flight["camera_width_px"]
        self.moved = np.array([frame[f"target_{axis}_m"] - first[f"target_{axis}_m"] for axis in "xy"])

    def across(self, row):
        left, _, right, _ = row["visible_box_px"]
        return (left + right) / 2 / self.width

    def way(self):
        """Angle of the target's way to the camera's, degrees; none for a target that stands."""
        if np.hypot(*self.moved) < 0.1:
            return None
        return turned_deg(np.degrees(np.arctan2(self.moved[1], self.moved[0])), self.frame["camera_yaw_deg"])

    def along(self, where):
        """People who walk along with the target, and of whom it is `where`."""
        heading = np.radians(self.frame["target_heading_deg"])
        found = []
        for person in self.people:
            x, y = (person["feet_in_world_m"][at] - self.frame[f"target_{axis}_m"] for at, axis in enumerate("xy"))
            before, aside = np.cos(heading) * x + np.sin(heading) * y, np.cos(heading) * y - np.sin(heading) * x
            is_there = {"ahead": before < 0, "behind": before > 0, "beside": abs(before) < 1}[where]
            same_way = abs(turned_deg(person["heading_deg"], self.frame["target_heading_deg"])) < 35
            if is_there and same_way and abs(before) < 6.5 and abs(aside) < 2 and person["speed_mps"] > 0.2:
                found.append(person)
        return found

    def distance(self, feet):
        return np.linalg.norm(np.array(feet) - [self.frame[f"drone_{axis}_m"] for axis in "xyz"])

    def pixel(self, point):
        """Place of a point in the picture of a camera without a lens, pixels; none behind the camera."""
        pitch, yaw, roll = (np.radians(self.frame[f"camera_{name}_deg"]) for name in ("pitch", "yaw", "roll"))
        cp, sp, cy, sy, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw), np.cos(roll), np.sin(roll)
        axes = np.array([[cp * cy, cp * sy, sp], [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, -cp * sr], [-cy * sp * cr - sy * sr, -sy * sp * cr + cy * sr, cp * cr]])
        ahead, right, up = axes @ (point - self.eye())
        focal = self.flight["camera_focal_px"]
        return None if ahead <= 0 else np.array([self.width / 2 + focal * right / ahead, self.flight["camera_height_px"] / 2 - focal * up / ahead])

    def eye(self):
        return np.array([self.frame[f"drone_{axis}_m"] for axis in "xyz"])

    def feet(self):
        return np.array([self.frame[f"target_{axis}_m"] for axis in "xyz"])

    def reaches(self, instance):
        """Whether rays from the camera reach boxes of an object inside of the picture."""
        boxes = np.flatnonzero(self.town.instance == instance)
        draws, size, seen = np.random.default_rng(0), np.array([self.width, self.flight["camera_height_px"]]), 0
        for _ in range(RAYS):
            box = draws.choice(boxes)
            x, y, z = draws.uniform(-1, 1, 3) * self.town.half[box]
            cos, sin = self.town.cos[box], self.town.sin[box]
            point = self.town.center[box] + [cos * x - sin * y, sin * x + cos * y, z]
            at = self.pixel(point)
            if at is not None and (at > 0).all() and (at < size).all():
                hit = self.town.first_hit(self.eye(), point)
                seen += hit is None or self.town.instance[hit[0]] == instance
        return seen >= RAYS // 5

    def landmark(self, relation, kind, side):
        """Whether the target is in a relation to exactly one landmark of a kind that the picture shows."""
        feet, heading = self.feet(), np.radians(self.frame["target_heading_deg"])
        if relation == "in front of":
            end = feet + [0, 0, 1]
            hit = self.town.first_hit(end, end + (end - self.eye()) / np.linalg.norm(end - self.eye()) * 11)
            return hit is not None and self.town.kind[hit[0]] == kind and hit[1][2] > feet[2]
        which, ways = self.town.nearest(kind, feet, 12)
        before = ways @ [np.cos(heading), np.sin(heading)]
        aside = ways @ [-np.sin(heading), np.cos(heading)]
        moved_m = np.hypot(*self.moved)
        there = {
            "passes": (np.abs(before) < 1.6) & (np.abs(aside) < 3.6) & (moved_m > 0.3),
            "approaches": (before > 2.4) & (before < 8.1) & (np.abs(aside) < 1.6) & (moved_m > 0.3),
            "next to": (np.hypot(before, aside) < 2.6) & (moved_m < 0.15),
        }[relation]
        if there.sum() != 1 or not self.reaches(self.town.instance[which[there][0]]):
            return False
        if side is None:
            return True
        sign = 1 if side in ("right", "右") else -1
        at = self.pixel(self.town.center[which[there][0]] * [1, 1, 0] + [0, 0, feet[2] + 1])
        left, _, right, _ = self.frame["visible_box_px"]
        return sign * aside[there][0] > 0 and at is not None and (at[0] > right if sign > 0 else at[0] < left)


def claims(text, picture):
    """Pairs of a claim's name and whether it is true."""
    row, flight, people = picture.frame, picture.flight, picture.people
    zh = not text.isascii()
    has = lambda english, chinese: (chinese if zh else english) in text
    own = re.split("[，。]" if zh else r"[,.]", text)[0]
    colours = lambda words: [name for name, chinese in COLOURS.items() if re.search(f"{chinese}(?=上衣|裤子)" if zh else rf"\b{name}\b(?= top| trousers)", words)]
    yield "clothes", set(colours(own)) == {flight["target_top_colour"], flight["target_trousers_colour"]}
    yield "backpack", has("backpack", "背包") == flight["target_has_backpack"]
    hidden = has("cannot be seen", "不在视野内")
    yield "hidden" if hidden else "seen", hidden == (row["visible_box_px"] is None)
    if hidden:
        return
    way, at = picture.way(), picture.across(row)
    yield from ((name, way is not None and test(way)) for words, name, test in [
        (("away from the camera", "背对镜头"), "away", lambda it: abs(it) < 31),
        (("towards the camera", "迎着镜头"), "towards", lambda it: abs(it) > 149),
        (("walking to the left", "左侧走去"), "to the left", lambda it: -121 < it < -59),
        (("walking to the right", "右侧走去"), "to the right", lambda it: 59 < it < 121),
    ] if has(*words))
    if has("standing still", "站着不动"):
        yield "stands", way is None
    yield from ((name, test(at)) for words, name, test in [
        (("on the left of", "位于画面左"), "on the left", lambda it: it < 0.3),
        (("in the middle of", "画面中央"), "in the middle", lambda it: 0.4 <= it <= 0.6),
        (("on the right of", "位于画面右"), "on the right", lambda it: it > 0.7),
    ] if has(*words))
    if has("only person", "唯一") or "独自" in text:
        yield "alone", not people
    outermost = re.search(r"(最左|最右)" if zh else r"(leftmost|rightmost)", text)
    if outermost:
        sign = 1 if outermost[1] in ("leftmost", "最左") else -1
        count = re.search("画面中(.)个人" if zh else r"of the (\w+) people", text)[1]
        yield "outermost", NUMBERS[count] == len(people) + 1 and all(sign * picture.across(it) > sign * at for it in people)
    for relation, patterns in RELATIONS.items():
        for kind, words in LANDMARKS.items():
            found = re.search(patterns[zh].format(words[zh]), text)
            if found:
                side = found[1] if found.groups() else None
                yield f"{relation} {kind}{' with side' if side else ''}", picture.landmark(relation, kind, side)
    names = sum(text.count(words[zh]) for words in LANDMARKS.values())
    if names:
        yield "one landmark", names == 1 == sum(bool(re.search(patterns[zh].format(words[zh]), text)) for patterns in RELATIONS.values() for words in LANDMARKS.values())
    if has("nearest", "最近"):
        own_m = picture.distance([row[f"target_{axis}_m"] for axis in "xyz"])
        yield "nearest", bool(people) and all(picture.distance(it["feet_in_world_m"]) > own_m for it in people)
    for where, english, chinese in [("ahead", "ahead of", "前面"), ("behind", "just behind", "后面"), ("beside", "side by side", "并排")]:
        clause = next((it for it in re.split("[，。,.]", text) if (chinese if zh else english) in it), None)
        if clause is None:
            continue
        along = picture.along(where)
        several = re.search("另外(.)人" if zh else r"(\w+) others", clause)
        if several:
            yield f"{where} several", len(along) == NUMBERS[several[1]]
        else:
            yield f"{where} one", [it["top_colour"] for it in along] == colours(clause)


def main():
    folder = Path(sys.argv[1]) / "data"
    rows = lambda table, columns: ds.dataset(folder / table).to_table(columns).to_pylist()
    flights = {row["trajectory_id"]: row for row in rows("trajectories", [
        "trajectory_id", "town", "camera_width_px", "camera_height_px", "camera_focal_px", "target_top_colour", "target_trousers_colour", "target_has_backpack"])}
    frames = {(row["trajectory_id"], row["frame"]): row for row in rows("frames", [
        "trajectory_id", "frame", "drone_x_m", "drone_y_m", "drone_z_m", "camera_pitch_deg", "camera_yaw_deg", "camera_roll_deg", "target_x_m", "target_y_m",
        "target_z_m", "target_heading_deg", "visible_box_px"])}
    people = {}
    for row in rows("bodies", ["trajectory_id", "frame", "feet_in_world_m", "heading_deg", "speed_mps", "top_colour", "visible_box_px", "kind"]):
        if row["visible_box_px"] is None or row["kind"] not in ("pedestrian", "bicycle", "motorcycle"):
            continue
        people.setdefault((row["trajectory_id"], row["frame"]), []).append(row)
    boxes = {}
    for row in rows("objects", ["town", "instance", "kind", "center_in_world_m", "size_m", "yaw_deg"]):
        boxes.setdefault(row["town"], []).append(row)
    towns = {name: Town(of_town) for name, of_town in boxes.items()}
    counts, wrong, local, windows, silent = Counter(), [], 0, 0, 0
    for row in rows("windows", ["trajectory_id", "start_frame", "input_boxes_px", "instruction_en", "instruction_zh"]):
        name, start = row["trajectory_id"], row["start_frame"]
        last = start + len(row["input_boxes_px"]) // 4 - 1
        picture = Picture(flights[name], frames[name, last], frames[name, start], people.get((name, last), []), towns[flights[name]["town"]])
        found = []
        for text in filter(None, (row["instruction_en"], row["instruction_zh"])):
            found = list(claims(text, picture))
            counts.update(claim for claim, _ in found)
            wrong += [f"{claim} in frame {last} of {name}: {text}" for claim, holds in found if not holds]
        windows += 1
        silent += not row["instruction_en"]
        local += any(claim not in ("clothes", "backpack", "seen") for claim, _ in found)
    print(f"{windows} windows, {silent} of them behind vehicles and without a text, {100 * local / max(1, windows - silent):.0f} % of the others with a claim about the picture; {dict(counts.most_common())}")
    if wrong:
        raise SystemExit(f"check_window_texts: {len(wrong)} claims are wrong:\n" + "\n".join(wrong[:10]))
    windows_of_people = windows - silent
    if local < 0.5 * windows_of_people:
        raise SystemExit("check_window_texts: less than half of the windows say anything about the picture")


if __name__ == "__main__":
    main()
