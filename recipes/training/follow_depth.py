"""A trained policy that sees depth, the target's mask and its own motion: a network of 1,290 weights weighs the law's 147 velocities.

    python recipes/training/follow_depth.py recipes/policies/follow_depth.onnx WORK

Tracking, memory of points and drawing of what hides the target are those of follow_law.py. What the law does with them by hand, a network
learns: from 34 numbers of each velocity (how hidden the target would be, what is in the way, distance, effort) it tells how good the velocity
is. It learns from the law's own flights the mean of what the law and the expert do there. Needs `pip install . numpy onnx onnxruntime`; uses one
processor, so that the same seed gives the same file on the same processor. WORK, a new folder, gets labels and the networks of the first eighth,
quarter and half of the labels of each suite, for a learning curve (`eighths_1.onnx` and so on); it may be removed.
"""

import argparse
import json
import os
import pathlib
import subprocess
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import tools

tools.need("numpy", "onnx", "onnxruntime", "cosfly")
import follow_law as law
import numpy as np
import onnx
import onnxruntime
from follow_law import CHOICES, RESPONSE, SIZE_PX, STEP_S, Graph, Value, joined, length
from onnx import TensorProto, helper

import cosfly.onnx

HERE = pathlib.Path(__file__).resolve().parent
SUITES = ["hard", "street", "crowd", "trees", "loss"]
EVERY = 3  # steps between two that are learnt from
WIDE, NARROW, EPOCHS, BATCH, RATE = 24, 16, 12, 32, 3e-3
EXPERTS_SHARE = 0.5
MOST_MPS = np.array([4.5, 4.5, 2.0], np.float32)  # of a velocity against the target
SEEN = {"depth": [SIZE_PX, SIZE_PX], "mask": [SIZE_PX, SIZE_PX], "odometry": [6]}
STATES = {"memory": [9], "points": [3, law.FRAMES * law.POINTS]}
WALLS_M = (12.0, 0.5)  # obstacles that go on this far below a point, and this far beside it: houses, not crowns


def terms(camera, flat, up, own, place, speed, age, known):
    """Numbers of each velocity, all near 1, and of the moment."""
    x, y, rise = (CHOICES[:, axis : axis + 1] for axis in range(3))
    graph = camera.x.graph
    wanted = [speed[0] + x, speed[1] + y, rise]
    changes = [velocity - was for velocity, was in zip(wanted, own)]
    squares = [change * change for change in changes]
    effort = (squares[0] + squares[1] + squares[2]) * 0.02
    found = [effort, graph.of((CHOICES**2).sum(1).reshape(-1, 1) * 0.04), law.blocked(flat, up, speed) * 0.5]
    flown = lambda time_s: (time_s - (1 - np.exp(-time_s * RESPONSE)) / RESPONSE, (1 - np.exp(-time_s * RESPONSE)) / RESPONSE)
    for time_s in law.AHEAD_S:
        taken_s, kept_s = flown(time_s)
        found.append(law.crowded(flat, up, [velocity * taken_s + was * kept_s for velocity, was in zip(wanted, own)]) * 0.5)
    ahead, right = camera.heading(*wanted[:2])
    blind = (abs(right) - ahead - law.BLIND_MPS).least(0)
    found += [blind * blind * 0.1, blind * 0.3]
    at = lambda time_s: [place[0] + speed[0] * time_s, place[1] + speed[1] * time_s, place[2]]
    drawn = [(law.hidden(flat, up, at(time_s)), weight) for time_s, weight in law.SOON + law.LATER]
    walls = [law.hidden(flat, up, at(time_s), *WALLS_M) for time_s, _ in law.SOON]
    for (time_s, _), (crowns, _), wall in zip(law.SOON, drawn, walls):
        taken_s, kept_s = flown(time_s)
        view = [velocity * taken_s + was * kept_s - there for velocity, was, there in zip(wanted, own, at(time_s))]
        unseen, steepness, distance = law.looked_up(crowns, view)
        found += [unseen, law.looked_up(wall, view)[0]]
        found += [(law.DISTANCE_M[0] - distance).least(0) * 0.2, (distance - law.DISTANCE_M[1]).least(0) * 0.2, distance * 0.05 - 1]
        found += [(law.LOWEST_M - view[2]).least(0) * 0.2, view[2] * 0.05 - 1, steepness.most(4) - 1]
    found += [law.looked_up(crowns, view)[0] for crowns, _ in drawn[2:]]
    goal = law.best_view(drawn, own, place, speed)
    found.append(length(*(view[axis] - goal[axis] for axis in range(3))) * 0.1 - 1)
    found.append(graph.of(rise * 0.5))
    moment = [age.most(6) * 0.3, known, length(speed[0], speed[1]) * 0.5, length(own[0], own[1]) * 0.3, own[2] * 0.3]
    moment += [length(*place) * 0.05 - 1, place[2] * 0.05 + 1]
    return joined(*found, *(each * np.ones((len(CHOICES), 1), np.float32) for each in moment), axis=1)


