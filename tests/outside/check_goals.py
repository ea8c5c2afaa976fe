"""Reads the goals of table `goals` and the descriptions of table `captions` from their own words and judges every claim by the other tables.

Usage: `check_goals.py DATASET_FOLDER [DATASET_FOLDER ...] [--least-skeletons N]`. Shares no code with cosfly. The words of a goal must say what its
column `claims` says, no more and no less, in English and in Chinese. Then every claim is judged by brute force over tables `frames`, `bodies`,
`objects` and `trajectories`: all claims of goals that fit, and all but those of the stated subject of goals that do not. Turns, times, lengths and
paces of descriptions are judged by `walk_words.py`. Prints the numbers of goals, claims and skeletons (texts whose slots are blank)."""

import re
from collections import Counter, defaultdict

import numpy as np
from goal_words import as_walked, read, skeleton
from shared import Town, command_line, end_with, flown, is_in, pixel, place, rows, turned
from walk_words import Way, when_said, wrongs

REACH_M = {"building": 10.0}
KIND_OF = {"tree": "tree_trunk", "parked_car": "car"}
ON_FOOT = ("pedestrian", "child", "elder", "push_chair", "dog_walker", "runner")
HIDERS = {"tree": {"tree_trunk", "tree_crown"}, "parked_car": {"car"}}
WORN = ("target_top_colour", "target_trousers_colour", "target_has_backpack")


# Kinds of bodies (none: the claim names one), whether they go from ahead to behind the target (1) or the other way, by what angle, how near.
PASSED = {"overtakes": (ON_FOOT, 1, (0, 40), 3.6), "meets": (ON_FOOT, 1, (140, 180), np.inf),
          "meets_vehicle": (None, 1, (140, 180), 8.5), "overtaken_by": (None, -1, (0, 40), 8.5)}


class Flight:
    def __init__(self, row, frames, people, town, crossings):
        self.row, self.town, self.crossings = row, town, crossings
        self.frames = [frames[number] for number in sorted(frames)]
        self.people = {number: people[row["trajectory_id"], number] for number in frames}
        column = lambda name: np.array([it[name] for it in self.frames])
        self.feet = np.array([place(it, "target") for it in self.frames])
        self.heading, self.speed, self.distance = column("target_heading_deg"), column("target_speed_mps"), column("distance_m")
        self.pixels, self.share, self.cause = column("visible_pixels"), column("visible_by_pixels"), column("occluder_instance")
        self.dt, self.count = float(row["dt_s"]), len(frames)
        self.names = {it["instance"]: it["kind"] for present in self.people.values() for it in present}
        self.way = Way(self.feet, self.speed >= 0.05, self.dt)

    def is_outside(self, frame):
        """Whether the middle of the body is outside of the picture, or within a pixel of its edge."""
        at = pixel(self.row, self.frames[frame], self.feet[frame] + [0, 0, self.row["target_height_m"] / 2])
        return at is None or (at < 1).any() or (at >= [self.row["camera_width_px"] - 1, self.row["camera_height_px"] - 1]).any()

    def hidden_by(self, name, frames):
        cause = set(self.cause[frames])
        if len(cause) != 1:
            return False
        cause = int(cause.pop())
        if cause in self.names:
            return self.names[cause] == name
        return bool(set(self.town.kind[self.town.instance == cause]) & HIDERS.get(name, {name}))

    def passes(self, kind, side, count, start, end):
        """Whether exactly so many instances of a kind are beside the target in these frames, all on one side: -1 left, 1 right, 0 neither."""
        sides, reach = defaultdict(set), 1.2 * REACH_M.get(kind, 5.0)
        for frame in range(start, end):
            feet = self.feet[frame]
            which, before, aside = self.town.nearest(KIND_OF.get(kind, kind), feet, np.radians(self.heading[frame]), reach + 1)
            level = np.abs(self.town.center[which, 2] - self.town.half[which, 2] - feet[2]) <= 3.0
            for at in np.flatnonzero(level & (np.abs(before) <= 1.0) & (np.abs(aside) <= reach)):
                sides[self.town.instance[which[at]]].add(0 if abs(aside[at]) < 0.5 else int(np.sign(aside[at])))
        sign = {"left": -1, "right": 1}[side]
        return sum(sign in on for on in sides.values()) == count and all(on == {sign} for on in sides.values() if sign in on)

    def walks_with(self, count, start, end):
        seen = Counter()
        for frame in range(start, end):
            for it in self.people.get(frame, []):
                away = np.hypot(*(np.array(it["feet_in_world_m"][:2]) - self.feet[frame, :2]))
                if it["kind"] in ON_FOOT and away < 3.6 and abs(turned(it["heading_deg"], self.heading[frame])) < 36 and it["speed_mps"] > 0.25:
                    seen[it["instance"]] += 1
        return sum(times >= 0.5 * (end - start) for times in seen.values()) == count

    def on_crossing(self, frame):
        x, y, z = self.feet[frame]
        near = [row for row in self.crossings if abs(np.mean(row["outline_z_m"]) - z) <= 1.5]
        return any(is_in(list(zip(row["outline_x_m"], row["outline_y_m"])), x, y) for row in near)

    def crosses(self, start, end):
        """On a crossing in these frames and neither before nor after, and far enough to be on the other side of the street."""
        around = [self.on_crossing(frame) for frame in (start - 1, end) if 0 <= frame < self.count]
        way = np.hypot(*(self.feet[end - 1, :2] - self.feet[start, :2]))
        return all(map(self.on_crossing, range(start, end))) and len(around) == 2 and not any(around) and way >= 5.0

    def is_passed(self, kinds, top, ways, turned_by, reach, start, end):
        """Whether somebody goes from ahead to behind the target (ways 1), or from behind to ahead (-1), between two frames."""
        for it in self.people.get(start, []):
            later = next((its for its in self.people.get(end - 1, []) if its["instance"] == it["instance"]), None)
            if it["kind"] not in kinds or top not in (None, it["top_colour"]) or later is None:
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

    def is_true(self, claim, start, end):
        name, *rest = claim
        frames = slice(start, end)
        if name == "wears":
            top, trousers, backpack = (self.row[column] for column in WORN)
            return rest[:2] == [top, trousers] and (("backpack" in rest) <= backpack)
        if name == "distance":
            return abs(self.distance[frames].mean() - int(rest[0])) <= 0.51
        if name == "turns":
            return self.way.turns_to(rest[0], start)
        if name == "turns_in_all":
            return self.way.clear_turns() <= int(rest[0]) <= len(self.way.events())
        if name == "no_turn":
            return self.way.sharpest(start, end) < 60
        still = self.speed < 0.05
        if name == "stands":
            return still[frames].all()
        if name == "stops":
            around = [still[frame] for frame in (start - 1, end) if 0 <= frame < self.count]
            return still[frames].all() and not any(around) and abs((end - start) * self.dt - int(rest[0])) <= 0.51
        if name == "passes":
            is_after = rest[3:] != ["after_crossing"] or self.on_crossing(start - 1) and not any(map(self.on_crossing, range(start, end)))
            return is_after and self.passes(rest[0], rest[1], int(rest[2]), start, end)
        if name == "crosses":
            return self.crosses(start, end)
        if name in PASSED:
            kinds, ways, turned_by, reach = PASSED[name]
            return self.is_passed(kinds or rest, rest[0] if kinds else None, ways, turned_by, reach, start, end)
        if name == "lost":
            behind, seconds, end_of = rest
            hidden = (self.pixels[frames] == 0).all() and all(self.pixels[frame] > 0 for frame in (start - 1, end) if 0 <= frame < self.count)
            cause = all(self.is_outside(frame) for frame in range(start, end)) if behind == "outside" else self.hidden_by(behind, frames)
            return hidden and cause and abs((end - start) * self.dt - int(seconds)) <= 0.51 and (end_of == "found") == (end < self.count)
        if name == "partly_hidden":
            return (self.pixels[frames] > 0).all() and (self.share[frames] < 0.5).all() and self.hidden_by(rest[0], frames)
        if name == "walks_with":
            return self.walks_with(int(rest[0]), start, end)
        raise SystemExit(f"unknown claim {claim}")


