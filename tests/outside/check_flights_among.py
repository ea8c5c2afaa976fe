"""Judges flights among boxes that move, as `cosfly-lab planner --many N --movers M --flights FILE` writes them.

    mkfifo flights
    cosfly-lab planner --many 10000 --movers 50 --flights flights & venv/bin/python tests/outside/check_flights_among.py flights

Shares no code with cosfly: distances from boxes that stand and boxes that move are sampled at 25 moments a frame, and at 1,000 moments where
a sample lies within half a metre above the clearance limit. Between frames drone and boxes go evenly; boxes turn the shorter way. Prints the numbers of flights, contacts
(nearer than 0.5 m) and flights nearer than their limits, and the least distances; ends with 1 where there is a contact or one too near.
With `--any`, contacts are counted and none is a fault, as for other planners."""

import sys

import numpy as np
from shared import require

CONTACT_M, CAP_M, ROUNDING = 0.5, 5.0, 1e-9
MOMENTS, FINE = 25, 1000


def read_exactly(file, count):
    data = file.read(count)
    require(len(data) == count, f"the file ends {count - len(data)} bytes too early")
    return data


def number(file):
    return int.from_bytes(read_exactly(file, 4), "little")


def reals(file, *shape):
    return np.frombuffer(read_exactly(file, 8 * int(np.prod(shape))), "<f8").reshape(shape)


def records(file):
    """(name, limit, waypoints or None, boxes that move, boxes that stand) of each path."""
    standing = np.zeros((0, 7))
    while kind := file.read(1):
        if kind == b"S":
            standing = reals(file, number(file), 7)
            continue
        name = read_exactly(file, number(file)).decode()
        if kind == b"N":
            yield name, 0.0, None, None, standing
            continue
        frames, movers = number(file), number(file)
        _, limit = reals(file, 2)
        waypoints = reals(file, frames, 3)
        yield name, limit, waypoints, reals(file, movers, frames, 7), standing


def sampled(drone_a, drone_b, box_a, box_b, moments):
    """Least distances of pairs (drone on its way from a to b, box on its way from a to b), metres; negative within the box."""
    share = np.linspace(0.0, 1.0, moments + 1)[None, :]
    even = lambda a, b: a[:, None] + (b - a)[:, None] * share
    away = [even(drone_a[:, k] - box_a[:, k], drone_b[:, k] - box_b[:, k]) for k in range(3)]
    turn = (box_b[:, 6] - box_a[:, 6] + np.pi) % (2 * np.pi) - np.pi
    yaw = box_a[:, 6][:, None] + turn[:, None] * share
    half = [even(box_a[:, 3 + k], box_b[:, 3 + k]) for k in range(3)]
    cos, sin = np.cos(yaw), np.sin(yaw)
    beyond = np.stack([np.abs(away[0] * cos + away[1] * sin), np.abs(away[1] * cos - away[0] * sin), np.abs(away[2])]) - np.stack(half)
    outside = np.sqrt((np.maximum(beyond, 0.0) ** 2).sum(axis=0))
    return np.where(outside > 0.0, outside, beyond.max(axis=0)).min(axis=1)


def least(drone_a, drone_b, box_a, box_b, limit):
    """Least distance of all pairs, up to the cap, metres."""
    ways = np.linalg.norm(drone_b - drone_a, axis=1) + np.linalg.norm(box_b[:, :3] - box_a[:, :3], axis=1)
    reach = np.maximum(np.linalg.norm(box_a[:, 3:6], axis=1), np.linalg.norm(box_b[:, 3:6], axis=1))
    near = np.linalg.norm(drone_a - box_a[:, :3], axis=1) - ways - reach < CAP_M
    if not near.any():
        return CAP_M
    pairs = [it[near] for it in (drone_a, drone_b, box_a, box_b)]
    coarse = sampled(*pairs, MOMENTS)
    close = coarse < limit + 0.5
    fine = sampled(*(it[close] for it in pairs), FINE).min() if close.any() else CAP_M
    return min(CAP_M, coarse.min(), fine)


def from_moving(waypoints, movers, limit):
    count, frames = movers.shape[:2]
    if count == 0 or frames < 2:
        return CAP_M
    drone_a, drone_b = (np.broadcast_to(way, (count, frames - 1, 3)).reshape(-1, 3) for way in (waypoints[:-1], waypoints[1:]))
    return least(drone_a, drone_b, movers[:, :-1].reshape(-1, 7), movers[:, 1:].reshape(-1, 7), limit)


def from_standing(waypoints, boxes, limit):
    reach = np.linalg.norm(boxes[:, 3:6], axis=1)[:, None] + CAP_M
    low, high = waypoints.min(axis=0) - reach, waypoints.max(axis=0) + reach
    boxes = boxes[((boxes[:, :3] >= low) & (boxes[:, :3] <= high)).all(axis=1)]
    distance = np.linalg.norm(waypoints[None, :-1] - boxes[:, None, :3], axis=2)
    step = np.linalg.norm(np.diff(waypoints, axis=0), axis=1)
    box, frame = np.nonzero(distance - step[None] - np.linalg.norm(boxes[:, 3:6], axis=1)[:, None] < CAP_M)
    if not len(box):
        return CAP_M
    return least(waypoints[frame], waypoints[frame + 1], boxes[box], boxes[box], limit)


def main(path, may_touch):
    paths = flights = contacts = near = 0
    least_moving = least_standing = CAP_M
    with open(path, "rb", buffering=1 << 20) as file:
        for name, limit, waypoints, movers, standing in records(file):
            paths += 1
            if waypoints is None:
                continue
            flights += 1
            require(np.isfinite(waypoints).all() and np.isfinite(movers).all(), f"{name}: a number is not finite")
            moving, still = from_moving(waypoints, movers, limit), from_standing(waypoints, standing, limit)
            least_moving, least_standing = min(least_moving, moving), min(least_standing, still)
            contacts += min(moving, still) < CONTACT_M
            is_near = min(moving, still) < limit - ROUNDING
            near += is_near
            if is_near and near <= 20:
                print(f"  {name}: {moving:.3f} m from what moves, {still:.3f} m from what stands")
    print(f"{paths} paths, {flights} flights: {contacts} contacts, {near} nearer than their limits; "
          f"least {least_moving:.3f} m from what moves, {least_standing:.3f} m from what stands")
    if paths == 0 or (not may_touch and (contacts or near)):
        sys.exit(1)


if __name__ == "__main__":
    main(sys.argv[1], "--any" in sys.argv[2:])
