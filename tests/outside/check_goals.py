"""Reads the goals of table `goals` and the descriptions of table `captions` from their own words and judges every claim by the other tables.

    venv/bin/python tests/outside/check_goals.py DATASET_FOLDER [DATASET_FOLDER ...] [--texts FILE] [--least-skeletons N]

Shares no code with cosfly. The words of a goal must say what its column `claims` says, no more and no less, in English and in Chinese.
Then every claim is judged by brute force over tables `frames`, `bodies`, `objects` and `trajectories`: all claims of goals that fit, and all but
those of the stated subject of goals that do not. Turns, times, lengths and paces of descriptions are judged by `walk_words.py`. Prints the numbers of goals, claims and skeletons (texts whose slots are blank).
"""

import argparse
import re
import sys
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
import pyarrow.dataset as ds

from goal_words import read, skeleton
from walk_words import Way, when_said, wrongs

REACH_M = {"building": 10.0}
KIND_OF = {"tree": "tree_trunk", "parked_car": "car"}
HIDERS = {"tree": {"tree_trunk", "tree_crown"}, "parked_car": {"car"}}
WORN = {"people": ("top_colour", "trousers_colour", "has_backpack"), "flights": ("target_top_colour", "target_trousers_colour", "target_has_backpack")}


def turned(to, of):
    return (to - of + 180) % 360 - 180


class Town:
    """The boxes of a town."""

    def __init__(self, rows):
        self.kind_of = {row["instance"]: row["kind"] for row in rows}
        self.kinds = defaultdict(set)
        for row in rows:
            self.kinds[row["instance"]].add(row["kind"])
        self.boxes = defaultdict(list)
        for row in rows:
            self.boxes[row["kind"]].append((row["instance"], np.array(row["center_in_world_m"]), np.array(row["size_m"]) / 2, np.radians(row["yaw_deg"])))
        self.arrays = {kind: (np.array([it[0] for it in boxes]), np.array([it[1] for it in boxes]), np.array([it[2] for it in boxes]), np.array([it[3] for it in boxes])) for kind, boxes in self.boxes.items()}

    def beside(self, kind, feet, heading, reach):
        """Instances of a kind that are beside a walker, with their sides: -1 left, 1 right, 0 neither."""
        if kind not in self.arrays:
            return {}
        instance, center, half, yaw = self.arrays[kind]
        cos, sin = np.cos(yaw), np.sin(yaw)
        dx, dy = feet[0] - center[:, 0], feet[1] - center[:, 1]
        own = np.stack([cos * dx + sin * dy, cos * dy - sin * dx], 1)
        to = np.clip(own, -half[:, :2], half[:, :2]) - own
        x, y = cos * to[:, 0] - sin * to[:, 1], sin * to[:, 0] + cos * to[:, 1]
        before, aside = np.cos(heading) * x + np.sin(heading) * y, np.cos(heading) * y - np.sin(heading) * x
        level = np.abs(center[:, 2] - half[:, 2] - feet[2]) <= 3.0
        there = level & (np.abs(before) <= 1.0) & (np.abs(aside) <= reach)
        return {int(instance[at]): (0 if abs(aside[at]) < 0.5 else int(np.sign(aside[at]))) for at in np.flatnonzero(there)}


