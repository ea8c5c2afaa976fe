"""A policy that sees the 16 numbers of the state: imitation of the expert with DAgger, in which the student's own flights lead.

    python recipes/training/follow_state.py recipes/policies/follow_state.onnx WORK

Needs `pip install . numpy onnx`; uses one processor for the fit, so that the same seed gives the same file on the same processor. WORK, a new
folder, gets labels and the students of all rounds, and may be removed.
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

SCALE = np.array([6, 6, 3, 60, 60], np.float32)  # m/s and degrees/s
HIDDEN, EPOCHS, BATCH, RATE = 96, 40, 128, 2e-3
HERE = pathlib.Path(__file__).resolve().parent
SUITES = ["street", "trees", "crowd", "loss", "hard"]


class Arrays:
    """The operations below, on arrays of numpy."""

    add, sub, mul, div, maximum, minimum, sqrt, tanh, matmul = np.add, np.subtract, np.multiply, np.divide, np.maximum, np.minimum, np.sqrt, np.tanh, np.matmul

    @staticmethod
    def const(value):
        return np.asarray(value, np.float32)

    @staticmethod
    def part(x, first, end):
        return x[first:end]

    @staticmethod
    def concat(*parts):
        return np.concatenate(parts)


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

    def part(self, x, first, end):
        return self.node("Slice", x, self.const([first], np.int64), self.const([end], np.int64))

    def concat(self, *parts):
        return self.node("Concat", *parts, axis=0)


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


def features(ops, state):
    """Features of the 16 numbers of the state."""
    kit = Kit(ops)
    scaled = ops.div(state, ops.const([20, 20, 20, 2, 2, 1, 4, 4, 4, 3, 3, 3, 57, 20, 1, 5]))
    ahead, right, up = kit.ones(state, 3)
    pitch = kit.times(kit.one(state, 12), np.pi / 180)
    square = ops.mul(pitch, pitch)
    sin = ops.mul(pitch, kit.plus(ops.mul(square, kit.plus(kit.times(square, 1 / 120), -1 / 6)), 1))
    cos = kit.plus(ops.mul(square, kit.plus(kit.times(square, 1 / 24), -1 / 2)), 1)
    age = kit.times(kit.most(kit.one(state, 15), 5), 1 / 5)
    return ops.concat(scaled, *view_of(kit, ahead, right, kit.plus(up, 1), cos, sin), age)


def write(weights, path):
    """The student as a file in ONNX."""
    nodes = Nodes()
    layer = nodes.node("Reshape", features(nodes, "state"), nodes.const([1, -1], np.int64))
    for place in (0, 2):
        layer = nodes.tanh(nodes.add(nodes.matmul(layer, nodes.const(weights[place])), nodes.const(weights[place + 1])))
    out = nodes.add(nodes.matmul(layer, nodes.const(weights[4])), nodes.const(weights[5]))
    nodes.nodes.append(helper.make_node("Mul", [out, nodes.const(SCALE)], ["actions"]))
    told = lambda name, shape: [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)]
    graph = helper.make_graph(nodes.nodes, "follow_state", told("state", [16]), told("actions", [1, 5]), nodes.constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8, producer_name="cosfly")
    onnx.save(model, path)
    cosfly.onnx.describe(path, inputs={"state": "state"}, output="actions", states={})


def examples(version):
    """Features and the expert's actions of all labelled states of a version."""
    rows, learnt = [], []
    for episode in sorted(version.glob("rounds/*/*.jsonl")):
        labels = [json.loads(line) for line in episode.read_text().splitlines()]
        for label, state in zip(labels, np.array([label["state"] for label in labels], np.float32)):
            if label["expert_action"] is not None:
                rows.append(features(Arrays, state))
                learnt.append(label["expert_action"])
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
    parser.add_argument("--rounds", type=tools.counted, default=3)
    given = tools.flown_anew(parser, SUITES)
    store, began = ["--store", given.store] if given.store else [], time.time()
    x, y = [], []
    for round_ in range(given.rounds + 1):
        student = given.work / f"state{round_ - 1}.onnx"
        who = ["--policy", f"onnx:{student}", "--expert-share", str(0.5**round_)] if round_ else ["--policy", "hold", "--expert-share", "1"]
        for suite in given.suites:
            version = given.work / f"state-{suite}-{round_}"
            recipe = HERE.parent / "suites" / f"{suite}.toml"
            command = [given.cosfly, "dagger", recipe, "--set", f"seed={given.seed}", *who, "--round", f"round{round_}", "--out", version, *store]
            tools.cosfly(command, stdout=subprocess.DEVNULL)
            found = examples(version)
            x.append(found[0])
            y.append(found[1])
        weights = fitted(np.concatenate(x), np.concatenate(y), given.seed)
        write(weights, given.work / f"state{round_}.onnx")
        print(f"round {round_}: {sum(map(len, x))} labels, {time.time() - began:.0f} s", flush=True)
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_bytes((given.work / f"state{given.rounds}.onnx").read_bytes())


if __name__ == "__main__":
    tools.script(main)
