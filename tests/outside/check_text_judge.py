"""Judges the judge of texts: `cosfly doctor --texts` on true paraphrases and on texts with one planted error each.

    check_text_judge.py COSFLY DATASET [--texts 1000] [--show 10] [--grammar 1]
    check_text_judge.py target/release/examples/judge_of_stdin made-up --grammar 15

The grammar here shares nothing with cosfly's templates. A text is written from the facts of a flight; a planted text from facts of
which one is changed, or with one thing that no facts have. Of planted texts at least 99 % must be refused, of true ones at most 2 %.

The second form needs no dataset: it judges texts about made-up flights by an example of the crate `cosfly-captions`
(`cargo build --release -p cosfly-captions --example judge_of_stdin`).
"""

import argparse
import copy
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from grammars import GRAMMARS, LEAVE_STANDING_OUT
from made_up_flights import flights as flights_of_no_drone

COLOURS = ["black", "grey", "white", "red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "beige"]
ZH_COLOURS = dict(zip(COLOURS, "黑 灰 白 红 橙 黄 绿 蓝 紫 粉 棕 米".split()))
UNITS = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "zero ten twenty thirty forty fifty sixty seventy eighty ninety".split()


def in_words(value):
    if value < 20:
        return UNITS[value]
    if value < 100:
        return TENS[value // 10] + ("-" + UNITS[value % 10] if value % 10 else "")
    rest = value % 100
    return UNITS[value // 100] + " hundred" + (" and " + in_words(rest) if rest else "")


def in_chinese(value):
    digits = "零一二三四五六七八九"
    if value == 2:
        return "两"
    if value < 10:
        return digits[value]
    if value < 100:
        tens = "" if value < 20 else digits[value // 10]
        return tens + "十" + (digits[value % 10] if value % 10 else "")
    rest = value % 100
    text = digits[value // 100] + "百"
    if rest:
        text += "零" + digits[rest] if rest < 10 else digits[rest // 10] + "十" + (digits[rest % 10] if rest % 10 else "")
    return text


def stepped(value, step):
    return round(value / step) * step


class Flight:
    """Facts of a flight, rounded as texts state them."""

    def __init__(self, facts):
        self.walks = facts["walks"]
        self.distance = int(stepped(facts["distance_m"], 1))
        self.pitch = int(stepped(facts["pitch_down_deg"], 1))
        self.altitude = int(stepped(facts["altitude_m"], 1))
        way = facts["way_m"]
        self.way = int(stepped(way, 1 if way < 30 else 5 if way < 100 else 10))
        duration = facts["duration_s"]
        self.duration = int(stepped(duration, 1 if duration < 30 else 5))
        self.speed = round(stepped(facts["walking_speed_mps"], 0.1), 1)
        self.turns = [turn["kind"] for turn in facts["turns"]]
        self.stops = len(facts["stops"])
        self.standing = int(stepped(sum(stop["duration_s"] for stop in facts["stops"]), 1))
        self.bends = facts.get("bends", False) or facts["start_direction"] != facts["end_direction"]
        wear = facts["wear"]
        self.wear = wear and [wear["top"].lower(), wear["trousers"].lower(), wear["backpack"]]
        self.directions = [facts["start_direction"].lower(), facts["end_direction"].lower()]


class English:
    code = "en"
    things = [
        "beside a parked van", "past the second house", "near the bus stop", "under a tree", "with two friends", "along the river",
        "in heavy rain", "behind a cyclist", "across the crossing", "with a dog", "next to a tall building", "among a crowd", "by the fountain",
        "at night", "wearing a hat", "holding an umbrella",
    ]
    persons = ["woman", "cyclist", "boy", "driver", "man", "child"]

    def __init__(self, rng):
        self.rng = rng

    def pick(self, *choices):
        return self.rng.choice(choices)

    def number(self, value):
        return in_words(value) if 0 < value < 1000 and self.rng.random() < 0.2 else str(value)

    def person(self, flight):
        noun = self.pick("walker", "pedestrian", "person", "target", "subject")
        if not flight.wear:
            return "the " + noun
        top, trousers, backpack = flight.wear
        an = lambda word: ("an " if word[0] in "aeiou" else "a ") + word
        who = self.pick(
            f"the {noun} dressed in {an(top)} jacket with {trousers} jeans",
            f"the {noun} who wears {an(top)} shirt over {trousers} pants",
            f"the {noun} whose top is {top} and whose trousers are {trousers}",
            f"the {top}-shirted {noun} in {trousers} slacks",
            f"the {noun} in {trousers} trousers and {an(top)} coat",
            f"the {noun} with the {top} hoodie and the {trousers} bottoms",
        )
        if backpack:
            who += self.pick(" and a rucksack", " carrying a backpack", ", backpack on the shoulders,")
        elif self.rng.random() < 0.2:
            who += self.pick(" and no backpack", ", without a rucksack,")
        return who

    def distance(self, flight):
        d = self.number(flight.distance)
        return self.pick(
            f"hang back roughly {d} m", f"leave a gap of {d} metres", f"trail by some {d} m", f"stay {d} metres off",
            f"keep {d} metres of separation", f"remain around {d} m away", f"follow at {d} m", f"give it {d} metres of room",
        )

    def pitch(self, flight):
        p, way = self.number(abs(flight.pitch)), ["downward", "down"] if flight.pitch >= 0 else ["upward", "up"]
        return self.pick(
            f"tilt the lens {p} degrees {way[0]}", f"angle the camera {way[1]} by {p} degrees", f"aim {way[1]} at {abs(flight.pitch)}°",
            f"hold a {p}-degree {way[0]} tilt", f"pitch the gimbal {way[1]} some {p} degrees",
        )

    def instruction(self, flight):
        who, distance, pitch = self.person(flight), self.distance(flight), self.pitch(flight)
        state = "" if flight.walks else self.pick(" The target does not move from the spot; it stands still.", " The target stays motionless.")
        verb = self.pick("Shadow", "Pursue", "Go after", "Film", "Tail", "Keep an eye on")
        return self.pick(
            f"{verb} {who}: {distance} and {pitch}.{state}",
            f"{distance.capitalize()}, {pitch}, and {verb.lower()} {who}.{state}",
            f"{verb} {who}. {pitch.capitalize()}; {distance}.{state}",
        )

    def turns(self, flight):
        name = {"left": "left", "right": "right", "around": "around"}
        turns = [name[kind] for kind in flight.turns]
        if not turns:
            return self.pick("makes no turns", "never turns off", "goes on without turning")
        if len(turns) == 1:
            if turns[0] == "around":
                return self.pick("turns around once", "makes a U-turn", "doubles back")
            return self.pick(f"takes one {turns[0]} turn", f"turns {turns[0]} on the way", f"takes a {turns[0]} turn")
        spoken = [turn if turn != "around" else "around" for turn in turns]
        return self.pick(
            "turns " + ", then ".join(spoken),
            "first turns " + " and next ".join(spoken[:2]) + "".join(f", after that {turn}" for turn in spoken[2:]),
            f"makes {self.number(len(turns))} turns: " + ", ".join(spoken),
        )

    def stops(self, flight):
        s = self.number(flight.standing)
        if flight.stops == 0:
            return self.pick("They never halt.", "They do not pause anywhere.", "They keep going without a break.", "It is a walk without stops.")
        if flight.stops == 1:
            return self.pick(f"They halt a single time, for {s} seconds.", f"There is one stop of {s} seconds.", f"They pause once and wait {s} seconds.")
        n = self.number(flight.stops)
        return self.pick(f"They come to a halt {n} times, {s} seconds altogether.", f"They pause on {n} occasions, for {s} seconds in total.", f"There are {n} stops of {s} seconds in all.")

    def description(self, flight):
        person = self.person(flight)
        person = person[0].upper() + person[1:]
        dur = self.number(flight.duration)
        if flight.walks:
            way = self.number(flight.way)
            length = self.pick(
                f"The route runs to {way} m and takes {dur} seconds at {flight.speed} m/s.",
                f"They cover {way} metres at {flight.speed} metres per second; the flight lasts {dur} seconds.",
                f"It is a {way}-metre walk, done in {dur} seconds at a pace of {flight.speed} m/s.",
                f"In {dur} seconds they travel {way} m, at {flight.speed} m/s on average.",
            )
            walk = f"{person} {self.turns(flight)}. {self.stops(flight)} {length}"
        else:
            walk = f"{person} {self.pick('stands still', 'stays motionless', 'remains stationary')} for {dur} seconds."
        drone = f"The drone flies {self.number(flight.altitude)} m {self.pick('above the target', 'higher than the walker')}. " if flight.altitude >= 1 else ""
        rest = f"The pilot must {self.distance(flight)} and {self.pitch(flight)}."
        return self.pick(f"{walk} {drone}{rest}", f"{rest} {drone}{walk}")

    def foreign(self, text):
        if self.rng.random() < 0.3:
            for noun in ("walker", "pedestrian", "person", "subject"):
                if noun in text:
                    return text.replace(noun, self.rng.choice(self.persons), 1)
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", heading {direction}.", f", {direction}bound.", f", towards the {direction}.")


class Chinese:
    code = "zh"
    things = ["旁边有一辆汽车", "经过第二栋楼", "在公交站附近", "走在树下", "与两位朋友同行", "沿着河边", "当时下着雨", "前面有人骑自行车", "穿过斑马线", "牵着一只狗", "在人群中", "在喷泉边", "头戴帽子", "撑着雨伞"]
    persons = ["女子", "司机", "小孩", "老人", "男子"]

    def __init__(self, rng):
        self.rng = rng

    def pick(self, *choices):
        return self.rng.choice(choices)

    def number(self, value):
        return in_chinese(value) if 0 < value < 1000 and self.rng.random() < 0.2 else str(value)

    def person(self, flight):
        noun = self.pick("行人", "步行者", "目标", "那个人", "路人")
        if not flight.wear:
            return noun
        top, trousers = ZH_COLOURS[flight.wear[0]], ZH_COLOURS[flight.wear[1]]
        bag = flight.wear[2]
        extra = self.pick("，背着双肩包", "、背着背包", "、身背背包") if bag else self.pick("", "", "", "、没有背包")
        return self.pick(
            f"身着{top}色外套和{trousers}色长裤{extra}的{noun}",
            f"上身穿{top}色、下身穿{trousers}色{extra}的{noun}",
            f"穿着{trousers}色裤子、{top}色夹克{extra}的{noun}",
            f"{top}色上衣配{trousers}色裤子{extra}的{noun}",
            f"一身{top}衣{trousers}裤{extra}的{noun}",
        )

    def distance(self, flight):
        d = self.number(flight.distance)
        return self.pick(f"始终离目标{d}米左右", f"拉开{d}米的间距", f"与目标相隔{d}米", f"跟在{d}米之外", f"间隔控制在{d}米", f"不要近于也不要远于{d}米", f"在{d}米开外盯住目标")

    def pitch(self, flight):
        p = self.number(abs(flight.pitch))
        if flight.pitch >= 0:
            return self.pick(f"镜头下压{p}度", f"相机朝下{p}度", f"以{p}度俯角拍摄", f"镜头向下倾斜{p}度", f"俯拍{p}度")
        return self.pick(f"镜头上扬{p}度", f"相机朝上{p}度", f"以{p}度仰角拍摄", f"镜头向上倾斜{p}度")

    def instruction(self, flight):
        who, distance, pitch = self.person(flight), self.distance(flight), self.pitch(flight)
        state = "" if flight.walks else self.pick("目标一直站着。", "目标原地不动。")
        verb = self.pick("请盯紧", "追随", "拍摄", "全程跟住", "尾随")
        return self.pick(f"{verb}{who}，{distance}，{pitch}。{state}", f"{distance}，{pitch}，{verb}{who}。{state}", f"{verb}{who}。{pitch}，{distance}。{state}")

    def turns(self, flight):
        name = {"left": "左拐", "right": "右拐", "around": "掉头"} if self.rng.random() < 0.5 else {"left": "左转", "right": "右转", "around": "折返"}
        turns = [name[kind] for kind in flight.turns]
        if not turns:
            return self.pick("一路没有拐弯", "途中不转弯", "没有转过弯")
        if len(turns) == 1:
            return self.pick(f"途中{turns[0]}一次", f"先走一段再{turns[0]}", f"中途{turns[0]}")
        return self.pick("先" + "，再".join(turns), f"共转弯{self.number(len(turns))}次，依次" + "、".join(turns), "，然后".join(turns))

    def stops(self, flight):
        s = self.number(flight.standing)
        if flight.stops == 0:
            return self.pick("中途没有停下", "一路未停", "始终没有驻足", "从头到尾不曾停留")
        if flight.stops == 1:
            return self.pick(f"中途驻足一次，共{s}秒".replace("共", "约"), f"半路停了一次，停了{s}秒", f"停下一回，约{s}秒")
        n = self.number(flight.stops)
        return self.pick(f"中途停了{n}次，合计{s}秒", f"一共停下{n}回，累计{s}秒", f"停留{n}次，加起来{s}秒")

    def description(self, flight):
        person, dur = self.person(flight), self.number(flight.duration)
        if flight.walks:
            way = self.number(flight.way)
            length = self.pick(
                f"总长{way}米，耗时{dur}秒，平均每秒{flight.speed}米。",
                f"一共走了{way}米，花了{dur}秒，速度{flight.speed}米每秒。",
                f"路线长约{way}米，{dur}秒走完，步速{flight.speed}米/秒。",
                f"{dur}秒内走过{way}米，时速折合每秒{flight.speed}米。",
            )
            walk = f"{person}{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"{person}{self.pick('站着没动', '静止不动', '一直站在原地')}，持续{dur}秒。"
        drone = f"无人机飞在{self.pick('目标上空', '目标头顶')}{self.number(flight.altitude)}米。" if flight.altitude >= 1 else ""
        rest = f"飞手{self.distance(flight)}，{self.pitch(flight)}。"
        return self.pick(f"{walk}{drone}{rest}", f"{rest}{drone}{walk}")

    def foreign(self, text):
        if self.rng.random() < 0.3:
            for noun in ("行人", "步行者", "路人", "那个人"):
                if noun in text:
                    return text.replace(noun, self.rng.choice(self.persons), 1)
        return text.rstrip("。") + "，" + self.rng.choice(self.things) + "。"

    def heading(self, text, direction):
        name = dict(east="东", west="西", north="北", south="南", northeast="东北", northwest="西北", southeast="东南", southwest="西南")[direction]
        return text.rstrip("。") + self.pick(f"，朝{name}走去。", f"，一直向{name}。", f"，往{name}面去。")


def changed(flight, slot, rng):
    """Facts with one changed slot; None where the slot cannot be changed in these facts."""
    other = copy.deepcopy(flight)
    move = lambda value, least: value + rng.choice([-1, 1]) * (least + rng.randrange(6)) if value > least + 6 else value + least + rng.randrange(6)
    if slot == "distance":
        other.distance = move(flight.distance, 2)
    elif slot == "pitch":
        other.pitch = -flight.pitch if rng.random() < 0.3 and abs(flight.pitch) > 2 else flight.pitch + rng.choice([3, 5, 9])
    elif slot == "altitude" and flight.altitude >= 3:
        other.altitude = move(flight.altitude, 2)
    elif slot == "way" and flight.walks:
        other.way = flight.way + rng.choice([1, 2, 3]) * (20 if flight.way > 30 else 4)
    elif slot == "duration":
        other.duration = flight.duration + rng.choice([-1, 1, 2]) * (10 if flight.duration >= 30 else 3)
    elif slot == "speed" and flight.walks:
        other.speed = round(flight.speed + rng.choice([0.3, 0.5, 0.9]), 1)
    elif slot == "turn side" and flight.turns:
        at = rng.randrange(len(flight.turns))
        other.turns[at] = rng.choice([kind for kind in ("left", "right", "around") if kind != flight.turns[at]])
    elif slot == "turn order" and len(set(flight.turns)) > 1:
        at = next(i for i in range(len(flight.turns) - 1) if flight.turns[i] != flight.turns[i + 1])
        other.turns[at], other.turns[at + 1] = other.turns[at + 1], other.turns[at]
    elif slot == "turn count" and flight.walks:
        other.turns = flight.turns[:-1] if flight.turns and rng.random() < 0.5 else flight.turns + [rng.choice(["left", "right"])]
    elif slot == "stop count" and flight.walks:
        other.stops = flight.stops + 1
        other.standing = flight.standing or 4
    elif slot == "no stops" and flight.stops:
        other.stops = other.standing = 0
    elif slot == "stop time" and flight.stops:
        other.standing = flight.standing + rng.choice([2, 4, 7])
    elif slot == "top" and flight.wear:
        other.wear[0] = rng.choice([it for it in COLOURS if it != flight.wear[0]])
    elif slot == "trousers" and flight.wear:
        other.wear[1] = rng.choice([it for it in COLOURS if it != flight.wear[1]])
    elif slot == "backpack" and flight.wear and not flight.wear[2]:
        other.wear[2] = True
    elif slot == "standing" and flight.walks:
        other.walks = False
    elif slot == "walking" and not flight.walks:
        other.walks = True
        other.way, other.speed, other.turns, other.stops = 60, 1.2, [], 0
    else:
        return None
    return other


SLOTS = ["distance", "pitch", "top", "trousers", "backpack", "standing", "walking", "thing", "direction", "altitude", "way", "duration", "speed", "turn side", "turn order", "turn count", "stop count", "no stops", "stop time"]
BOTH = {"distance", "pitch", "top", "trousers", "backpack", "standing", "thing", "direction"}


def true_text(grammar, flight):
    return grammar.instruction(flight) if grammar.rng.random() < 0.4 else grammar.description(flight)


def planted_text(grammar, flight, slot, both=BOTH):
    rng = grammar.rng
    write = true_text if slot in both else (lambda g, f: g.description(f))
    if slot == "thing":
        return grammar.foreign(write(grammar, flight))
    if slot == "direction":
        names = ["north", "east", "south", "west", "northeast", "northwest", "southeast", "southwest"]
        return grammar.heading(write(grammar, flight), rng.choice([it for it in names if it not in flight.directions]))
    other = changed(flight, slot, rng)
    return other and write(grammar, other)


def doctor(cosfly, dataset, lines):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "texts.jsonl")
        path.write_text("".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines), encoding="utf-8")
        done = subprocess.run([cosfly, "doctor", dataset, "--texts", path, "--json", "-"], capture_output=True, text=True, encoding="utf-8")
        if done.returncode not in (0, 1):
            sys.exit(f"cosfly doctor failed: {done.stderr}")
        return json.loads(done.stdout)


def judged(program, dataset, facts, lines):
    """Each line with the contradictions that the judge finds."""
    if dataset != "made-up":
        return doctor(program, dataset, lines)["judged"]["verdicts"]
    asked = [{"facts": facts[it["trajectory_id"]], "language": it["language"], "text": it["text"]} for it in lines]
    text = "".join(json.dumps(it, ensure_ascii=False) + "\n" for it in asked)
    done = subprocess.run([program], input=text, capture_output=True, text=True, encoding="utf-8", check=True)
    return [{**it, "contradictions": json.loads(found)} for it, found in zip(lines, done.stdout.splitlines(), strict=True)]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("cosfly")
    arguments.add_argument("dataset")
    arguments.add_argument("--texts", type=int, default=1000)
    arguments.add_argument("--show", type=int, default=10)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--grammar", type=int, default=1, help="1: the one of this file; others: held-out paraphrases")
    given = arguments.parse_args()
    if given.dataset == "made-up":
        facts = flights_of_no_drone(120, given.seed)
    else:
        facts = doctor(given.cosfly, given.dataset, [])["judged"]["facts"]
        # Where some bend may or may not be a turn, a text may say either. The grammars call every way without a turn straight; one that
        # bends slowly is neither.
        is_told = lambda it: not it["doubtful_turns"] and (it["turns"] or not it["bends"])
        facts = {name: it for name, it in facts.items() if is_told(it)}
    flights = {name: Flight(it) for name, it in sorted(facts.items())}
    assert flights, "the dataset has no flight with facts"
    names, ok = list(flights), True
    both = BOTH - {"standing"} if given.grammar in LEAVE_STANDING_OUT else BOTH
    for kind in {1: (English, Chinese), **GRAMMARS}[given.grammar]:
        rng = random.Random(f"{given.seed} {kind.code}")
        grammar = kind(rng)
        line = lambda name, text: {"trajectory_id": name, "language": kind.code, "text": text}
        lines, slot_of = [], {}
        while len(lines) < given.texts:
            name = rng.choice(names)
            lines.append(line(name, true_text(grammar, flights[name])))
        true_keys = {(it["trajectory_id"], it["text"]) for it in lines}
        while len(slot_of) < given.texts:
            name, slot = rng.choice(names), SLOTS[len(slot_of) % len(SLOTS)]
            for name in [name] + rng.sample(names, len(names)):
                text = planted_text(grammar, flights[name], slot, both)
                if text:
                    break
            if text is None:
                SLOTS.remove(slot)
                print(f"no flight for `{slot}`")
                continue
            if (name, text) in true_keys or (name, text) in slot_of:
                continue
            slot_of[name, text] = slot
        lines += [line(name, text) for name, text in slot_of]
        verdicts = judged(given.cosfly, given.dataset, facts, lines)
        refused = [it for it in verdicts if (it["trajectory_id"], it["text"]) in true_keys and it["contradictions"]]
        missed = [it for it in verdicts if (it["trajectory_id"], it["text"]) in slot_of and not it["contradictions"]]
        caught = 1 - len(missed) / len(slot_of)
        share = len(refused) / given.texts
        print(f"{kind.code}: {len(flights)} flights; {100 * caught:.1f} % of {len(slot_of)} planted errors caught, {100 * share:.1f} % of {given.texts} true texts refused")
        for it in refused[: given.show]:
            print("  refused:", it["text"], "|", "; ".join(it["contradictions"]))
        for it in missed[: given.show]:
            print("  missed:", slot_of[it["trajectory_id"], it["text"]], "|", it["text"])
        ok &= caught >= 0.99 and share <= 0.02
    sys.exit(0 if ok else 1)


if __name__ == "__main__":
    main()
