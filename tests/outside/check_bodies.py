"""Judges the moving world of a dataset from its tables: bodies, flights among them and among what stands, losses, look-alikes.

Usage: `check_bodies.py DATASET_FOLDER`. Shares no code with cosfly. No two bodies may overlap; no flight may come nearer to a body, or to a box of
the town, than its certificate says, at 20 moments between frames; table `target_losses` must be what `frames` shows; `look_alikes` must be the number of visible people
in the target's clothes. Prints the smallest distances."""

import sys
from collections import defaultdict
from itertools import groupby
from pathlib import Path

import numpy as np
from shared import Town, end_with, flown, place, rows, turned

BETWEEN, FAR_M = 20, 40
# People are circles from above, all others boxes.
ROUND = {"pedestrian", "runner", "child", "elder", "push_chair", "dog_walker", "wheelchair", "sitter"}


def axes(yaw):
    return np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])


def gap(a, b):
    """Distance between two bodies seen from above, metres; negative where they overlap (for two boxes, the largest gap along an axis)."""
    between = np.array(b["feet_in_world_m"][:2]) - a["feet_in_world_m"][:2]
    round_ones = [it["kind"] in ROUND for it in (a, b)]
    if all(round_ones):
        return np.hypot(*between) - (a["size_m"][0] + b["size_m"][0]) / 2
    if any(round_ones):
        box, person, away = (b, a, -between) if round_ones[0] else (a, b, between)
        excess = np.abs(axes(np.radians(box["heading_deg"])) @ away) - np.array(box["size_m"][:2]) / 2
        return np.hypot(*np.maximum(excess, 0)) + min(excess.max(), 0) - person["size_m"][0] / 2
    directions = [axes(np.radians(it["heading_deg"])) for it in (a, b)]
    reach = lambda body, own, axis: sum(abs(axis @ own[k]) * body["size_m"][k] / 2 for k in range(2))
    return max(abs(axis @ between) - reach(a, directions[0], axis) - reach(b, directions[1], axis) for axis in np.concatenate(directions))


def to_box(point, feet, yaw, size):
    """Distance from a point to an upright box, metres."""
    away = point - feet
    x, y = axes(yaw) @ away[:2]
    excess = np.abs([x, y, away[2] - size[2] / 2]) - np.array(size) / 2
    return np.linalg.norm(np.maximum(excess, 0)) + min(excess.max(), 0)


def to_town(way, town):
    """Distance of a way, places in turn, from what stands in a town, metres; at most FAR_M."""
    near = np.flatnonzero(np.hypot(*(town.center[:, :2] - way[0, :2]).T) - town.reach < FAR_M)
    excess = np.abs(town.own(near, way[:, None] - town.center[near])) - town.half[near]
    return (np.linalg.norm(np.maximum(excess, 0), axis=-1) + np.minimum(excess.max(-1), 0)).min(initial=FAR_M)


