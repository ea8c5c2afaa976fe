"""Reads the instructions of table `windows` and compares every claim with the other tables.

Usage: `check_window_texts.py DATASET_FOLDER`. Shares no code with cosfly. A claim is found by its words, in English and in Chinese, and judged by the
boxes, pixels, places and clothes of tables `frames`, `bodies` and `trajectories` in the last frame of the input, and by the boxes of table `objects`:
a landmark must be there, be alone there, and rays from the camera must reach it inside of the picture. Prints how often each claim occurs."""

import re
import sys
from collections import Counter

import numpy as np
from check_phrases import PEOPLE, chinese, described, english, may_fit
from goal_words import as_walked
from shared import IN_CHINESE, Town, flown, pixel, place, require, rows, turned

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


def first_hit(town, start, end):
    """The first box between two points, and where; none where the way is free."""
    middle, length = (start + end) / 2, np.linalg.norm(end - start)
    which = np.flatnonzero(np.hypot(*(town.center[:, :2] - middle[:2]).T) < town.reach + length / 2)
    near, leaves, _ = town.span(which, start, end - start)
    enters = near.max(-1)
    hit = np.where((enters <= leaves) & (leaves >= 0) & (enters <= 1), np.maximum(enters, 0), np.inf)
    if not len(which) or not np.isfinite(hit.min()):
        return None
    return which[hit.argmin()], start + hit.min() * (end - start)


class Picture:
    """Facts of one frame from the tables, by words."""

    def __init__(self, flight, frame, first, people, town):
        self.flight, self.frame, self.people, self.town = flight, frame, people, town
        self.width, self.eye, self.feet = flight["camera_width_px"], place(frame, "drone"), place(frame, "target")
        self.moved = (self.feet - place(first, "target"))[:2]

    def across(self, row):
        left, _, right, _ = row["visible_box_px"]
        return (left + right) / 2 / self.width

    def way(self):
        """Angle of the target's way to the camera's, degrees; none for a target that stands."""
        if np.hypot(*self.moved) < 0.1:
            return None
        return turned(np.degrees(np.arctan2(self.moved[1], self.moved[0])), self.frame["camera_yaw_deg"])

    def along(self, where):
        """People who walk along with the target, and of whom it is `where`."""
        heading = np.radians(self.frame["target_heading_deg"])

        def is_along(person):
            x, y, _ = person["feet_in_world_m"] - self.feet
            before, aside = np.cos(heading) * x + np.sin(heading) * y, np.cos(heading) * y - np.sin(heading) * x
            is_there = {"ahead": before < 0, "behind": before > 0, "beside": abs(before) < 1}[where]
            same_way = abs(turned(person["heading_deg"], self.frame["target_heading_deg"])) < 35
            return is_there and same_way and abs(before) < 6.5 and abs(aside) < 2 and person["speed_mps"] > 0.2

        return list(filter(is_along, self.people))

    def distance(self, feet):
        return np.linalg.norm(feet - self.eye)

    def reaches(self, instance):
        """Whether rays from the camera reach boxes of an object inside of the picture."""
        boxes = np.flatnonzero(self.town.instance == instance)
        draws, size, seen = np.random.default_rng(0), np.array([self.width, self.flight["camera_height_px"]]), 0
        for _ in range(RAYS):
            box = draws.choice(boxes)
            x, y, z = draws.uniform(-1, 1, 3) * self.town.half[box]
            cos, sin = self.town.cos[box], self.town.sin[box]
            point = self.town.center[box] + [cos * x - sin * y, sin * x + cos * y, z]
            at = pixel(self.flight, self.frame, point)
            if at is not None and (at > 0).all() and (at < size).all():
                hit = first_hit(self.town, self.eye, point)
                seen += hit is None or self.town.instance[hit[0]] == instance
        return seen >= RAYS // 5

    def landmark(self, relation, kind, side):
        """Whether the target is in a relation to exactly one landmark of a kind that the picture shows."""
        heading = np.radians(self.frame["target_heading_deg"])
        if relation == "in front of":
            end = self.feet + [0, 0, 1]
            hit = first_hit(self.town, end, end + (end - self.eye) / np.linalg.norm(end - self.eye) * 11)
            return hit is not None and self.town.kind[hit[0]] == kind and hit[1][2] > self.feet[2]
        which, before, aside = self.town.nearest(kind, self.feet, heading, 12)
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
        at = pixel(self.flight, self.frame, self.town.center[which[there][0]] * [1, 1, 0] + [0, 0, self.feet[2] + 1])
        left, _, right, _ = self.frame["visible_box_px"]
        return sign * aside[there][0] > 0 and at is not None and (at[0] > right if sign > 0 else at[0] < left)


