"""A law of flight by hand, as a graph in ONNX: it sees what the depth network sees, and looks for a view past what hides its target.

    python recipes/training/follow_law.py recipes/policies/follow_law.onnx

It sees depth, the target's mask and its own motion, and keeps between steps where the target was, how it moved, and points of what it has seen in
the last 14 seconds. In each step it draws what hides the target, one to seven seconds ahead, from 128 directions, and weighs 147 velocities: how
hidden the target would be, the distance, the way to the best view, and what stands in the way. Nothing is fitted; the numbers were chosen by
hand, on walks of the seeds 7002 and 7003. Needs `pip install . numpy onnx`.
"""

import argparse
import pathlib

import tools

tools.need("numpy", "onnx", "cosfly")
import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

import cosfly.onnx

STEP_S, SIZE_PX = 0.1, 96
PIXELS = np.array([2, 10, 18, 26, 32, 36, 40, 44, 48, 52, 56, 60, 66, 74, 82, 90])  # rows and columns of the points, denser in the middle
FRAMES, EVERY = 7, 20  # pictures whose points are kept beside the present ones, and the steps between two
POINTS, ALL = len(PIXELS) ** 2, len(PIXELS) ** 2 * (FRAMES + 1)
FAR_BELOW_M = 1000  # heights are kept above this, so that an empty memory is no obstacle
PLACE_GAIN, SPEED_GAIN = 0.6, 0.6  # share of the surprise; 1/s
DIRECTIONS = 16
TURNS = np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS
ALONG = np.stack([np.cos(TURNS), np.sin(TURNS)], 1).astype(np.float32)
ACROSS = np.stack([-np.sin(TURNS), np.cos(TURNS)], 1).astype(np.float32)
RISES = (-2.0, 0.0, 2.0)
LEVEL = [(0.0, 0.0), *(np.float32([1.0, 2.2, 4.5])[:, None, None] * ALONG).reshape(-1, 2)]  # 32 bits in every numpy
CHOICES = np.array([(x, y, rise) for x, y in LEVEL for rise in RISES], np.float32)  # m/s; along the level, against the target
RESPONSE = 1.5  # 1/s; how fast the drone takes on a velocity
COLDNESS = 10.0  # of the choice: the higher, the more the best velocity counts
EFFORT, SPEED_COST = 0.01, 0.004  # of squares of changes and of speeds against the target, m/s
# Views: directions around the target, and rise over run.
SLOPES = np.array([0.25, 0.45, 0.7, 1.0, 1.4, 2.0, 3.2, 6.0], np.float32)
SINES = SLOPES / np.sqrt(1 + SLOPES**2)
RAYS = np.stack([np.repeat(ALONG[:, 0], len(SLOPES)), np.repeat(ALONG[:, 1], len(SLOPES)), np.tile(SLOPES, DIRECTIONS)])
SOON = ((1.0, 1.6), (2.5, 2.5))  # seconds ahead, and the cost of a hidden target then, of velocities
LATER = ((4.5, 1.5), (7.0, 1.0))  # the same, of the best view alone
BESIDE_M, SOFT_M2 = 0.7, 0.35  # how near to a line of sight a point hides the target, and how soft that border is
THICK_M, OVER_M = 3.5, 0.3  # how far below a point its obstacle is supposed to go on, and how far above it
REACH_M, TALL_M = 21.0, 1.0  # points that hide: from the target, above it
DISTANCE_M, LOWEST_M, STEEPNESS, STEEP_COST = (14.0, 26.0), 9.0, 1.0, 0.02
GOAL_M, GOAL_COLDNESS, TRIP_COST, GOAL_COST = 21.0, 40.0, 0.02, 0.06  # distance of the best view; costs for each metre
TRUST_S = 4.0  # a target that was hidden for longer is supposed to stop; from a second before, the drone climbs to look for it
# Obstacles: within, for points down to so far below the drone, and cost for each m/s towards them; room around the drone, and cost of its loss.
NEAR_M, BELOW_M, NEAR_COST = 6.0, 3.5, 2.0
AHEAD_S, ROOM_M, ROOM_COST = (1.0, 2.4), 2.0, 2.0
BLIND_MPS, BLIND_COST = 1.0, 0.08  # speed out of the camera's view that is free, and the cost of the square of more
MIDDLE = (np.arange(SIZE_PX, dtype=np.float32) + 0.5) / (SIZE_PX / 2) - 1
TO_RIGHT, TO_TOP = np.meshgrid(MIDDLE, -MIDDLE)
CENTRE = np.outer(abs(MIDDLE) < 2 / SIZE_PX, abs(MIDDLE) < 2 / SIZE_PX) * (SIZE_PX**2 / 4)