def seen_by(graph, names):
    """Camera, own velocity, the target's place and velocity, and the numbers of all velocities; the graph gives what is kept, too."""
    depth, mask, odometry, memory, points = (Value(graph, name) for name in names)
    camera, own = law.Camera(odometry), [odometry[axis] for axis in range(3, 6)]
    place, speed, age, known = law.tracked(camera, own, depth, mask, memory)
    count = memory[8] + 1
    tick = (count - (law.EVERY - 1)).within(0, 1)
    flat, up, kept = law.surroundings(camera, own, depth, points, tick)
    graph.node("Identity", joined(*place, *speed, age, known, count * (1 - tick)), name="memory_out")
    graph.node("Identity", kept, name="points_out")
    return camera, own, place, speed, known, lambda: terms(camera, flat, up, own, place, speed, age, known)


def model(graph, gives):
    told = lambda shapes: [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape) for name, shape in shapes.items()]
    gives = {**gives, **{f"{name}_out": shape for name, shape in STATES.items()}}
    made = helper.make_graph(graph.nodes, "follow_depth", told(SEEN | STATES), told(gives), graph.constants)
    return helper.make_model(made, opset_imports=[helper.make_opsetid("", 17)], ir_version=8, producer_name="cosfly")


def write(weights, path):
    """The policy as a file in ONNX."""
    graph = Graph()
    camera, own, place, speed, known, numbers = seen_by(graph, [*SEEN, *STATES])
    first, first_bias, second, second_bias, last, straight = weights
    found, tanh = numbers(), lambda value: graph.node("Tanh", value)
    layer = tanh(tanh(found @ first + first_bias.reshape(1, -1)) @ second + second_bias.reshape(1, -1))
    good = layer @ last + found @ straight
    x, y, rise = (((good.shaped(1, len(CHOICES)).softmax() @ CHOICES).shaped(3))[axis] for axis in range(3))
    x, y = x + speed[0], y + speed[1]
    actions = joined(*camera.heading(x, y), rise, *law.turned(camera, own, place, speed)) * known
    graph.node("Reshape", actions, np.array([1, 5]), name="actions")
    onnx.save(model(graph, {"actions": [1, 5]}), path)
    cosfly.onnx.describe(path, inputs={name: name for name in SEEN}, output="actions", states={name: f"{name}_out" for name in STATES})


class Eyes:
    """What the policy sees in recorded flights, step by step, on one processor."""

    def __init__(self):
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        self.runs = []
        for is_whole in (False, True):
            graph = Graph()
            camera, _, _, speed, _, numbers = seen_by(graph, [*SEEN, *STATES])
            gives = {}
            if is_whole:
                graph.node("Identity", numbers(), name="terms")
                graph.node("Identity", joined(*speed, camera.x, camera.y), name="base")
                gives = {"terms": None, "base": [5]}
            self.runs.append(onnxruntime.InferenceSession(model(graph, gives).SerializeToString(), options))

    def flight(self, stem):
        """Numbers of all velocities, and the axes of actions, of every third step: (147, 34), (5,)."""
        seen = {name: np.load(f"{stem}.{name}.npy").astype(np.float32) for name in SEEN}
        kept = {name: np.zeros(shape, np.float32) for name, shape in STATES.items()}
        for step in range(len(seen["odometry"])):
            at_step = {name: of[step] for name, of in seen.items()}
            *found, memory, points = self.runs[step % EVERY == 0].run(None, {**at_step, **kept})
            kept = {"memory": memory, "points": points}
            if found:
                yield found


def relative(action, base):
    """An action's velocity along the world's axes, against the target, m/s."""
    ahead, right, rise = action[:3]
    x, y = ahead * base[3] - right * base[4], ahead * base[4] + right * base[3]
    return [x - base[0], y - base[1], rise]


