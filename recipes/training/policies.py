"""The policies that ship: imitation of the expert with DAgger, in which the student's own flights lead, as files in ONNX.

    python recipes/training/policies.py state recipes/policies/follow_state.onnx WORK
    python recipes/training/policies.py depth recipes/policies/follow_depth.onnx WORK

`state` sees the 16 numbers of the state. `depth` sees depth, the target's mask and its own motion; it remembers where the target was,
how it moved, and takes its own motion into account. Needs `pip install . numpy onnx`; uses one processor for the fit, so that the same
seed gives the same file on the same processor. WORK, a new folder, gets labels and the students of all rounds, and may be removed.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import pathlib
import subprocess
import time

import tools

tools.need("numpy", "onnx", "cosfly")
import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

import cosfly.onnx

STEP_S = 0.1
SIZE_PX = 96
SCALE = np.array([6, 6, 3, 60, 60], np.float32)  # m/s and degrees/s
HIDDEN, EPOCHS, BATCH, RATE = 96, 40, 128, 2e-3
VELOCITY_GAIN, FASTEST_MPS = 0.1, 8.0
POOL_PX = 16
MEMORY = 8  # place (3) and velocity (3) of the target along the world's axes, age, whether it was ever seen
HERE = pathlib.Path(__file__).resolve().parent
SUITES = ["street", "trees", "crowd", "loss", "hard"]


class Arrays:
    """The operations below, on arrays of numpy."""

    add, sub, mul, div, maximum, minimum, sqrt, tanh, matmul = np.add, np.subtract, np.multiply, np.divide, np.maximum, np.minimum, np.sqrt, np.tanh, np.matmul

    @staticmethod
    def const(value):
        return np.asarray(value, np.float32)

    @staticmethod
    def mean(x):
        return np.mean(x, dtype=np.float32).reshape(1)

    @staticmethod
    def part(x, first, end):
        return x[first:end]

    @staticmethod
    def concat(*parts):
        return np.concatenate(parts)

    @staticmethod
    def pooled(x):
        rows, columns = (side // POOL_PX for side in x.shape)
        return x.reshape(rows, POOL_PX, columns, POOL_PX).mean(axis=(1, 3), dtype=np.float32).reshape(-1)


class Nodes:
    """The same operations as nodes of a graph in ONNX; values are names."""

    def __init__(self):
        self.nodes, self.constants = [], []

    def node(self, kind, *inputs, **attributes):
        name = f"v{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, inputs, [name], **attributes))
        return name

    def const(self, value, dtype=np.float32):
        name = f"c{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(np.asarray(value, dtype), name))
        return name

    def __getattr__(self, name):
        kinds = {"add": "Add", "sub": "Sub", "mul": "Mul", "div": "Div", "maximum": "Max", "minimum": "Min", "sqrt": "Sqrt", "tanh": "Tanh", "matmul": "MatMul"}
        return lambda *inputs: self.node(kinds[name], *inputs)

    def mean(self, x):
        return self.node("Reshape", self.node("ReduceMean", x, axes=[0, 1], keepdims=1), self.const([1], np.int64))

    def part(self, x, first, end):
        return self.node("Slice", x, self.const([first], np.int64), self.const([end], np.int64))

    def concat(self, *parts):
        return self.node("Concat", *parts, axis=0)

    def pooled(self, x):
        square = self.node("Reshape", x, self.const([1, 1, SIZE_PX, SIZE_PX], np.int64))
        pooled = self.node("AveragePool", square, kernel_shape=[POOL_PX, POOL_PX], strides=[POOL_PX, POOL_PX])
        return self.node("Reshape", pooled, self.const([-1], np.int64))


class Kit:
    """Short forms over one of the two."""

    def __init__(self, ops):
        self.ops = ops

    def one(self, x, place):
        return self.ops.part(x, place, place + 1)

    def ones(self, x, count, first=0):
        return [self.one(x, first + place) for place in range(count)]

    def times(self, x, factor):
        return self.ops.mul(x, self.ops.const([factor]))

    def plus(self, x, number):
        return self.ops.add(x, self.ops.const([number]))

    def least(self, x, number):
        return self.ops.maximum(x, self.ops.const([number]))

    def most(self, x, number):
        return self.ops.minimum(x, self.ops.const([number]))

    def sum(self, *terms):
        total = terms[0]
        for term in terms[1:]:
            total = self.ops.add(total, term)
        return total


def view_of(kit, ahead, right, up, cos_pitch, sin_pitch):
    """Where a place is from the camera: to the right, ahead, above its axis, and how far."""
    ops = kit.ops
    away = ops.sqrt(kit.plus(kit.sum(ops.mul(ahead, ahead), ops.mul(right, right)), 1.0))
    above = ops.sub(ops.mul(ops.div(up, away), cos_pitch), sin_pitch)
    return [kit.times(ops.div(right, away), 4), ops.div(ahead, away), kit.times(above, 4), kit.plus(kit.times(away, 1 / 20), -1)]


def features_of_state(ops, state):
    """Features of the 16 numbers of the state."""
    kit = Kit(ops)
    scaled = ops.div(state, ops.const([20, 20, 20, 2, 2, 1, 4, 4, 4, 3, 3, 3, 57, 20, 1, 5]))
    ahead, right, up = kit.ones(state, 3)
    pitch = kit.times(kit.one(state, 12), np.pi / 180)
    square = ops.mul(pitch, pitch)
    sin = ops.mul(pitch, kit.plus(ops.mul(square, kit.plus(kit.times(square, 1 / 120), -1 / 6)), 1))
    cos = kit.plus(ops.mul(square, kit.plus(kit.times(square, 1 / 24), -1 / 2)), 1)
    age = kit.times(kit.most(kit.one(state, 15), 5), 1 / 5)
    return ops.concat(scaled, *view_of(kit, ahead, right, kit.plus(up, 1), cos, sin), age), None


def features_of_depth(ops, depth, mask, odometry, memory):
    """Features of pictures, own motion and memory, and the memory for the next step."""
    kit = Kit(ops)
    middle = (np.arange(SIZE_PX) + 0.5 - SIZE_PX / 2) / (SIZE_PX / 2)
    to_right, to_top = np.meshgrid(middle, -middle)
    masked = ops.mul(depth, mask)
    seen_share = ops.mean(mask)
    area = kit.least(seen_share, 1 / SIZE_PX**2)
    seen = kit.most(kit.times(seen_share, SIZE_PX**2), 1)
    far = ops.div(ops.mean(masked), area)
    across = ops.div(ops.mean(ops.mul(masked, ops.const(to_right))), area)
    over = ops.div(ops.mean(ops.mul(masked, ops.const(to_top))), area)

    axis_x, axis_y, sin_pitch = kit.ones(odometry, 3)
    own = kit.ones(odometry, 3, 3)
    cos_pitch = ops.sqrt(kit.least(kit.sum(ops.mul(axis_x, axis_x), ops.mul(axis_y, axis_y)), 1e-6))
    ahead_x, ahead_y = ops.div(axis_x, cos_pitch), ops.div(axis_y, cos_pitch)

    def in_heading(x, y):
        return kit.sum(ops.mul(x, ahead_x), ops.mul(y, ahead_y)), ops.sub(ops.mul(y, ahead_x), ops.mul(x, ahead_y))

    ahead = ops.sub(ops.mul(far, cos_pitch), ops.mul(over, sin_pitch))
    measured = [
        ops.sub(ops.mul(ahead, ahead_x), ops.mul(across, ahead_y)),
        kit.sum(ops.mul(ahead, ahead_y), ops.mul(across, ahead_x)),
        kit.sum(ops.mul(far, sin_pitch), ops.mul(over, cos_pitch)),
    ]
    unseen = kit.plus(kit.times(seen, -1), 1)
    age, known = kit.ones(memory, 2, 6)
    place, speed = [], []
    for axis in range(3):
        was, moved = kit.one(memory, axis), kit.one(memory, 3 + axis)
        expected = kit.sum(was, kit.times(ops.sub(moved, own[axis]), STEP_S))
        surprise = kit.least(kit.most(kit.times(ops.sub(measured[axis], expected), 1 / STEP_S), FASTEST_MPS), -FASTEST_MPS)
        place.append(kit.sum(ops.mul(seen, measured[axis]), ops.mul(unseen, expected)))
        kept = ops.mul(moved, kit.plus(kit.times(unseen, -0.02), 1))
        speed.append(kit.sum(kept, kit.times(ops.mul(ops.mul(seen, known), surprise), VELOCITY_GAIN)))
    age = ops.mul(unseen, kit.plus(age, STEP_S))
    known = ops.maximum(known, seen)
    memory = ops.concat(*place, *speed, age, known)

    rel_ahead, rel_right = in_heading(place[0], place[1])
    speed_ahead, speed_right = in_heading(speed[0], speed[1])
    own_ahead, own_right = in_heading(own[0], own[1])
    near = ops.pooled(ops.div(ops.const(np.ones((1, 1))), kit.least(depth, 1)))
    return ops.concat(
        kit.times(rel_ahead, 1 / 20), kit.times(rel_right, 1 / 20), kit.times(place[2], 1 / 20),
        kit.times(speed_ahead, 1 / 2), kit.times(speed_right, 1 / 2),
        kit.times(own_ahead, 1 / 4), kit.times(own_right, 1 / 4), kit.times(own[2], 1 / 4), sin_pitch, cos_pitch,
        *view_of(kit, rel_ahead, rel_right, place[2], cos_pitch, sin_pitch),
        seen, known, kit.times(kit.most(age, 5), 1 / 5), near,
    ), memory  # fmt: skip


KINDS = {
    # Inputs with their shapes and observations, what the labels must keep, features, size of the memory.
    "state": ({"state": [16]}, (), features_of_state, 0),
    "depth": ({"depth": [SIZE_PX, SIZE_PX], "mask": [SIZE_PX, SIZE_PX], "odometry": [6]}, ("depth", "mask", "odometry"), features_of_depth, MEMORY),
}


def write(kind, weights, path):
    """The student as a file in ONNX."""
    inputs, _, features, remembered = KINDS[kind]
    nodes = Nodes()
    fed = [*inputs, "memory"] if remembered else [*inputs]
    found, memory = features(nodes, *fed)
    layer = nodes.node("Reshape", found, nodes.const([1, -1], np.int64))
    for place in (0, 2):
        layer = nodes.tanh(nodes.add(nodes.matmul(layer, nodes.const(weights[place])), nodes.const(weights[place + 1])))
    out = nodes.add(nodes.matmul(layer, nodes.const(weights[4])), nodes.const(weights[5]))
    nodes.nodes.append(helper.make_node("Mul", [out, nodes.const(SCALE)], ["actions"]))
    told = lambda name, shape: helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)
    takes, gives = [told(name, shape) for name, shape in inputs.items()], [told("actions", [1, 5])]
    if remembered:
        nodes.nodes.append(helper.make_node("Identity", [memory], ["memory_out"]))
        takes.append(told("memory", [remembered]))
        gives.append(told("memory_out", [remembered]))
    graph = helper.make_graph(nodes.nodes, f"follow_{kind}", takes, gives, nodes.constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8, producer_name="cosfly")
    onnx.save(model, path)
    states = {"memory": "memory_out"} if remembered else {}
    cosfly.onnx.describe(path, inputs={name: name for name in inputs}, output="actions", states=states)


def examples(kind, version):
    """Features and the expert's actions of all labelled states of a version, whose pictures are removed: they are the most of it."""
    _, kept, features, remembered = KINDS[kind]
    rows, learnt = [], []
    for episode in sorted(version.glob("rounds/*/*.jsonl")):
        labels = [json.loads(line) for line in episode.read_text().splitlines()]
        stem = str(episode).removesuffix(".jsonl")
        seen = [np.load(f"{stem}.{name}.npy") for name in kept] or [np.array([label["state"] for label in labels], np.float32)]
        memory = np.zeros(remembered, np.float32)
        for step, label in enumerate(labels):
            at_step = [of[step].astype(np.float32) for of in seen]
            found, memory = features(Arrays, *at_step, *([memory] if remembered else []))
            if label["expert_action"] is not None:
                rows.append(found)
                learnt.append(label["expert_action"])
    for pictures in [*version.glob("rounds/*/*.npy"), *(version / f"{name}.npy" for name in kept)]:
        pictures.unlink(missing_ok=True)
    return np.array(rows, np.float32), np.array(learnt, np.float32)