class Graph:
    """Nodes and constants of a graph in ONNX."""

    def __init__(self):
        self.nodes, self.constants = [], []

    def node(self, kind, *inputs, name=None, **attributes):
        name = name or f"v{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, [self.of(each).name for each in inputs], [name], **attributes))
        return Value(self, name)

    def of(self, value):
        """A value, or a constant: floats, but for arrays of whole numbers."""
        if isinstance(value, Value):
            return value
        value = value if isinstance(value, np.ndarray) else np.array([value], np.float32)
        name = f"c{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(value if value.dtype == np.int64 else value.astype(np.float32), name))
        return Value(self, name)


class Value:
    """A value of a graph, for which Python's operators make nodes."""

    __array_ufunc__ = None  # numpy leaves its operators to this class

    def __init__(self, graph, name):
        self.graph, self.name = graph, name

    def __add__(self, other):
        return self.graph.node("Add", self, other)

    def __sub__(self, other):
        return self.graph.node("Sub", self, other)

    def __rsub__(self, other):
        return self.graph.node("Sub", other, self)

    def __mul__(self, other):
        return self.graph.node("Mul", self, other)

    def __truediv__(self, other):
        return self.graph.node("Div", self, other)

    def __rtruediv__(self, other):
        return self.graph.node("Div", other, self)

    def __rmatmul__(self, other):
        return self.graph.node("MatMul", other, self)

    def __matmul__(self, other):
        return self.graph.node("MatMul", self, other)

    def __neg__(self):
        return self.graph.node("Neg", self)

    def __abs__(self):
        return self.graph.node("Abs", self)

    __radd__, __rmul__ = __add__, __mul__

    def __getitem__(self, place):
        """An entry, or a stretch, of the first axis."""
        first, end = (place.start, place.stop) if isinstance(place, slice) else (place, place + 1)
        return self.graph.node("Slice", self, np.array([first]), np.array([end]))

    def least(self, least):
        return self.graph.node("Max", self, least)

    def most(self, most):
        return self.graph.node("Min", self, most)

    def within(self, least, most):
        return self.least(least).most(most)

    def sigmoid(self):
        return self.graph.node("Sigmoid", self)

    def softmax(self):
        return self.graph.node("Softmax", self, axis=1)

    def shaped(self, *sizes):
        return self.graph.node("Reshape", self, np.array(sizes))

    def mean(self):
        return self.graph.node("ReduceMean", self, axes=[0, 1], keepdims=1).shaped(1)

    def at_pixels(self):
        return self.graph.node("Gather", self.graph.node("Gather", self, PIXELS, axis=0), PIXELS, axis=1).shaped(POINTS)

    def squared(self):
        """The square of the length of each column of three."""
        return self.graph.node("ReduceMean", self * self, axes=[0], keepdims=1) * 3

    def root(self):
        return self.graph.node("Sqrt", self)

    def highest(self, rows=DIRECTIONS):
        """The highest value in each row over all points."""
        pooled = self.shaped(1, 1, rows, ALL)
        for count in (POINTS, FRAMES + 1):
            pooled = self.graph.node("MaxPool", pooled, kernel_shape=[1, count], strides=[1, count])
        return pooled.shaped(rows, 1)


def joined(*parts, axis=0):
    return parts[0].graph.node("Concat", *parts, axis=axis)


def length(*parts, least=1e-3):
    squares = [part * part for part in parts]
    return sum(squares[1:], squares[0]).least(least**2).root()