def claims(text, picture):
    """Pairs of a claim's name and whether it is true."""
    row, flight, people = picture.frame, picture.flight, picture.people
    zh = not text.isascii()
    has = lambda english, chinese: (chinese if zh else english) in text
    own = re.split("[，。]" if zh else r"[,.]", text)[0]
    colours = lambda words: [name for name, chinese in IN_CHINESE.items() if re.search(f"{chinese}(?=上衣|裤子)" if zh else rf"\b{name}\b(?= top| trousers)", words)]
    yield "clothes", set(colours(own)) == {flight["target_top_colour"], flight["target_trousers_colour"]}
    yield "backpack", has("backpack", "背包") == flight["target_has_backpack"]
    hidden = has("cannot be seen", "不在视野内")
    yield "hidden" if hidden else "seen", hidden == (row["visible_box_px"] is None)
    if hidden:
        return
    way, at = picture.way(), picture.across(row)
    yield from ((name, is_so) for english, chinese, name, is_so in [
        ("away from the camera", "背对镜头", "away", way is not None and abs(way) < 31),
        ("towards the camera", "迎着镜头", "towards", way is not None and abs(way) > 149),
        ("walking to the left", "左侧走去", "to the left", way is not None and -121 < way < -59),
        ("walking to the right", "右侧走去", "to the right", way is not None and 59 < way < 121),
        ("standing still", "站着不动", "stands", way is None),
        ("on the left of", "位于画面左", "on the left", at < 0.3),
        ("in the middle of", "画面中央", "in the middle", 0.4 <= at <= 0.6),
        ("on the right of", "位于画面右", "on the right", at > 0.7),
        ("only person", "唯一" if "唯一" in text else "独自", "alone", not people),
    ] if has(english, chinese))
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
        own_m = picture.distance(picture.feet)
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


def phrase_claims(texts, flight, frame, others):
    """The texts behind a target that is not on foot: both mean the same, the target, and nobody else in the picture."""
    spoken = re.fullmatch(r"(?:Follow|Track|Keep following|Keep up with) (.*)\.", texts[0]), re.fullmatch("(?:请跟随|请跟上|跟随|跟踪)(.*)。", texts[1])
    yield "phrase", all(spoken)
    if not all(spoken):
        return
    meant = english(spoken[0][1])
    yield "phrase in two languages", meant is not None and meant == chinese(spoken[1][1])
    if meant is not None and frame["visible_box_px"] is not None:
        middle = lambda edges: (edges[0] + edges[2]) / 2 / flight["camera_width_px"]
        means = lambda of, row, speed: may_fit(meant, described(row, of, speed, middle((frame if of else row)["visible_box_px"])))
        yield "phrase of the target", means("target_", flight, frame["target_speed_mps"])
        yield "phrase of nobody else", not any(means("", it, it["speed_mps"]) for it in others)


folder = sys.argv[1]
flights, frames, seen = flown(folder)
towns, on_road = Town.all_of(folder), (*PEOPLE, "bicycle", "motorcycle", "e_scooter")
on_foot = [kind for kind in PEOPLE if kind not in ("wheelchair", "sitter")]
counts, wrong, local, windows, others, silent = Counter(), [], 0, 0, 0, 0
for row in rows(folder, "windows", ["trajectory_id", "start_frame", "input_boxes_px", "instruction_en", "instruction_zh"]):
    name, start = row["trajectory_id"], row["start_frame"]
    last = start + len(row["input_boxes_px"]) // 4 - 1
    if flights[name]["target_kind"] not in on_foot:
        others += 1
        silent += not row["instruction_en"]
        found = list(phrase_claims([row["instruction_en"], row["instruction_zh"]], flights[name], frames[name][last], seen[name, last])) if row["instruction_en"] else []
        counts.update(claim for claim, _ in found)
        wrong += [f"{claim} in frame {last} of {name}: {row['instruction_en']} {row['instruction_zh']}" for claim, holds in found if not holds]
        continue
    people = [it for it in seen[name, last] if it["kind"] in on_road]
    picture = Picture(flights[name], frames[name][last], frames[name][start], people, towns[flights[name]["town"]])
    found = []
    for text in map(as_walked, filter(None, (row["instruction_en"], row["instruction_zh"]))):
        found = list(claims(text, picture))
        counts.update(claim for claim, _ in found)
        wrong += [f"{claim} in frame {last} of {name}: {text}" for claim, holds in found if not holds]
    windows += 1
    local += any(claim not in ("clothes", "backpack", "seen") for claim, _ in found)
print(f"{windows} windows behind people on foot, {100 * local / max(1, windows):.0f} % with a claim about the picture; {others} behind others, {silent} without a text; {dict(counts.most_common())}")
require(not wrong, f"{len(wrong)} claims are wrong:\n" + "\n".join(wrong[:10]))
require(local >= 0.5 * windows, "less than half of the windows say anything about the picture")