def fitted(x, y, seed):
    """Weights of the network that says the expert's actions, by Adam and the loss of Huber."""
    y = np.clip(y / SCALE, -1.5, 1.5)
    random = np.random.default_rng(seed)
    sizes = [x.shape[1], HIDDEN, HIDDEN, 5]
    weights = []
    for inputs, outputs in zip(sizes, sizes[1:]):
        weights += [random.normal(0, inputs**-0.5, (inputs, outputs)).astype(np.float32), np.zeros(outputs, np.float32)]
    mean, square, steps = [np.zeros_like(w) for w in weights], [np.zeros_like(w) for w in weights], 0
    for epoch in range(EPOCHS):
        rate, order = RATE * (1 - epoch / EPOCHS), random.permutation(len(x))
        for start in range(0, len(x), BATCH):
            rows = order[start : start + BATCH]
            first = np.tanh(x[rows] @ weights[0] + weights[1])
            second = np.tanh(first @ weights[2] + weights[3])
            error = np.clip(second @ weights[4] + weights[5] - y[rows], -0.3, 0.3) / len(rows)
            back2 = (error @ weights[4].T) * (1 - second**2)
            back1 = (back2 @ weights[2].T) * (1 - first**2)
            slopes = [x[rows].T @ back1, back1.sum(0), first.T @ back2, back2.sum(0), second.T @ error, error.sum(0)]
            steps += 1
            for w, slope, m, s in zip(weights, slopes, mean, square):
                m += 0.1 * (slope - m)
                s += 0.001 * (slope**2 - s)
                w -= np.float32(rate) * (m / np.float32(1 - 0.9**steps)) / (np.sqrt(s / np.float32(1 - 0.999**steps)) + np.float32(1e-8))
    return weights


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--rounds", type=tools.counted, default=3)
    given = tools.flown_anew(parser, SUITES)
    store = ["--store", given.store] if given.store else []
    kept, began = KINDS[given.kind][1], time.time()
    keep = ["--keep", ",".join(kept), "--size-px", str(SIZE_PX)] if kept else []
    x, y = [], []
    for round_ in range(given.rounds + 1):
        student = given.work / f"{given.kind}{round_ - 1}.onnx"
        who = ["--policy", f"onnx:{student}", "--expert-share", str(0.5**round_)] if round_ else ["--policy", "hold", "--expert-share", "1"]
        for suite in given.suites:
            version = given.work / f"{given.kind}-{suite}-{round_}"
            recipe = HERE.parent / "suites" / f"{suite}.toml"
            command = [given.cosfly, "dagger", recipe, "--set", f"seed={given.seed}", *who, "--round", f"round{round_}", *keep, "--out", version, *store]
            tools.cosfly(command, stdout=subprocess.DEVNULL)
            found = examples(given.kind, version)
            x.append(found[0])
            y.append(found[1])
        weights = fitted(np.concatenate(x), np.concatenate(y), given.seed)
        write(given.kind, weights, given.work / f"{given.kind}{round_}.onnx")
        print(f"round {round_}: {sum(map(len, x))} labels, {time.time() - began:.0f} s", flush=True)
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_bytes((given.work / f"{given.kind}{given.rounds}.onnx").read_bytes())


if __name__ == "__main__":
    tools.script(main)
