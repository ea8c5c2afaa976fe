"""Probes for shortcuts, computed from the tables of a dataset: do place, size and looks tell the target from other people?

Usage: `check_shortcuts.py DATASET_FOLDER [--doctor VERDICT.json] [--pictures N]`. Shares no code with cosfly. An AUC is the probability that a target
has more of a sign than somebody else; errors are over flights. With the JSON file of `cosfly doctor`, its section `shortcuts` must agree. Prints also
the place in random crops: a window whose place around the target is drawn evenly, as large as a share of the picture. `--pictures` reads colour
pictures of so many flights and compares the pixels in the boxes of targets and others: all, those as far away, and those of them who are seen from
the same side, with a backpack or without as the target, and those of them who fill as much of their boxes."""

import json
from collections import defaultdict
from pathlib import Path

import numpy as np
from shared import axes_of, command_line, end_with, flown, messages, picture, place, turned

NEAR, WHOLE, SIDE_DEG, FULL = 0.1, 0.1, 30, 0.08
BRIGHTNESS = [0.2126, 0.7152, 0.0722]
CROPS = (0.5, 0.33, 0.25)


def above(a, b):
    return float(a > b) + 0.5 * float(a == b)


def auc(positives, negatives):
    return float(np.mean([[above(a, b) for b in negatives] for a in positives])) if positives and negatives else None


def probe(by_flight):
    """Mean over frames and its error over flights, from lists of shares by flight."""
    sums = np.array([sum(it) for it in by_flight.values()])
    counts = np.array([len(it) for it in by_flight.values()])
    if not len(counts):
        return None
    mean, number = sums.sum() / counts.sum(), len(counts)
    error = np.sqrt(((sums - mean * counts) ** 2).sum() * number / (number - 1)) / counts.sum() if number > 1 else None
    return {"auc": mean, "standard_error": error, "flights": number, "frames": int(counts.sum())}


def body(flight, frame, feet, height_m, seen, heading_deg, looks, of):
    """Box, distance from the middle, distance from the camera, the height in metres that the picture shows (none if partly hidden), the side that
    is seen (0 degrees from behind), the share of the box that is filled, and what the tables say of the looks."""
    axes, away = axes_of(frame), np.array(feet) - place(frame, "drone")
    box, pixels, top, backpack = seen["visible_box_px"], seen["visible_pixels"], looks[f"{of}top_linear_rgb"], looks[f"{of}has_backpack"]

    def row(it):
        ahead, _, up = it @ axes
        return flight["camera_cy_px"] - flight["camera_focal_px"] * up / ahead if ahead > 1e-6 else np.nan

    low, high, metres = row(away), row(away + [0, 0, height_m]), None
    if low > high:
        most = WHOLE * (low - high)
        metres = height_m * (box[3] - box[1]) / (low - high) if box[1] <= high + most and box[3] >= low - most else None
    middle = np.array([box[0] + box[2] - flight["camera_width_px"], box[1] + box[3] - flight["camera_height_px"]]) / 2
    return {"box": box, "at": middle, "off": float(np.hypot(*middle)), "far": float(np.linalg.norm(away)), "px": box[3] - box[1], "m": metres,
            "full": pixels / max((box[2] - box[0]) * (box[3] - box[1]), 1),
            "side": heading_deg - np.degrees(np.arctan2(away[1], away[0])), "top": float(np.dot(top, BRIGHTNESS)) if top else None, "backpack": backpack}


def shown(folder):
    """Flights, and target and others of its kind in all expert frames in which the target is seen."""
    flights, of_flights, people = flown(folder)
    frames = []
    for name, it in ((name, it) for name, found in of_flights.items() for it in found.values()):
        flight = flights[name]
        if flight["expert_id"] or it["visible_box_px"] is None:
            continue
        target = body(flight, it, place(it, "target"), flight["target_height_m"], it, it["target_heading_deg"], flight, "target_")
        others = [body(flight, it, other["feet_in_world_m"], other["size_m"][2], other, other["heading_deg"], other, "")
                  for other in people[name, it["frame"]] if other["kind"] == flight["target_kind"]]
        frames.append((name, it["frame"], target, others))
    return flights, people, frames