class Flight:
    def __init__(self, row, frames, people, town, crossings):
        self.row, self.town, self.people, self.crossings = row, town, people, crossings
        frames = sorted(frames, key=lambda it: it["frame"])
        column = lambda name: np.array([it[name] for it in frames])
        self.feet = np.stack([column(f"target_{axis}_m") for axis in "xyz"], 1)
        self.heading, self.speed, self.distance = column("target_heading_deg"), column("target_speed_mps"), column("distance_m")
        self.pixels, self.share, self.cause = column("visible_pixels"), column("visible_by_pixels"), column("occluder_instance")
        self.eye = np.stack([column(f"drone_{axis}_m") for axis in "xyz"], 1)
        self.angles = np.radians(np.stack([column(f"camera_{name}_deg") for name in ("pitch", "yaw", "roll")], 1))
        self.dt = float(row["dt_s"])
        self.count = len(frames)
        self.names = {}
        for rows in people.values():
            self.names.update({it["instance"]: it["kind"] for it in rows})
        self.runs = {}
        self.way = Way(self.feet, self.speed >= 0.05, self.dt)

    def is_outside(self, frame):
        """Whether the middle of the body is outside of the picture, or within a pixel of its edge."""
        (cp, cy, cr), (sp, sy, sr) = np.cos(self.angles[frame]), np.sin(self.angles[frame])
        axes = np.array([[cp * cy, cp * sy, sp], [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, -cp * sr], [-cy * sp * cr - sy * sr, -sy * sp * cr + cy * sr, cp * cr]])
        ahead, right, up = axes @ (self.feet[frame] + [0, 0, self.row["target_height_m"] / 2] - self.eye[frame])
        width, height, focal = (self.row[f"camera_{name}_px"] for name in ("width", "height", "focal"))
        if ahead <= 0:
            return True
        u, v = width / 2 + focal * right / ahead, height / 2 - focal * up / ahead
        return not (1 <= u < width - 1 and 1 <= v < height - 1)

    def hidden_by(self, name, frames):
        cause = set(self.cause[frames])
        if len(cause) != 1:
            return False
        cause = int(cause.pop())
        if cause in self.names:
            return self.names[cause] == name
        return bool(self.town.kinds.get(cause, set()) & HIDERS.get(name, {name}))

    def passes(self, kind, side, count, start, end):
        sides = defaultdict(set)
        table_kind = KIND_OF.get(kind, kind)
        for frame in range(start, end):
            there = self.town.beside(table_kind, self.feet[frame], np.radians(self.heading[frame]), 1.2 * REACH_M.get(kind, 5.0))
            for instance, on in there.items():
                sides[instance].add(on)
        sign = {"left": -1, "right": 1}[side]
        return sum(sign in on for on in sides.values()) == count and all(on == {sign} for on in sides.values() if sign in on)

    def walks_with(self, count, start, end):
        seen = Counter()
        for frame in range(start, end):
            for it in self.people.get(frame, []):
                away = np.hypot(*(np.array(it["feet_in_world_m"][:2]) - self.feet[frame, :2]))
                if it["kind"] == "pedestrian" and away < 3.6 and abs(turned(it["heading_deg"], self.heading[frame])) < 36 and it["speed_mps"] > 0.25:
                    seen[it["instance"]] += 1
        return sum(times >= 0.5 * (end - start) for times in seen.values()) == count

    def on_crossing(self, frame):
        """Whether the target stands on a marked crossing, by the number of its sides that a ray along x meets."""
        x, y, z = self.feet[frame]
        for row in self.crossings:
            corners = list(zip(row["outline_x_m"], row["outline_y_m"]))
            if abs(np.mean(row["outline_z_m"]) - z) > 1.5:
                continue
            sides = zip(corners, corners[1:] + corners[:1])
            if sum((a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) for a, b in sides) % 2:
                return True
        return False

    def crosses(self, start, end):
        """On a crossing in these frames and neither before nor after, and far enough to be on the other side of the street."""
        around = [self.on_crossing(frame) for frame in (start - 1, end) if 0 <= frame < self.count]
        way = np.hypot(*(self.feet[end - 1, :2] - self.feet[start, :2]))
        return all(map(self.on_crossing, range(start, end))) and len(around) == 2 and not any(around) and way >= 5.0

    def is_passed(self, kind, top, ways, turned_by, start, end, reach=3.6):
        """Whether somebody goes from ahead to behind the target (ways 1), or from behind to ahead (-1), between two frames."""
        for it in self.people.get(start, []):
            later = next((its for its in self.people.get(end - 1, []) if its["instance"] == it["instance"]), None)
            if it["kind"] != kind or top not in (None, it["top_colour"]) or later is None:
                continue
            ahead, aside = [], []
            for frame, body in ((start, it), (end - 1, later)):
                heading = np.radians(self.heading[frame])
                way = np.array(body["feet_in_world_m"][:2]) - self.feet[frame, :2]
                ahead.append(ways * way @ [np.cos(heading), np.sin(heading)])
                aside.append(abs(way @ [-np.sin(heading), np.cos(heading)]))
            turned_deg = abs(turned(it["heading_deg"], self.heading[start]))
            if ahead[0] > 0 >= ahead[1] and max(aside) <= reach and turned_by[0] <= turned_deg <= turned_by[1]:
                return True
        return False

    def meets(self, top, start, end):
        for it in self.people.get(start, []):
            later = next((its for its in self.people.get(end - 1, []) if its["instance"] == it["instance"]), None)
            if it["kind"] != "pedestrian" or it["top_colour"] != top or later is None:
                continue
            ahead = []
            for frame, person in ((start, it), (end - 1, later)):
                heading = np.radians(self.heading[frame])
                way = np.array(person["feet_in_world_m"][:2]) - self.feet[frame, :2]
                ahead.append(way @ [np.cos(heading), np.sin(heading)])
            if ahead[0] > 0 >= ahead[1] and abs(turned(it["heading_deg"], self.heading[start])) > 140:
                return True
        return False

    def is_true(self, claim, start, end):
        name, *rest = claim
        frames = slice(start, end)
        if name == "wears":
            top, trousers, backpack = (self.row[column] for column in WORN["flights"])
            return rest[:2] == [top, trousers] and (("backpack" in rest) <= backpack)
        if name == "distance":
            return abs(self.distance[frames].mean() - int(rest[0])) <= 0.51
        if name == "turns":
            return self.way.turns_to(rest[0], start)
        if name == "turns_in_all":
            events = self.way.events()
            return self.way.clear_turns() <= int(rest[0]) <= len(events)
        if name == "no_turn":
            return self.way.sharpest(start, end) < 60
        if name in ("stops", "stands"):
            still = self.speed < 0.05
            if name == "stands":
                return still[frames].all()
            around = [still[frame] for frame in (start - 1, end) if 0 <= frame < self.count]
            return still[frames].all() and not any(around) and abs((end - start) * self.dt - int(rest[0])) <= 0.51
        if name == "passes":
            is_after = rest[3:] != ["after_crossing"] or self.on_crossing(start - 1) and not any(map(self.on_crossing, range(start, end)))
            return is_after and self.passes(rest[0], rest[1], int(rest[2]), start, end)
        if name == "crosses":
            return self.crosses(start, end)
        if name == "overtakes":
            return self.is_passed("pedestrian", rest[0], 1, (0, 40), start, end)
        if name == "meets_vehicle":
            return self.is_passed(rest[0], None, 1, (140, 180), start, end, 8.5)
        if name == "overtaken_by":
            return self.is_passed(rest[0], None, -1, (0, 40), start, end, 8.5)
        if name == "lost":
            behind, seconds, end_of = rest
            hidden = (self.pixels[frames] == 0).all() and all(self.pixels[frame] > 0 for frame in (start - 1, end) if 0 <= frame < self.count)
            cause = all(self.is_outside(frame) for frame in range(start, end)) if behind == "outside" else self.hidden_by(behind, frames)
            return hidden and cause and abs((end - start) * self.dt - int(seconds)) <= 0.51 and (end_of == "found") == (end < self.count)
        if name == "partly_hidden":
            return (self.pixels[frames] > 0).all() and (self.share[frames] < 0.5).all() and self.hidden_by(rest[0], frames)
        if name == "walks_with":
            return self.walks_with(int(rest[0]), start, end)
        if name == "meets":
            return self.meets(rest[0], start, end)
        raise SystemExit(f"unknown claim {claim}")