def examples(version, eyes):
    """Numbers and wanted velocities of the flights of a version, whose pictures are removed."""
    found, wanted = [], []
    for episode in sorted(version.glob("rounds/*/*.jsonl")):
        labels = [json.loads(line) for line in episode.read_text().splitlines()][::EVERY]
        for label, (numbers, base) in zip(labels, eyes.flight(str(episode).removesuffix(".jsonl"))):
            flown = np.array(relative(label["action"], base), np.float32)
            if label["expert_action"] is not None:
                experts = np.clip(np.array(relative(label["expert_action"], base), np.float32), -MOST_MPS, MOST_MPS)
                flown = (1 - EXPERTS_SHARE) * flown + EXPERTS_SHARE * experts
            found.append(numbers.astype(np.float16))
            wanted.append(flown)
    for pictures in [*version.glob("rounds/*/*.npy"), *(version / f"{name}.npy" for name in SEEN)]:
        pictures.unlink(missing_ok=True)
    return np.array(found), np.array(wanted, np.float32)


def fitted(found, wanted, seed):
    """Weights of the network, by Adam and the loss of Huber on the mean velocity, in which good ones count most."""
    random, count = np.random.default_rng(seed), found.shape[-1]
    draw = lambda deviation, *shape: random.normal(0, deviation, shape)
    weights = [draw(count**-0.5, count, WIDE), np.zeros(WIDE), draw(WIDE**-0.5, WIDE, NARROW), np.zeros(NARROW), draw(0.3, NARROW, 1), np.zeros((count, 1))]
    weights = [it.astype(np.float32) for it in weights]
    mean, square, steps = [np.zeros_like(w) for w in weights], [np.zeros_like(w) for w in weights], 0
    for epoch in range(EPOCHS):
        rate, order = RATE * (1 - epoch / EPOCHS), random.permutation(len(found))
        for start in range(0, len(found), BATCH):
            rows = order[start : start + BATCH]
            seen = found[rows].astype(np.float32)
            first = np.tanh(seen @ weights[0] + weights[1])
            second = np.tanh(first @ weights[2] + weights[3])
            good = (second @ weights[4] + seen @ weights[5])[..., 0]
            shares = np.exp(good - good.max(axis=1, keepdims=True))
            shares /= shares.sum(axis=1, keepdims=True)
            back = np.clip(shares @ CHOICES - wanted[rows], -0.5, 0.5) / len(rows) @ CHOICES.T
            back = (shares * (back - (shares * back).sum(axis=1, keepdims=True))).reshape(-1, 1)
            seen, first, second = (it.reshape(-1, it.shape[-1]) for it in (seen, first, second))
            back2 = (back @ weights[4].T) * (1 - second**2)
            back1 = (back2 @ weights[2].T) * (1 - first**2)
            slopes = [seen.T @ back1, back1.sum(0), first.T @ back2, back2.sum(0), second.T @ back, seen.T @ back]
            steps += 1
            for w, slope, m, s in zip(weights, slopes, mean, square):
                m += np.float32(0.1) * (slope - m)
                s += np.float32(0.001) * (slope**2 - s)
                w -= np.float32(rate) * (m / np.float32(1 - 0.9**steps)) / (np.sqrt(s / np.float32(1 - 0.999**steps)) + np.float32(1e-8))
    return weights


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    given = tools.flown_anew(parser, SUITES)
    store, began, eyes, parts = ["--store", given.store] if given.store else [], time.time(), Eyes(), []
    policy = ["--policy", f"onnx:{HERE.parent / 'policies/follow_law.onnx'}", "--expert-share", "0", "--round", "law"]
    keep = ["--keep", ",".join(SEEN), "--size-px", SIZE_PX]
    for suite in given.suites:
        version = given.work / suite
        recipe = ["dagger", HERE.parent / f"suites/{suite}.toml", "--set", f"seed={given.seed}"]
        tools.cosfly([given.cosfly, *recipe, *policy, *keep, "--out", version, *store], stdout=subprocess.DEVNULL)
        parts.append(examples(version, eyes))
        print(f"{suite}: {len(parts[-1][0])} labels, {time.time() - began:.0f} s", flush=True)
    given.out.parent.mkdir(parents=True, exist_ok=True)
    for eighths, out in [(8, given.out), *((count, given.work / f"eighths_{count}.onnx") for count in (4, 2, 1))]:
        first = [[of[: len(of) * eighths // 8] for of in part] for part in parts]
        found, wanted = (np.concatenate(part) for part in zip(*first))
        write(fitted(found, wanted, given.seed), out)
        print(f"{out}: from {len(found)} labels, {time.time() - began:.0f} s", flush=True)


if __name__ == "__main__":
    tools.script(main)