def in_pictures(flights, frames):
    """Place and height against all others in the frame, height against those in the same place."""
    place, height, same = defaultdict(list), defaultdict(list), defaultdict(list)
    for name, _, target, others in frames:
        if others:
            place[name].append(np.mean([above(it["off"], target["off"]) for it in others]))
            height[name].append(np.mean([above(target["px"], it["px"]) for it in others]))
        alike = [it for it in others if abs(np.log(it["far"] / target["far"])) <= np.log(1 + NEAR)
                 and abs(it["off"] - target["off"]) <= NEAR * flights[name]["camera_height_px"] and it["m"] is not None]
        if alike and target["m"] is not None and flights[name]["target_kind"] == "pedestrian":
            same[name].append(np.mean([above(target["m"], it["m"]) for it in alike]))
    return {"place": probe(place), "height": probe(height), "height_in_the_same_place": probe(same)}


def of_looks(flights, people):
    """Looks of followed people against those of bystanders on foot."""
    words = {"slim": 0, "short": 0, "medium": 1, "stout": 2, "long": 2}
    signs = {
        "colourfulness": lambda it: max(it[0]) - min(it[0]), "brightness": lambda it: np.dot(it[0], BRIGHTNESS), "height": lambda it: it[1],
        "bag": lambda it: it[2] != "none", "build": lambda it: words[it[3]], "steps": lambda it: words[it[4]],
    }
    targets = {(it["town"], it["pedestrian_id"]): [it[f"target_{key}"] for key in ("top_linear_rgb", "height_m", "bag", "build", "gait")]
               for it in flights.values() if it["target_kind"] == "pedestrian"}
    others = {(flights[name]["town"], it["body_id"]): [it["top_linear_rgb"], it["size_m"][2], *(it[key] for key in ("bag", "build", "gait"))]
              for (name, _), there in people.items() for it in there if it["kind"] == "pedestrian"}
    if not targets or not others:
        return {"targets": len(targets), "others": len(others), "looks": None}
    looks = {name: auc([sign(it) for it in targets.values()], [sign(it) for it in others.values()]) for name, sign in signs.items()}
    looks["standard_error"] = np.sqrt((len(targets) + len(others) + 1) / (12 * len(targets) * len(others)))
    return {"targets": len(targets), "others": len(others), "looks": looks}


def in_crops(flights, frames, share):
    """Nearness to the middle of a window whose place around the target is drawn evenly; windows that leave the picture are left out."""
    random, shares, kept = np.random.default_rng(1), defaultdict(list), 0
    for name, _, target, others in frames:
        picture = np.array([flights[name]["camera_width_px"], flights[name]["camera_height_px"]])
        middle = target["at"] + (random.uniform(size=2) - 0.5) * share * picture
        if (np.abs(middle) > (1 - share) * picture / 2).any():
            continue
        kept += 1
        off = [np.hypot(*(it["at"] - middle)) for it in others if (np.abs(it["at"] - middle) <= share * picture / 2).all()]
        if off:
            shares[name].append(np.mean([above(it, np.hypot(*(target["at"] - middle))) for it in off]))
    return probe(shares), kept / max(len(frames), 1)


def of_box(picture, box):
    """Brightness and colourfulness of the middle half of a box."""
    left, top, right, bottom = box
    x, y = (right - left) / 4, (bottom - top) / 4
    part = picture[int(top + y):max(int(bottom - y), int(top + y) + 1), int(left + x):max(int(right - x), int(left + x) + 1)]
    colour = part.reshape(-1, 3).mean(0)
    return {"brightness": float(colour @ BRIGHTNESS), "colourfulness": float(colour.max() - colour.min())}