class Camera:
    """The camera's axes, from odometry: unit vectors along the world's axes."""

    def __init__(self, odometry):
        x, y, self.sin = (odometry[axis] for axis in range(3))
        self.cos = length(x, y)
        self.x, self.y = x / self.cos, y / self.cos

    def world(self, far, right, up):
        """A place in the picture's axes along those of the world."""
        ahead = far * self.cos - up * self.sin
        return [ahead * self.x - right * self.y, ahead * self.y + right * self.x, far * self.sin + up * self.cos]

    def heading(self, x, y):
        """A vector on the level: ahead, right."""
        return x * self.x + y * self.y, y * self.x - x * self.y


def tracked(camera, own, depth, mask, memory):
    """Place and velocity of the target from the drone, along the world's axes; time since it was seen, and whether it ever was."""
    masked, area = depth * mask, mask.mean().least(1 / SIZE_PX**2)
    seen = (mask.mean() * SIZE_PX**2).most(1)
    age, known = memory[6], memory[7]
    # A target that was never seen is in the middle of the picture: there the camera is aimed at first.
    aimed = (1 - known) * (1 - seen)
    far, *aside = (picture.mean() / area for picture in (masked, masked * TO_RIGHT, masked * TO_TOP))
    measured = camera.world(far + (depth * CENTRE).mean() * aimed, *aside)
    seen = seen.least(1 - known)
    again = (age * 10 - 2).within(0, 1)  # seen after a while: the place is taken over, and the surprise was made in all that time
    lost = (age - TRUST_S).within(0, 1) * 0.1
    gain = known * ((1 - again) * SPEED_GAIN + again * 0.5 / (age + 1))
    place, speed = [], []
    for axis, (kept, share) in enumerate([(lost + 0.005, 1.0), (lost + 0.005, 1.0), (0.3, 0.5)]):
        moved = memory[3 + axis]
        expected = memory[axis] + (moved - own[axis]) * STEP_S
        surprise = (measured[axis] - expected) * seen
        place.append(expected + surprise * ((known * PLACE_GAIN).least(again) + (1 - known) * seen))
        bounded = surprise.within(-0.8, 0.8) * (1 - again) + surprise.within(-3.0, 3.0) * again
        moved = moved * (1 - (1 - seen) * kept) * (1.0 if axis < 2 else 0.9)
        speed.append(moved + bounded * gain * share)
    return place, speed, (age + STEP_S) * (1 - seen), known.least(seen)


def surroundings(camera, own, depth, points, tick):
    """Points on all that was seen in the last seconds, from the drone along the world's axes, and those to keep."""
    far = depth.at_pixels()
    x, y, z = camera.world(far, far * TO_RIGHT[np.ix_(PIXELS, PIXELS)].reshape(-1), far * TO_TOP[np.ix_(PIXELS, PIXELS)].reshape(-1))
    z = z + (far * 100).most(1) * FAR_BELOW_M  # a blind camera sees nothing at all
    now = joined(*(axis.shaped(1, -1) for axis in (x, y, z)))
    old = points - joined(*own).shaped(3, 1) * STEP_S
    older = depth.graph.node("Slice", old, np.array([0]), np.array([(FRAMES - 1) * POINTS]), np.array([1]))
    kept = old + (joined(now, older, axis=1) - old) * tick
    seen = joined(now, old, axis=1)
    return seen[0:2], seen[2] - FAR_BELOW_M, kept


def blocked(flat, up, speed):
    """Cost of flying towards what stands as high as the drone, for each choice."""
    along, aside = ALONG @ flat, abs(ACROSS @ flat)
    lower = (-up - BELOW_M).least(0) * 10.0
    way = along.least(0) + (aside - 1.0).least(0) * 3.0 + (-along).least(0) * 10.0 + lower
    close = (1 - way * (1 / NEAR_M)).highest().least(0)
    towards = [((speed[0] + CHOICES[:, :1]) * float(x) + (speed[1] + CHOICES[:, 1:2]) * float(y)).least(0) for x, y in ALONG]
    return joined(*towards, axis=1) @ (close * close) * NEAR_COST


