"""Facts of made-up flights for check_text_judge.py: lengths, angles and times that fit together, any turns, stops and clothes."""

import math
import random

from shared import COLOURS

DIRECTIONS = "east southeast south southwest west northwest north northeast".split()


def flight(rng):
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
    start = rng.choice(DIRECTIONS)
    return {
        "walks": walks,
        "start_direction": start,
        "end_direction": rng.choice(DIRECTIONS) if turns else start,
        "turns": turns,
        "stops": stops,
        "duration_s": duration,
        "way_m": speed * (duration - standing) if walks else 0.0,
        "walking_speed_mps": speed if walks else 0.0,
        "distance_m": math.hypot(aside, altitude),
        "pitch_down_deg": rng.choice([aimed] * 3 + [rng.uniform(-20, 5), 0.0, rng.uniform(-30, 70)]),
        "altitude_m": altitude,
        "visibility": 0.9,
        "wear": None if rng.random() < 0.15 else {"top": rng.choice(COLOURS).capitalize(), "trousers": rng.choice(COLOURS).capitalize(), "backpack": rng.random() < 0.5},
    }


def flights(count, seed):
    rng = random.Random(seed)
    return {f"flight-{i:03}": flight(rng) for i in range(count)}
