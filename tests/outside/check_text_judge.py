"""Judges the judge of texts on true ordinary sentences and on texts with one planted error each.

Usage: `check_text_judge.py target/ci/examples/judge_of_stdin [--texts 1000] [--show 10]`. The program is an example of the crate `cosfly-captions`
(`cargo build --release -p cosfly-captions --example judge_of_stdin`). A text is written from the facts of a made-up flight with the sentences of
paraphrases.txt, which share nothing with cosfly's templates; a planted text from facts of which one is changed, or with a thing or a direction that
no facts have. Prints the share of planted errors that are caught, by their kind, and the share of true texts that are refused, and fails beyond the
limits below."""

import copy
import json
import math
import random
import sys
from collections import Counter, defaultdict
from pathlib import Path

from shared import COLOURS, IN_CHINESE, command_line, run

LEAST_CAUGHT, MOST_REFUSED = 0.98, 0.02
DIRECTIONS = "north northeast east southeast south southwest west northwest".split()
ZH = IN_CHINESE | dict(zip([*DIRECTIONS, "left", "right", "around"], "北 东北 东 东南 南 西南 西 西北 左转 右转 掉头".split()))
EN_DIGITS, ZH_DIGITS = "zero one two three four five six seven eight nine ten".split(), "零 一 两 三 四 五 六 七 八 九 十".split()


def stepped(value, step):
    return int(round(value / step) * step)


def made_up_flight(rng):
    """Facts of a flight: lengths, angles and times that fit together, any turns, stops and clothes."""
    walks = rng.random() < 0.87
    aside, altitude = rng.uniform(4, 45), rng.choice([0.2] + [rng.uniform(1, 40) for _ in range(3)])
    aimed = math.degrees(math.atan2(altitude - 1, aside)) + rng.uniform(-3, 3)
    speed = rng.uniform(0.6, 1.9)
    stops, turns = [], []
    if walks:
        stops = [{"frame": 10 * i, "duration_s": rng.choice([1.5, 2.0, 3.0, 4.0, 6.5])} for i in range(rng.choice([0, 0, 1, 1, 2, 3, 4]))]
        kinds = [rng.choice(["left", "right", "left", "right", "around"]) for _ in range(rng.choice([0, 0, 1, 1, 2, 2, 3, 4, 5, 6]))]
        turns = [{"frame": 20 * i + 5, "angle_deg": 90.0, "kind": kind} for i, kind in enumerate(kinds)]
    standing = sum(stop["duration_s"] for stop in stops)
    duration = max(rng.choice([rng.uniform(8, 30), rng.uniform(30, 160)]), standing + 6)
    directions = DIRECTIONS[2:] + DIRECTIONS[:2]
    start = rng.choice(directions)
    return {
        "walks": walks, "start_direction": start, "end_direction": rng.choice(directions) if turns else start, "turns": turns, "stops": stops,
        "duration_s": duration, "way_m": speed * (duration - standing) if walks else 0.0, "walking_speed_mps": speed if walks else 0.0,
        "distance_m": math.hypot(aside, altitude), "altitude_m": altitude, "visibility": 0.9,
        "pitch_down_deg": rng.choice([aimed] * 3 + [rng.uniform(-20, 5), 0.0, rng.uniform(-30, 70)]),
        "wear": None if rng.random() < 0.15 else {"top": rng.choice(COLOURS).capitalize(), "trousers": rng.choice(COLOURS).capitalize(), "backpack": rng.random() < 0.5},
    }


class Flight:
    """Facts of a flight, rounded as texts state them."""

    def __init__(self, facts):
        self.walks, self.directions = facts["walks"], [facts["start_direction"], facts["end_direction"]]
        self.d, self.p, self.h = (stepped(facts[name], 1) for name in ("distance_m", "pitch_down_deg", "altitude_m"))
        way, time = facts["way_m"], facts["duration_s"]
        self.w, self.t = stepped(way, 1 if way < 30 else 5 if way < 100 else 10), stepped(time, 1 if time < 30 else 5)
        self.v = round(facts["walking_speed_mps"], 1)
        self.turns, self.stops = [turn["kind"] for turn in facts["turns"]], len(facts["stops"])
        self.s = stepped(sum(stop["duration_s"] for stop in facts["stops"]), 1)
        wear = facts["wear"]
        self.wear = wear and [wear["top"].lower(), wear["trousers"].lower(), wear["backpack"]]


