"""Reads the phrases of table `phrases` and finds, frame by frame, all visible bodies that they may mean.

Usage: `check_phrases.py DATASET_FOLDER [DATASET_FOLDER ...]`. Shares no code with cosfly. Every phrase is read from its own words, in English and in
Chinese; both must name the same. In the frame in which it is given, a phrase must fit the target and no other body of tables `bodies` and `frames`;
in all frames the number of bodies that it may fit must be the stated one. Prints how often each property is named."""

import re
import sys
from collections import Counter

from shared import IN_CHINESE, end_with, flown, rows

KINDS = {
    "pedestrian": ("person", "人"), "bicycle": ("cyclist", "骑车人"), "motorcycle": ("motorcyclist", "摩托车手"),
    "car": ("car", "汽车"), "van": ("van", "面包车"), "truck": ("lorry", "卡车"), "bus": ("bus", "公交车"), "drone": ("drone", "无人机"),
    "child": ("child", "孩子"), "elder": ("old person", "老人"), "wheelchair": ("wheelchair user", "轮椅使用者"), "sitter": ("seated person", "就座者"),
    "push_chair": ("person with a push-chair", "推婴儿车者"), "dog_walker": ("dog walker", "遛狗者"), "runner": ("runner", "跑步者"), "e_scooter": ("e-scooter rider", "骑滑板车的人"),
}
PEOPLE = ("pedestrian", "child", "elder", "wheelchair", "sitter", "push_chair", "dog_walker", "runner")
ENGLISH = re.compile(
    r"the (?:(?P<motion>walking|moving|standing|stationary) )?(?:(?P<paint>[a-z]+) )??(?P<kind>" + "|".join(word for word, _ in KINDS.values()) + ")"
    r"(?: in an? (?P<top>[a-z]+) top)?(?:(?: and| in) (?P<trousers>[a-z]+) trousers)?(?P<backpack> with a backpack)?(?P<shoulder_bag> with a shoulder bag)?"
    r"(?: (?:on|in) the (?P<part>left|right|middle) of the picture)?"
)


def english(text):
    found = ENGLISH.fullmatch(text)
    if not found:
        return None
    kind = next(kind for kind, (word, _) in KINDS.items() if word == found["kind"])
    moves = {"walking": True, "moving": True, "standing": False, "stationary": False}.get(found["motion"])
    return {"kind": kind, "motion": moves, "top": found["top"] or found["paint"], "trousers": found["trousers"],
            "backpack": bool(found["backpack"]) or None, "shoulder_bag": bool(found["shoulder_bag"]) or None, "part": found["part"]}


def chinese(text):
    kind = max((kind for kind in KINDS if text.endswith(KINDS[kind][1])), key=lambda kind: len(KINDS[kind][1]))
    colour = {zh: en for en, zh in IN_CHINESE.items()}
    any_colour = "|".join(colour)
    found = {name: re.search(pattern, text) for name, pattern in {
        "top": f"穿({any_colour})上衣" if kind in (*PEOPLE, "bicycle", "motorcycle", "e_scooter") else f"({any_colour})", "trousers": f"({any_colour})裤子",
        "part": "画面(左侧|右侧|中间)", "motion": "(正在行走|正在行驶|站着不动|停着不动)", "backpack": "背着背包", "shoulder_bag": "挎着单肩包"}.items()}
    word = lambda name: found[name] and found[name].group(1)
    return {"kind": kind, "motion": {"正在行走": True, "正在行驶": True, "站着不动": False, "停着不动": False}.get(word("motion")),
            "top": colour.get(word("top")), "trousers": colour.get(word("trousers")), "backpack": bool(found["backpack"]) or None, "shoulder_bag": bool(found["shoulder_bag"]) or None,
            "part": {"左侧": "left", "右侧": "right", "中间": "middle"}.get(word("part"))}


def may_fit(meant, body):
    """Whether a body may be meant; where it moves slowly, or near a border of the picture's parts, nobody could deny it."""
    speed, at = body["speed"], body["at"]
    moves = True if speed >= 0.4 else False if speed <= 0.05 else None
    part = "left" if at < 0.3 else "right" if at > 0.7 else "middle" if 0.4 <= at <= 0.6 else None
    agrees = [meant[name] is None or meant[name] == body[name] for name in ("top", "trousers", "backpack", "shoulder_bag")]
    agrees.append(meant["motion"] is None or moves is None or moves == meant["motion"])
    agrees.append(meant["part"] is None or part is None or part == meant["part"])
    is_called_so = body["kind"] == meant["kind"] or meant["kind"] == "pedestrian" and body["kind"] in PEOPLE
    return is_called_so and all(agrees)


def described(body, of, speed, at):
    """What a phrase may say of a body or, with the prefix `target_`, of a target."""
    looks = {name: body[of + column] for name, column in (("kind", "kind"), ("top", "top_colour"), ("trousers", "trousers_colour"), ("backpack", "has_backpack"))}
    return {**looks, "shoulder_bag": body[of + "bag"] == "shoulder_bag", "speed": speed, "at": at}


def check(folder):
    flights, frames, others = flown(folder)
    wrong, named, unique = [], Counter(), Counter()
    phrases = rows(folder, "phrases")
    for row in phrases:
        flight = flights[row["trajectory_id"]]
        meant = english(row["text_en"])
        if meant is None or meant != chinese(row["text_zh"]):
            wrong.append(f"{row['trajectory_id']} frame {row['frame']}: `{row['text_en']}` and `{row['text_zh']}` do not mean the same")
            continue
        said = sorted(name for name, value in meant.items() if value is not None and name != "kind")
        if said != sorted(row["properties"]):
            wrong.append(f"{row['trajectory_id']} frame {row['frame']}: `properties` are {row['properties']}; the words name {said}")
        named.update(said)
        middle = lambda edges: (edges[0] + edges[2]) / 2 / flight["camera_width_px"]
        for frame, state in frames[row["trajectory_id"]].items():
            fits = sum(may_fit(meant, described(it, "", it["speed_mps"], middle(it["visible_box_px"]))) for it in others[row["trajectory_id"], frame])
            target = None
            if state["visible_box_px"] is not None:
                target = described(flight, "target_", state["target_speed_mps"], middle(state["visible_box_px"]))
            is_target = target is not None and may_fit(meant, target)
            if (row["candidates"][frame], row["fits_target"][frame]) != (fits + is_target, int(is_target)):
                wrong.append(f"{row['trajectory_id']} frame {frame}: `{row['text_en']}` may mean {fits + is_target} bodies; the table says {row['candidates'][frame]}")
            if frame == row["frame"] and (fits, is_target) != (0, True):
                wrong.append(f"{row['trajectory_id']} frame {frame}: `{row['text_en']}` is given there and means {fits} others")
            unique[bool(is_target and fits == 0)] += 1
    print(f"{folder}: {len(phrases)} phrases in {len(flights)} flights, {len(wrong)} wrong; named: {dict(named)};",
          f"unique in {unique[True]} of {sum(unique.values())} frames")
    return wrong


if __name__ == "__main__":
    end_with([problem for folder in sys.argv[1:] for problem in check(folder)])