def with_pixels(folder, flights, frames, number):
    """Name, target and others of the frames of so many flights, with their pixels."""
    listed = {(name, frame): (target, others) for name, frame, target, others in frames}
    for name in sorted({name for name, *_ in frames})[:number]:
        for frame, (_, message, *_) in enumerate(messages(folder / flights[name]["mcap_path"], ["/camera/rgb/image"])):
            if (name, frame) in listed:
                colours = np.asarray(picture(message).convert("RGB"), dtype=float)
                target, others = listed[name, frame]
                yield name, {**target, **of_box(colours, target["box"])}, [{**it, **of_box(colours, it["box"])} for it in others]


def of_pixels(folder, flights, frames, number):
    """Brightness and colourfulness of pixels, and brightness less what the colour of the top tells of it (a line through all bystanders)."""
    found = defaultdict(lambda: defaultdict(list))
    seen_by_frame = [it for it in with_pixels(folder, flights, frames, number) if flights[it[0]]["target_kind"] == "pedestrian"]
    everybody = [it for _, _, others in seen_by_frame for it in others]
    if not everybody:
        return {}
    slope = np.polyfit(np.log([it["top"] for it in everybody]), [it["brightness"] for it in everybody], 1)[0]
    signs = {"brightness": lambda it: it["brightness"], "colourfulness": lambda it: it["colourfulness"],
             "brightness less the top's": lambda it: it["brightness"] - slope * np.log(it["top"])}
    for name, target, others in seen_by_frame:
        far = [it for it in others if abs(np.log(it["far"] / target["far"])) <= np.log(1 + NEAR) and None not in (it["m"], target["m"])]
        side = [it for it in far if abs(turned(it["side"], target["side"])) <= SIDE_DEG and it["backpack"] == target["backpack"]]
        full = [it for it in side if abs(it["full"] - target["full"]) <= FULL]
        for sign, value in signs.items():
            for whom, compared in (("all", others), ("as far away", far), ("same side and backpack, too", side), ("as full a box, too", full)):
                if compared:
                    found[f"{sign} of pixels, {whom}"][name].append(np.mean([above(value(target), value(it)) for it in compared]))
    return {what: probe(it) for what, it in found.items()}


def say(name, it):
    error = "" if it is None or it["standard_error"] is None else f" +- {it['standard_error']:.3f}"
    print(f"{name}: " + ("nobody to compare with" if it is None else f"{it['auc']:.3f}{error} ({it['flights']} flights, {it['frames']} frames)"))


def differences(own, doctor, path="shortcuts"):
    """Numbers of the doctor that are not these."""
    if isinstance(own, dict) and isinstance(doctor, dict):
        return [it for key, value in own.items() for it in differences(value, doctor.get(key), f"{path}.{key}")]
    agree = own == doctor if own is None or doctor is None else abs(own - doctor) <= 2e-3
    return [] if agree else [f"{path}: {own} here, {doctor} by the doctor"]


arguments = command_line("folder", doctor=Path, pictures=0)
flights, people, frames = shown(arguments.folder)
own = {"frames": len(frames), **in_pictures(flights, frames), **of_looks(flights, people)}
for name in ("place", "height", "height_in_the_same_place"):
    say(name, own[name])
print(f"looks of {own['targets']} targets and {own['others']} bystanders: "
      + ", ".join(f"{name} {value:.3f}" for name, value in (own["looks"] or {}).items()))
for share in CROPS:
    found, kept = in_crops(flights, frames, share)
    say(f"place in random crops of {share:.2f} of the picture ({100 * kept:.0f} % of the frames)", found)
for name, found in of_pixels(arguments.folder, flights, frames, arguments.pictures).items() if arguments.pictures else ():
    say(name, found)
if arguments.doctor:
    end_with(differences(own, json.loads(arguments.doctor.read_text())["shortcuts"]))
