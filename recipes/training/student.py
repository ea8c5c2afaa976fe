"""A small student for `cosfly dagger` and `cosfly fly`: a network of numpy that maps the 16 numbers of a state to an action.

    python student.py train LABELS WEIGHTS     learns from the arrays of a version of labels
    cosfly fly SUITE --policy python:student:act

`act` reads the weights from the file that the variable STUDENT names (default: student.npz).
"""

import os
import sys

import numpy as np

HIDDEN, EPOCHS, BATCH, RATE = 64, 60, 64, 2e-3
SCALE = np.array([6, 6, 3, 60, 60], dtype=np.float32)  # m/s and degrees/s


def features(state):
    """What the network sees: the state in units near 1, the bearing and elevation of the target from the camera's axis."""
    state = np.atleast_2d(state).astype(np.float32)
    ahead, right, up = state[:, 0], state[:, 1], state[:, 2]
    away = np.hypot(ahead, right)
    bearing, elevation = np.arctan2(right, ahead), np.arctan2(up + 1, away)
    view = [4 * bearing, 4 * (elevation - np.radians(state[:, 12])), away / 20 - 1, np.minimum(state[:, 15], 5) / 5]
    scale = np.array([20, 20, 20, 2, 2, 1, 4, 4, 4, 3, 3, 3, 57, 20, 1, 5], dtype=np.float32)
    return np.concatenate([state / scale, np.stack(view, axis=1)], axis=1)


def layers(weights, x):
    """Outputs of all layers."""
    first = np.tanh(x @ weights[0] + weights[1])
    second = np.tanh(first @ weights[2] + weights[3])
    return first, second, second @ weights[4] + weights[5]


def train(labels, path):
    """Learns the expert's actions by Adam; the same arrays give the same weights."""
    x = features(np.load(os.path.join(labels, "states.npy")))
    y = np.clip(np.load(os.path.join(labels, "expert_actions.npy")) / SCALE, -1.5, 1.5)
    random = np.random.default_rng(0)
    sizes = [x.shape[1], HIDDEN, HIDDEN, 5]
    weights = []
    for inputs, outputs in zip(sizes, sizes[1:]):
        weights += [random.normal(0, inputs**-0.5, (inputs, outputs)).astype(np.float32), np.zeros(outputs, np.float32)]
    mean, square = [np.zeros_like(w) for w in weights], [np.zeros_like(w) for w in weights]
    steps = 0
    for epoch in range(EPOCHS):
        rate = RATE * (1 - epoch / EPOCHS)
        order = random.permutation(len(x))
        for start in range(0, len(x), BATCH):
            rows = order[start : start + BATCH]
            first, second, out = layers(weights, x[rows])
            error = np.clip(out - y[rows], -0.5, 0.5) / len(rows)  # Huber's loss
            back2 = (error @ weights[4].T) * (1 - second**2)
            back1 = (back2 @ weights[2].T) * (1 - first**2)
            slopes = [x[rows].T @ back1, back1.sum(0), first.T @ back2, back2.sum(0), second.T @ error, error.sum(0)]
            steps += 1
            for w, slope, m, s in zip(weights, slopes, mean, square):
                m += 0.1 * (slope - m)
                s += 0.001 * (slope**2 - s)
                w -= rate * (m / (1 - 0.9**steps)) / (np.sqrt(s / (1 - 0.999**steps)) + 1e-8)
    np.savez(path, *weights)
    print(f"{path}: {len(x)} labels, mean error {np.abs(layers(weights, x)[2] - y).mean():.4f}")


_weights = None


def act(observation):
    """The action for an observation of `cosfly fly`."""
    global _weights
    if _weights is None:
        stored = np.load(os.environ.get("STUDENT", "student.npz"))
        _weights = [stored[name] for name in stored.files]
    return (layers(_weights, features(observation["state"]))[2] * SCALE)[0]


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] != "train":
        sys.exit(__doc__)
    import tools

    tools.script(lambda: train(sys.argv[2], sys.argv[3]))