SUBJECTS = {"wears": "clothes", "distance": "distance", "turns": "turn", "turns_in_all": "turn", "no_turn": "turn", "stops": "stop", "stands": "stop", "passes": "landmark", "lost": "sight", "partly_hidden": "sight", "walks_with": "people", "meets": "people", "overtakes": "people", "crosses": "landmark", "meets_vehicle": "vehicles", "overtaken_by": "vehicles"}


def judge(goal, flight, wrong, counts):
    """Adds what is wrong with a goal to a list."""
    where = f"{goal['goal_id']} {goal['grain']} `{' / '.join(goal['lines'])}`"
    claims = [(*said.split(" @ ")[0].split(), *map(int, said.split(" @ ")[1].split(".."))) for said in goal["claims"]]
    bare = sorted(tuple(str(word) for word in claim[:-2]) for claim in claims)
    words = read(goal["lines"][-1] if goal["grain"] == "dialogue" else goal["lines"][0], goal["language"])
    if goal["grain"] == "dialogue":
        first = [claim for claim in read(goal["lines"][0], goal["language"]) if claim[0] == "wears"]
        words += [claim for claim in first if claim not in words]
        has_clothes = any(claim[0] == "wears" for claim in words)
        bare = [claim for claim in bare if claim[0] != "wears" or has_clothes]
        if goal["lines"][2] and "backpack" not in " ".join(map(" ".join, words)):
            bare = [tuple(word for word in claim if word != "backpack") for claim in bare]
    without_time = lambda claim: (claim[0], claim[1], claim[3]) if claim[0] == "lost" and claim[3] == "gone" else claim
    said, meant = sorted(map(without_time, words)), sorted(map(without_time, bare))
    if said != meant:
        wrong.append(f"{where} says {said}; its claims are {meant}")
        return
    if goal["grain"] != "dialogue" and all(claim[0] in ("wears", "distance") for claim in claims):
        wrong.append(f"{where}: nothing is said of the way")
    for claim in claims:
        *name, start, end = claim
        holds = flight.is_true([str(word) for word in name], start, end)
        counts[name[0], goal["grain"]] += 1
        is_false_one = goal["grain"] == "negative" and SUBJECTS[name[0]] == goal["false_subject"]
        if not holds and not is_false_one:
            wrong.append(f"{where}: {claim} is not so")
    if goal["grain"] == "negative":
        false_ones = [claim for claim in claims if SUBJECTS[claim[0]] == goal["false_subject"]]
        if all(flight.is_true([str(word) for word in claim[:-2]], claim[-2], claim[-1]) for claim in false_ones):
            wrong.append(f"{where}: everything in it is so")
    if goal["grain"] == "dialogue":
        judge_dialogue(goal, flight, where, wrong)


