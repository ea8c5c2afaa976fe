#!/usr/bin/env python3
"""Writes a made-up CityJSON city on a hill: 2,000 turned houses with gables (`made_up_city.py FILE`). `check_cityjson.py` judges it."""

import json
import math
import random
import sys

STEP_M, SIZE = 20.0, 101


def ground_m(x, y):
    return 40.0 + 15.0 * math.sin(x / 310.0) * math.cos(y / 270.0)


def house(vertices, x, y, random_):
    """Solid of a gabled house whose floor lies on the lowest ground at its corners."""
    half, wide, turn = random_.uniform(5, 9), random_.uniform(3, 5), random_.uniform(0, math.pi)
    cos, sin = math.cos(turn), math.sin(turn)
    at = [(x + cos * u - sin * v, y + sin * u + cos * v) for u, v in ((-half, -wide), (half, -wide), (half, wide), (-half, wide), (-half, 0), (half, 0))]
    floor = min(ground_m(*one) for one in at[:4])
    eaves, first = floor + random_.uniform(3, 20), len(vertices)
    for corners, z in ((at[:4], floor), (at[:4], eaves), (at[4:], eaves + wide)):
        vertices.extend([round(x * 1000), round(y * 1000), round(z * 1000)] for x, y in corners)
    faces = [[3, 2, 1, 0], [4, 5, 9, 8], [8, 9, 6, 7], [0, 1, 5, 4], [1, 2, 6, 9, 5], [2, 3, 7, 6], [3, 0, 4, 8, 7]]
    solid = [[[[first + corner for corner in face]] for face in faces]]
    kinds = {"surfaces": [{"type": "GroundSurface"}, {"type": "RoofSurface"}, {"type": "WallSurface"}], "values": [[0, 1, 1, 2, 2, 2, 2]]}
    return {"type": "Building", "geometry": [{"type": "Solid", "lod": "2.2", "boundaries": solid, "semantics": kinds}]}


def relief(vertices):
    first, triangles = len(vertices), []
    vertices.extend([round(i * STEP_M * 1000), round(j * STEP_M * 1000), round(ground_m(i * STEP_M, j * STEP_M) * 1000)] for j in range(SIZE) for i in range(SIZE))
    for at in (first + j * SIZE + i for j in range(SIZE - 1) for i in range(SIZE - 1)):
        triangles += [[[at, at + 1, at + SIZE + 1]], [[at, at + SIZE + 1, at + SIZE]]]
    return {"type": "TINRelief", "geometry": [{"type": "CompositeSurface", "lod": "1", "boundaries": triangles}]}


random_, vertices = random.Random(5), []
things = {f"house_{j}_{i}": house(vertices, 40 + 38 * i, 30 + 48 * j, random_) for j in range(40) for i in range(50)}
things["hill"] = relief(vertices)
transform = {"scale": [0.001] * 3, "translate": [85_000, 447_000, 0]}
metadata = {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"}
city = {"type": "CityJSON", "version": "2.0", "transform": transform, "metadata": metadata, "CityObjects": things, "vertices": vertices}
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(city, file)