def main(folder):
    wrong, towns = [], Town.all_of(folder)
    for row in rows(folder, "rejected", ["trajectory_id", "reason"]) if (folder / "data/rejected").is_dir() else []:
        if "occlusion" in row["reason"]:
            wrong.append(f"{row['trajectory_id']} was rejected for its parameters: {row['reason']}")
    flights, frames, _ = flown(folder, ["drone_x_m", "drone_y_m", "drone_z_m", "visible_pixels", "in_view", "look_alikes"], ["kind"])
    bodies = defaultdict(lambda: defaultdict(dict))
    for row in rows(folder, "bodies", ["trajectory_id", "frame", "body_id", "kind", "feet_in_world_m", "heading_deg", "size_m"]):
        bodies[row["trajectory_id"]][row["frame"]][row["body_id"]] = row
    nearest_two = nearest_flight = nearest_town = np.inf
    for name, by_frame in bodies.items():
        least = flights[name]["min_clearance_m"]
        for frame, present in by_frame.items():
            # Other drones fly above whoever walks and drives.
            listed = [it for it in present.values() if it["kind"] != "drone"]
            places = np.array([it["feet_in_world_m"][:2] for it in listed])
            reach = np.array([np.hypot(*it["size_m"][:2]) / 2 for it in listed])
            for i in range(len(listed)):
                near = np.flatnonzero(np.hypot(*(places[i + 1:] - places[i]).T) < reach[i + 1:] + reach[i] + 0.5) + i + 1
                for j in near:
                    apart = gap(listed[i], listed[j])
                    nearest_two = min(nearest_two, apart)
                    if apart < -1e-6:
                        wrong.append(f"{name} frame {frame}: bodies {listed[i]['body_id']} and {listed[j]['body_id']} overlap by {-apart:.3f} m")
            here, there = frames[name][frame], frames[name].get(frame + 1)
            start, end = (place(row, "drone") for row in (here, there or here))
            way = start + np.arange(BETWEEN)[:, None] / BETWEEN * (end - start)
            apart = to_town(way, towns[flights[name]["town"]])
            nearest_town = min(nearest_town, apart)
            if apart < least - 0.01:
                wrong.append(f"{name} frame {frame}: the drone is {apart:.2f} m from the town; the certificate says {least:.2f} m")
            for share in np.arange(BETWEEN) / BETWEEN if there else [0.0]:
                drone = start + share * (end - start)
                for body in present.values():
                    later = by_frame.get(frame + 1, {}).get(body["body_id"], body)
                    feet = np.array(body["feet_in_world_m"]) + share * (np.array(later["feet_in_world_m"]) - body["feet_in_world_m"])
                    if np.abs(drone - feet).max() > FAR_M:
                        continue
                    turn = turned(later["heading_deg"], body["heading_deg"])
                    apart = to_box(drone, feet, np.radians(body["heading_deg"] + share * turn), body["size_m"])
                    nearest_flight = min(nearest_flight, apart)
                    if apart < least - 0.01:
                        wrong.append(f"{name} frame {frame}: the drone is {apart:.2f} m from body {body['body_id']}; the certificate says {least:.2f} m")
    alike, looks = defaultdict(int), ["kind", "top_colour", "trousers_colour", "has_backpack"]
    for row in rows(folder, "bodies", ["trajectory_id", "frame", "visible_pixels", *looks]):
        own = [flights[row["trajectory_id"]][f"target_{key}"] for key in looks]
        alike[row["trajectory_id"], row["frame"]] += row["visible_pixels"] > 0 and [row[key] for key in looks] == own
    stated = {(row["trajectory_id"], row["start_frame"]): row for row in rows(folder, "target_losses", [
        "trajectory_id", "start_frame", "end_frame", "duration_s", "frames_out_of_view", "reacquired", "look_alikes"])}
    losses = 0
    for name, by_frame in frames.items():
        for frame, row in by_frame.items():
            if row["look_alikes"] != alike[name, frame]:
                wrong.append(f"{name} frame {frame}: {alike[name, frame]} people are dressed like the target; the table says {row['look_alikes']}")
        for is_lost, run in groupby(range(len(by_frame)), lambda frame: by_frame[frame]["visible_pixels"] == 0):
            lost = list(run)
            start, end = lost[0], lost[-1] + 1
            if not is_lost:
                continue
            losses, again = losses + 1, end < len(by_frame)
            expected = {"trajectory_id": name, "start_frame": start, "end_frame": end, "duration_s": len(lost) * flights[name]["dt_s"],
                        "frames_out_of_view": sum(not by_frame[it]["in_view"] for it in lost), "reacquired": again,
                        "look_alikes": alike[name, end] if again else None}
            if stated.pop((name, start), None) != expected:
                wrong.append(f"{name}: the target is lost from frame {start} to {end}; the table says otherwise")
    wrong += [f"{name} frame {frame}: the table states a loss that is none" for name, frame in stated]
    print(f"{folder}: {sum(len(it) for it in bodies.values())} frames with bodies, two bodies {nearest_two:.3f} m apart at least, flights",
          f"{nearest_flight:.2f} m from bodies and {nearest_town:.2f} m from the town at least; {losses} losses; {len(wrong)} things wrong")
    return wrong


end_with(main(Path(sys.argv[1])))