def crowded(flat, up, spots):
    """Cost of points too near to a place, for each choice."""
    points = joined(flat, up.shaped(1, -1))
    half = (spots[0] * spots[0] + spots[1] * spots[1] + spots[2] * spots[2]) * 0.5
    near = (joined(*spots, half * 0 + 1, axis=1) @ joined(points, points.squared() * -0.5)).highest(len(CHOICES)) - half
    return (near * (2 / ROOM_M**2) + 1).least(0) * ROOM_COST  # near is minus half the square of the distance


def hidden(flat, up, target, thick_m=THICK_M, beside_m=BESIDE_M):
    """How likely obstacles hide a place: 0 to 1, for each direction and slope."""
    # Each point hides what is behind a ball around the middle of its obstacle, in a space that is squeezed to make it round.
    squeeze = beside_m * 2 / (thick_m + OVER_M)
    rays = RAYS.T * np.array([1, 1, squeeze])
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    over = up - target[2]
    balls = joined(flat - joined(*target[:2]).shaped(2, 1), ((over - (thick_m - OVER_M) / 2) * squeeze).shaped(1, -1))
    square = balls.squared()
    distance = square.least(beside_m**2).root()
    edge = distance * (square - beside_m**2).least(0).root()
    apart = ((TALL_M - over).least(0) + (distance - REACH_M).least(0)).shaped(1, -1) * 10.0
    inside = np.hstack([rays, -np.ones((len(rays), 1))]) @ joined(balls * distance, edge + apart)
    return (inside.highest(len(rays)) * (1 / SOFT_M2) + 1).within(0, 1).shaped(DIRECTIONS, len(SLOPES))


def looked_up(drawn, view):
    """What was drawn for directions and slopes, at views that are vectors from the target; their steepness; their lengths."""
    level, far = length(*view[:2], least=0.5), length(*view)
    near = ((view[0] / level * ALONG[:, 0].reshape(1, -1) + view[1] / level * ALONG[:, 1].reshape(1, -1)) * 60.0).softmax()
    apart = view[2] / far - SINES.reshape(1, -1)
    shares = (apart * apart * -150.0).softmax()
    return ((near @ drawn) * shares) @ np.ones((len(SLOPES), 1)), view[2] / level, far


def bent(steepness):
    """Cost of a view's steepness."""
    return (steepness - STEEPNESS) * (steepness - STEEPNESS) * STEEP_COST


def best_view(drawn, own, place, speed):
    """The best of all directions and slopes for the next seconds, a vector from the target."""
    blend = np.eye(DIRECTIONS) * 0.5 + np.roll(np.eye(DIRECTIONS), 1, 0) * 0.25 + np.roll(np.eye(DIRECTIONS), -1, 0) * 0.25
    grid = blend @ sum((one * weight for one, weight in drawn[1:]), drawn[0][0] * drawn[0][1])
    views = RAYS / np.sqrt(1 + RAYS[2:] ** 2) * GOAL_M
    plain = np.maximum(LOWEST_M - views[2:], 0) ** 2 * 0.1 + bent(np.minimum(RAYS[2:], 4))
    now = [own[axis] - place[axis] - (speed[axis] if axis < 2 else 0) for axis in range(3)]
    trip = length(*(views[axis : axis + 1] - now[axis] for axis in range(3)))
    cost = grid.shaped(1, -1) + trip * TRIP_COST + plain
    return ((cost * -GOAL_COLDNESS).softmax() @ views.T.copy()).shaped(3)