class Writer:
    """Writes texts of a language from the sentences of the file."""

    def __init__(self, language, seed):
        self.language, self.rng, self.parts = language, random.Random(f"{seed} {language}"), defaultdict(list)
        for line in Path(__file__).with_name("paraphrases.txt").read_text(encoding="utf-8").splitlines():
            if line.startswith(language + " "):
                name, text = line[3:].split(":", 1)
                self.parts[name].append(text.strip() if language == "zh" else text[1:])

    def pick(self, part, **slots):
        return self.rng.choice(self.parts[part]).format(**slots)

    def number(self, value):
        """Small numbers are words now and then."""
        digits = EN_DIGITS if self.language == "en" else ZH_DIGITS
        return digits[value] if 0 < value < len(digits) and self.rng.random() < 0.2 else str(value)

    def who(self, flight):
        if not flight.wear:
            return self.pick("bare")
        top, trousers, bag = flight.wear
        bag = self.pick("bag" if bag else "no_bag")
        if self.language == "zh":
            return self.pick("dressed", top=ZH[top], trousers=ZH[trousers], bag=bag)
        a_top = ("an " if top[0] in "aeiou" else "a ") + top
        return self.pick("dressed", top=top, a_top=a_top, trousers=trousers, bag=" " + bag if bag[:1].isalpha() else bag)

    def pitch(self, flight, part):
        way = "up" if flight.p < 0 else "down"
        part += " 1" if self.language == "zh" and flight.p < 0 else " 0" if self.language == "zh" else ""
        return self.pick(part, p=self.number(abs(flight.p)), d=self.number(flight.d), way=way, ward=way + "ward")

    def of_count(self, part, count, **slots):
        return self.pick(f"{part} {count if count < 2 else 'n'}", n=self.number(count), **slots)

    def text(self, flight, is_long):
        who = self.who(flight)
        if not is_long:
            parts = {"who": who, "distance": self.pick("distance", d=self.number(flight.d)), "pitch": self.pitch(flight, "pitch")}
            parts |= {name.capitalize(): text[0].upper() + text[1:] for name, text in parts.items()}
            text = self.pick("instruction", **parts)
            still = "" if flight.walks else self.pick("motionless")
            return f"{text} {still}".strip() if self.language == "en" else text + still
        names = [ZH[kind] for kind in flight.turns] if self.language == "zh" else flight.turns
        parts = {
            "who": who, "Who": who[0].upper() + who[1:], "drone": self.pitch(flight, "drone"),
            "height": self.pick("height", h=self.number(flight.h)) if flight.h >= 1 else "",
            "turns": self.of_count("turns", len(names), t="".join(names[:1]), list=(", then " if self.language == "en" else "，再").join(names)),
            "stops": self.of_count("stops", flight.stops, s=self.number(flight.s)),
            "length": self.pick("length", w=self.number(flight.w), t=self.number(flight.t), v=flight.v),
            "stands": self.pick("stands", t=self.number(flight.t)),
        }
        text = self.pick("description" if flight.walks else "still", **parts, Stops=parts["stops"])
        return " ".join(text.split()) if self.language == "en" else text

    def with_more(self, text, part, **slots):
        end = text[-1]
        more = self.pick(part, **slots)
        return text[:-1] + (" " if more[0].isalpha() and self.language == "en" else "") + more + end