def judge_dialogue(goal, flight, where, wrong):
    """The pilot's line must be false of the target, and what the user says must single the target out."""
    pilot = read(goal["lines"][1], goal["language"], is_pilot=True)
    if not pilot:
        return wrong.append(f"{where}: the pilot says nothing")
    start, end = goal["start_frame"], goal["end_frame"]
    if goal["false_subject"] == "clothes":
        others = [it for it in flight.people.get(start, []) if it["kind"] == "pedestrian"]
        top = pilot[0][1]
        if top == flight.row["target_top_colour"] or sum(it["top_colour"] == top for it in others) != 1:
            wrong.append(f"{where}: the pilot's colour is nobody else's, or several people's")
        own = [flight.row[column] for column in WORN["flights"]][:2]
        if any([it["top_colour"], it["trousers_colour"]] == own for it in others):
            wrong.append(f"{where}: the correction fits others as well")
        if "other" in goal["lines"][2] or "另一个" in goal["lines"][2]:
            if len(others) != 1:
                wrong.append(f"{where}: `the other one` of {len(others) + 1} people")
    elif goal["false_subject"] == "turn":
        turns = [int(said.split(" @ ")[1].split("..")[0]) for said in goal["claims"] if said.startswith("turns")]
        if any(flight.way.turns_to(pilot[0][1], frame) and not flight.way.turns_to("right" if pilot[0][1] == "left" else "left", frame) for frame in turns):
            wrong.append(f"{where}: the pilot is right")
    elif goal["false_subject"] == "distance" and flight.is_true(list(pilot[0]), start, end):
        wrong.append(f"{where}: the pilot is right")