def chosen(camera, flat, up, own, place, speed, age):
    """Velocity along the world's axes: the mean of the choices, the cheapest counting most."""
    x, y, rise = (CHOICES[:, axis : axis + 1] for axis in range(3))
    wanted = [speed[0] + x, speed[1] + y, rise]
    changes = [velocity - was for velocity, was in zip(wanted, own)]
    squares = [change * change for change in changes]
    cost = (squares[0] + squares[1] + squares[2]) * EFFORT + (CHOICES**2).sum(1).reshape(-1, 1) * SPEED_COST + blocked(flat, up, speed)
    flown = lambda time_s: (time_s - (1 - np.exp(-time_s * RESPONSE)) / RESPONSE, (1 - np.exp(-time_s * RESPONSE)) / RESPONSE)
    for time_s in AHEAD_S:
        taken_s, kept_s = flown(time_s)
        cost = cost + crowded(flat, up, [velocity * taken_s + was * kept_s for velocity, was in zip(wanted, own)])
    ahead, right = camera.heading(*wanted[:2])
    blind = (abs(right) - ahead - BLIND_MPS).least(0)
    cost = cost + blind * blind * BLIND_COST
    lowest = (age - TRUST_S + 1).within(0, 4) * 3 + LOWEST_M
    at = lambda time_s: [place[0] + speed[0] * time_s, place[1] + speed[1] * time_s, place[2]]
    drawn = [(hidden(flat, up, at(time_s)), weight) for time_s, weight in SOON + LATER]
    for (time_s, _), (one, weight) in zip(SOON, drawn):
        taken_s, kept_s = flown(time_s)
        view = [velocity * taken_s + was * kept_s - there for velocity, was, there in zip(wanted, own, at(time_s))]
        unseen, steepness, distance = looked_up(one, view)
        beyond = (DISTANCE_M[0] - distance).least(0) + (distance - DISTANCE_M[1]).least(0)
        sunk = (lowest - view[2]).least(0)
        cost = cost + unseen * weight + beyond * beyond * 0.025 + sunk * sunk * 0.1 + bent(steepness.most(4))
    goal = best_view(drawn, own, place, speed)
    cost = cost + length(*(view[axis] - goal[axis] for axis in range(3))) * GOAL_COST
    best = ((cost.shaped(1, len(CHOICES)) * -COLDNESS).softmax() @ CHOICES).shaped(3)
    return best[0] + speed[0], best[1] + speed[1], best[2]


def turned(camera, own, place, speed):
    """Rates of the camera's pitch and yaw towards the target, degrees/s. Straight above it the yaw hardly matters."""
    soon = [at + (moved - flown) * 0.15 for at, moved, flown in zip(place, speed, own)]
    ahead, right = camera.heading(*soon[:2])
    pitch = (camera.cos * soon[2] - camera.sin * ahead.least(0)) / length(ahead, soon[2])
    return [(turn * np.degrees(5)).within(-60, 60) for turn in (pitch, right / ahead.least(4.0))]


def law(graph, names):
    """The graph's nodes, and the shapes of what it keeps."""
    depth, mask, odometry, memory, points = (Value(graph, name) for name in names)
    camera, own = Camera(odometry), [odometry[axis] for axis in range(3, 6)]
    place, speed, age, known = tracked(camera, own, depth, mask, memory)
    count = memory[8] + 1
    tick = (count - (EVERY - 1)).within(0, 1)
    flat, up, kept = surroundings(camera, own, depth, points, tick)
    x, y, rise = chosen(camera, flat, up, own, place, speed, age)
    actions = joined(*camera.heading(x, y), rise, *turned(camera, own, place, speed)) * known
    graph.node("Reshape", actions, np.array([1, 5]), name="actions")
    graph.node("Identity", joined(*place, *speed, age, known, count * (1 - tick)), name="memory_out")
    graph.node("Identity", kept, name="points_out")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    out = parser.parse_args().out
    seen = {"depth": [SIZE_PX, SIZE_PX], "mask": [SIZE_PX, SIZE_PX], "odometry": [6]}
    states = {"memory": [9], "points": [3, FRAMES * POINTS]}
    graph = Graph()
    law(graph, [*seen, *states])
    told = lambda shapes: [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape) for name, shape in shapes.items()]
    gives = {"actions": [1, 5], **{f"{name}_out": shape for name, shape in states.items()}}
    made = helper.make_graph(graph.nodes, "follow_law", told(seen | states), told(gives), graph.constants)
    out.parent.mkdir(parents=True, exist_ok=True)
    onnx.save(helper.make_model(made, opset_imports=[helper.make_opsetid("", 17)], ir_version=8, producer_name="cosfly"), out)
    cosfly.onnx.describe(out, inputs={name: name for name in seen}, output="actions", states={name: f"{name}_out" for name in states})


if __name__ == "__main__":
    tools.script(main)
