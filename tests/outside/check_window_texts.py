"""Reads the instructions of table `windows` and compares every claim with the other tables.

    venv/bin/python tests/outside/check_window_texts.py DATASET_FOLDER

Shares no code with cosfly. A claim is found by its words, in English and in Chinese, and judged by the boxes, pixels, places and
clothes of tables `frames`, `people` and `trajectories` in the last frame of the input. Prints how often each claim occurs.
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


def turned_deg(to, of):
    return (to - of + 180) % 360 - 180


class Picture:
    """Facts of one frame from the tables, by words."""

    def __init__(self, flight, frame, first, people):
        self.flight, self.frame, self.people = flight, frame, people
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
        (("on the left of", "位于画面左"), "on the left", lambda it: it < 0.45),
        (("in the middle of", "画面中央"), "in the middle", lambda it: 0.4 < it < 0.6),
        (("on the right of", "位于画面右"), "on the right", lambda it: it > 0.55),
    ] if has(*words))
    if has("only person", "唯一") or "独自" in text:
        yield "alone", not people
    outermost = re.search(r"(最左|最右)" if zh else r"(leftmost|rightmost)", text)
    if outermost:
        sign = 1 if outermost[1] in ("leftmost", "最左") else -1
        count = re.search("画面中(.)个人" if zh else r"of the (\w+) people", text)[1]
        yield "outermost", NUMBERS[count] == len(people) + 1 and all(sign * picture.across(it) > sign * at for it in people)
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
        "trajectory_id", "camera_width_px", "target_top_colour", "target_trousers_colour", "target_has_backpack"])}
    frames = {(row["trajectory_id"], row["frame"]): row for row in rows("frames", [
        "trajectory_id", "frame", "drone_x_m", "drone_y_m", "drone_z_m", "camera_yaw_deg", "target_x_m", "target_y_m",
        "target_z_m", "target_heading_deg", "visible_box_px"])}
    people = {}
    for row in rows("people", ["trajectory_id", "frame", "feet_in_world_m", "heading_deg", "speed_mps", "top_colour", "visible_box_px"]):
        people.setdefault((row["trajectory_id"], row["frame"]), []).append(row)
    counts, wrong, local, windows = Counter(), [], 0, 0
    for row in rows("windows", ["trajectory_id", "start_frame", "input_boxes_px", "instruction_en", "instruction_zh"]):
        name, start = row["trajectory_id"], row["start_frame"]
        last = start + len(row["input_boxes_px"]) // 4 - 1
        picture = Picture(flights[name], frames[name, last], frames[name, start], people.get((name, last), []))
        for text in (row["instruction_en"], row["instruction_zh"]):
            found = list(claims(text, picture))
            counts.update(claim for claim, _ in found)
            wrong += [f"{claim} in frame {last} of {name}: {text}" for claim, holds in found if not holds]
        windows += 1
        local += any(claim not in ("clothes", "backpack", "seen") for claim, _ in found)
    print(f"{windows} windows, {100 * local / windows:.0f} % with a claim about the picture; {dict(counts.most_common())}")
    if wrong:
        raise SystemExit(f"check_window_texts: {len(wrong)} claims are wrong:\n" + "\n".join(wrong[:10]))
    if local < 0.5 * windows:
        raise SystemExit("check_window_texts: less than half of the windows say anything about the picture")


if __name__ == "__main__":
    main()