SUBJECTS = {claim: subject for subject, claims in {
    "clothes": "wears", "distance": "distance", "turn": "turns turns_in_all no_turn", "stop": "stops stands", "landmark": "passes crosses",
    "sight": "lost partly_hidden", "people": "walks_with meets overtakes", "vehicles": "meets_vehicle overtaken_by"}.items() for claim in claims.split()}


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
        counts[name[0]] += 1
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
        others = [it for it in flight.people.get(start, []) if it["kind"] in ON_FOOT]
        top = pilot[0][1]
        if top == flight.row["target_top_colour"] or sum(it["top_colour"] == top for it in others) != 1:
            wrong.append(f"{where}: the pilot's colour is nobody else's, or several people's")
        own = [flight.row[column] for column in WORN][:2]
        if any([it["top_colour"], it["trousers_colour"]] == own for it in others):
            wrong.append(f"{where}: the correction fits others as well")
        if len(others) != 1 and ("other" in goal["lines"][2] or "另一个" in goal["lines"][2]):
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
        pace = flight.speed[flight.speed >= 0.05].mean()
        words = r"\bwalk(s|ing)?\b|on foot|走|步行" if pace > 2.6 else r"\brun(s|ning)?\b|跑" if pace < 1.8 else "(?!)"
        if re.search(words, text):
            wrong.append(f"{row['trajectory_id']} `{text}`: the pace is {pace:.1f} m/s")
        text = as_walked(text)
        times[row["trajectory_id"]].add(when_said(text))
        said[(row["language"], when_said(text), re.search(r"turns [a-z, ]*around|掉头", text) is not None)] += 1
    wrong += [f"{name}: its descriptions say that the first turn comes {found}" for name, found in times.items() if len(found) > 1]
    print("  descriptions by language, time of the first turn, turn around:", dict(said))


def check(folder, texts):
    found, frames, people = flown(folder)
    towns, crossings = Town.all_of(folder), defaultdict(list)
    for row in rows(folder, "crossings"):
        crossings[row["trajectory_id"]].append(row)
    flights = {name: Flight(row, frames[name], people, towns[row["town"]], crossings[name]) for name, row in found.items()}
    goals, wrong, counts = rows(folder, "goals"), [], Counter()
    judge_descriptions(rows(folder, "captions"), flights, wrong)
    texts += goals
    for goal in goals:
        judge(goal, flights[goal["trajectory_id"]], wrong, counts)
    grains = Counter((goal["grain"], goal["language"]) for goal in goals)
    print(f"{folder}: {len(goals)} goals of {len(flights)} flights, {len(wrong)} wrong; {dict(sorted(grains.items()))}")
    print("  claims:", dict(counts))
    return wrong


given, texts = command_line("folders+", least_skeletons=0), []
problems = [it for folder in given.folders for it in check(folder, texts)]
for language in ("en", "zh"):
    own = [goal for goal in texts if goal["language"] == language]
    different = {skeleton(" / ".join(goal["lines"]), language) for goal in own}
    print(f"{language}: {len(different)} skeletons in {len(own)} goals")
    if len(different) < given.least_skeletons:
        problems.append(f"{language} has {len(different)} skeletons; wanted are {given.least_skeletons}")
end_with(problems)