def judge_descriptions(captions, flights, wrong):
    """Adds what is wrong with the descriptions of walks to a list; counts what they say of turns and times."""
    said, times = Counter(), defaultdict(set)
    for row in captions:
        flight, text = flights[row["trajectory_id"]], row["text"]
        if row["style"] != "description" or row["writer"] != "template" or flight.way.length < 1:
            continue
        standing_s = (flight.speed < 0.05).sum() * flight.dt
        wrong += [f"{row['trajectory_id']} `{text}`: {it}" for it in wrongs(text, row["language"], flight.way, standing_s)]
        times[row["trajectory_id"]].add(when_said(text))
        said[(row["language"], when_said(text), re.search(r"turns [a-z, ]*around|掉头", text) is not None)] += 1
    wrong += [f"{name}: its descriptions say that the first turn comes {found}" for name, found in times.items() if len(found) > 1]
    print("  descriptions by language, time of the first turn, turn around:", dict(said))


def check(folder, texts):
    table = lambda name, columns=None: ds.dataset(Path(folder) / "data" / name, format="parquet").to_table(columns=columns).to_pylist()
    objects = defaultdict(list)
    for row in table("objects"):
        objects[row["town"]].append(row)
    towns = {name: Town(rows) for name, rows in objects.items()}
    frames, people = defaultdict(list), defaultdict(lambda: defaultdict(list))
    for row in table("frames", ["trajectory_id", "frame", *[f"target_{axis}_m" for axis in "xyz"], "target_heading_deg", "target_speed_mps", "distance_m", "visible_pixels", "visible_by_pixels", "occluder_instance", "drone_x_m", "drone_y_m", "drone_z_m", "camera_pitch_deg", "camera_yaw_deg", "camera_roll_deg"]):
        frames[row["trajectory_id"]].append(row)
    for row in table("bodies", ["trajectory_id", "frame", "instance", "kind", "feet_in_world_m", "heading_deg", "speed_mps", "top_colour", "trousers_colour", "visible_pixels"]):
        if row["visible_pixels"]:
            people[row["trajectory_id"]][row["frame"]].append(row)
    crossings = defaultdict(list)
    for row in table("crossings"):
        crossings[row["trajectory_id"]].append(row)
    flights = {row["trajectory_id"]: Flight(row, frames[row["trajectory_id"]], people[row["trajectory_id"]], towns[row["town"]], crossings[row["trajectory_id"]]) for row in table("trajectories")}
    goals, wrong, counts, skeletons = table("goals"), [], Counter(), defaultdict(Counter)
    judge_descriptions(table("captions", ["trajectory_id", "language", "style", "writer", "text"]), flights, wrong)
    for goal in goals:
        judge(goal, flights[goal["trajectory_id"]], wrong, counts)
        texts.append(goal)
        skeletons[goal["language"]].update(skeleton(" / ".join(goal["lines"]), goal["language"]) for _ in (0,))
    grains = Counter((goal["grain"], goal["language"]) for goal in goals)
    print(f"{folder}: {len(goals)} goals of {len(flights)} flights, {len(wrong)} wrong; {dict(sorted(grains.items()))}")
    print("  claims:", dict(sorted(Counter({}).items())) or dict(sum((Counter({name: times}) for (name, _), times in counts.items()), Counter())))
    return wrong


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folders", nargs="+")
    arguments.add_argument("--show", help="prints so many goals of each language", type=int, default=0)
    arguments.add_argument("--least-skeletons", type=int, default=0)
    given = arguments.parse_args()
    texts = []
    wrong = [it for folder in given.folders for it in check(folder, texts)]
    for language in ("en", "zh"):
        own = [goal for goal in texts if goal["language"] == language]
        lines = [line for goal in own for line in ([" / ".join(goal["lines"])])]
        different = {skeleton(line, language) for line in lines}
        print(f"{language}: {len(different)} skeletons in {len(lines)} goals")
        if len(different) < given.least_skeletons:
            wrong.append(f"{language} has {len(different)} skeletons; wanted are {given.least_skeletons}")
        for goal in own[: given.show]:
            print(f"  {goal['grain']:8}", " / ".join(goal["lines"]), "|", goal["false_subject"] or "")
    print(*wrong[:20], sep="\n")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