def changed(flight, slot, rng):
    """Facts with one changed slot; None where the slot cannot be changed in these facts."""
    other = copy.deepcopy(flight)
    near = lambda value, least: value + rng.choice([-1, 1]) * (least + rng.randrange(6)) if value > least + 6 else value + least + rng.randrange(6)
    if slot == "distance":
        other.d = near(flight.d, 2)
    elif slot == "pitch":
        other.p = -flight.p if rng.random() < 0.3 and abs(flight.p) > 2 else flight.p + rng.choice([3, 5, 9])
    elif slot == "altitude" and flight.h >= 3:
        other.h = near(flight.h, 2)
    elif slot == "duration":
        other.t = flight.t + rng.choice([-1, 1, 2]) * (10 if flight.t >= 30 else 3)
    elif slot in ("top", "trousers") and flight.wear:
        at = ("top", "trousers").index(slot)
        other.wear[at] = rng.choice([it for it in COLOURS if it != flight.wear[at]])
    elif slot == "backpack" and flight.wear and not flight.wear[2]:
        other.wear[2] = True
    elif slot == "walking" and not flight.walks:
        other.walks, other.w, other.v, other.turns, other.stops = True, 60, 1.2, [], 0
    elif not flight.walks:
        return None
    elif slot == "standing":
        other.walks = False
    elif slot == "way":
        other.w += rng.choice([1, 2, 3]) * (20 if flight.w > 30 else 4)
    elif slot == "speed":
        other.v = round(flight.v + rng.choice([0.3, 0.5, 0.9]), 1)
    elif slot == "turn side" and flight.turns:
        at = rng.randrange(len(flight.turns))
        other.turns[at] = rng.choice([kind for kind in ("left", "right", "around") if kind != flight.turns[at]])
    elif slot == "turn order" and len(set(flight.turns)) > 1:
        at = next(i for i in range(len(flight.turns) - 1) if flight.turns[i] != flight.turns[i + 1])
        other.turns[at], other.turns[at + 1] = other.turns[at + 1], other.turns[at]
    elif slot == "turn count":
        other.turns = flight.turns[:-1] if flight.turns and rng.random() < 0.5 else [*flight.turns, rng.choice(["left", "right"])]
    elif slot == "stop count":
        other.stops, other.s = flight.stops + 1, flight.s or 4
    elif slot == "no stops" and flight.stops:
        other.stops = other.s = 0
    elif slot == "stop time" and flight.stops:
        other.s = flight.s + rng.choice([2, 4, 7])
    else:
        return None
    return other


IN_ALL = ["distance", "pitch", "top", "trousers", "backpack", "standing", "thing", "direction"]
SLOTS = [*IN_ALL, "walking", "altitude", "way", "duration", "speed", "turn side", "turn order", "turn count", "stop count", "no stops", "stop time"]


def planted(writer, flight, slot):
    """A text with one planted error; None where the facts have no place for it."""
    rng = writer.rng
    is_long = slot not in IN_ALL or rng.random() < 0.6
    if slot == "thing":
        return writer.with_more(writer.text(flight, is_long), slot)
    if slot == "direction":
        name = rng.choice([it for it in DIRECTIONS if it not in flight.directions])
        return writer.with_more(writer.text(flight, is_long), "heading", direction=name if writer.language == "en" else ZH[name])
    other = changed(flight, slot, rng)
    return other and writer.text(other, is_long)


def judged(program, facts, language, texts):
    """The contradictions that the judge finds in each text."""
    lines = "".join(json.dumps({"facts": facts[name], "language": language, "text": text}, ensure_ascii=False) + "\n" for name, text in texts)
    return [json.loads(line) for line in run(program, input=lines, encoding="utf-8").splitlines()]


given = command_line("program", texts=1000, show=10, seed=1)
stream = random.Random(given.seed)
facts = {f"flight-{number:03}": made_up_flight(stream) for number in range(120)}
flights = {name: Flight(it) for name, it in facts.items()}
is_good = True
for language in ("en", "zh"):
    writer, names = Writer(language, given.seed), list(flights)
    true = [(name, writer.text(flights[name], writer.rng.random() < 0.6)) for name in writer.rng.choices(names, k=given.texts)]
    wrong, kinds = [], []
    while len(wrong) < given.texts:
        slot, name = SLOTS[len(wrong) % len(SLOTS)], writer.rng.choice(names)
        text = planted(writer, flights[name], slot)
        if text and (name, text) not in true:
            wrong.append((name, text))
            kinds.append(slot)
    refused = [(text, found) for (_, text), found in zip(true, judged(given.program, facts, language, true), strict=True) if found]
    missed = [(kind, text) for kind, (_, text), found in zip(kinds, wrong, judged(given.program, facts, language, wrong), strict=True) if not found]
    caught, share = 1 - len(missed) / len(wrong), len(refused) / len(true)
    print(f"{language}: {100 * caught:.1f} % of {len(wrong)} planted errors caught, {100 * share:.1f} % of {len(true)} true texts refused; missed {dict(Counter(kind for kind, _ in missed))}")
    for text, found in refused[: given.show]:
        print("  refused:", text, "|", "; ".join(found))
    for kind, text in missed[: given.show]:
        print("  missed:", kind, "|", text)
    is_good &= caught >= LEAST_CAUGHT and share <= MOST_REFUSED
sys.exit(not is_good)
