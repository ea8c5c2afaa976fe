"""Boxes and cameras as `cosfly-lab render --boxes FILE` writes them, and how frames are timed."""

import argparse
import json
import time

import numpy


class Scene:
    """World: left-handed, x ahead, y right, z up, metres. Body: x along the optical axis, y right, z up."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        self.width, self.height, self.focal_px = data["width"], data["height"], data["focal_px"]
        self.ground_low, self.ground_high = data["ground_m"]
        boxes = data["boxes"]
        self.centers = numpy.array([box["center_m"] for box in boxes], dtype=numpy.float64)
        self.halves = numpy.array([box["half_extents_m"] for box in boxes], dtype=numpy.float64)
        self.yaws = numpy.array([box["yaw_rad"] for box in boxes], dtype=numpy.float64)
        self.instances = numpy.array([box["instance"] for box in boxes], dtype=numpy.uint32)
        # JSON has the columns of the matrix one after the other.
        self.views = [
            (numpy.array(view["position_m"]), numpy.array(view["world_from_body"]).T) for view in data["views"]
        ]


def arguments(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("boxes", help="what `cosfly-lab render --boxes FILE` wrote")
    parser.add_argument("--rounds", type=int, default=3, help="rounds over all views; the least time counts")
    return parser.parse_args()


def least_cpu_ms(draw, views, rounds):
    """CPU milliseconds per view of the quickest round; every thread of this process counts."""
    least = float("inf")
    for _ in range(rounds + 1):  # the first one warms up
        begin = time.process_time()
        for view in views:
            draw(view)
        least = min(least, 1e3 * (time.process_time() - begin) / len(views))
    return least


def said(name, scene, cpu_ms, depth, instance):
    """`depth`: metres, inf for sky; `instance`: 0 off boxes; both of the first view."""
    on_boxes = instance > 0
    print(
        f"{name}: {cpu_ms:.2f} ms of CPU per frame, {scene.width} x {scene.height}, {len(scene.instances)} boxes, "
        f"{len(scene.views)} views; first view: {100 * on_boxes.mean():.2f} % on boxes, "
        f"mean depth of those {depth[on_boxes].mean():.3f} m"
    )
