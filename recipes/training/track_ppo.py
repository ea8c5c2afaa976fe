#!/usr/bin/env python3
"""Trains a small network to follow a person from depth pictures, and compares it: first it imitates the expert where its own flights lead
(`--warm`, a share of the time), then proximal policy optimisation (PPO) goes on from there.

    pip install ".[gym,jax]"      # in a clone
    python recipes/training/track_ppo.py recipes/suites/street.toml --minutes 15

The network sees depth and the target's mask at 84 pixels, scaled down to 21 by their means, where in the picture the target was last seen and
how long ago, and the drone's own motion; it is told nothing of where the target is. The expert's actions are used while it imitates, never
by the network that is judged. `--warm 0` is PPO alone. Actions are the five of `cosfly/Track-v0`. At the end the tracking rate (share of steps in which the
target is tracked, over whole episodes) of the network stands beside that of random actions and of flying on at the first velocity.
"""

import argparse
import functools
import time

import tools

tools.need("numpy", "gymnasium", "jax", "cosfly")
import gymnasium as gym
import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.vector import AutoresetMode

import cosfly.gym  # noqa: F401 (registers the environments)

SIZE, STEPS, EPOCHS, BATCHES, HIDDEN = 84, 64, 4, 4, 128
DISCOUNT, TRACE, CLIP, ENTROPY, RATE = 0.97, 0.9, 0.2, 2e-3, 5e-4
SCALE = np.array([6, 6, 3, 30, 45], np.float32)
OWN = slice(6, 14)
# Earlier rounds of labels that are kept.
LABELS = 24


def environments(recipe, count, expert=False):
    return gym.make_vec(
        "cosfly/Track-v0", num_envs=count, vectorization_mode="vector_entry_point", recipe=recipe,
        obs=("state", "depth", "mask"), size=SIZE, autoreset_mode=AutoresetMode.SAME_STEP, expert_action=expert,
    )  # fmt: skip


class Sight:
    """Numbers that the network sees: small pictures, where the mask's middle is and last was, and the drone's own motion."""

    def __init__(self, count):
        self.last, self.age = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)

    def of(self, observations, began=None):
        """`began` tells in which environments an episode has just begun."""
        if began is not None:
            self.last[began], self.age[began] = 0, 0
        small = [observations[name].reshape(-1, 21, 4, 21, 4).mean((2, 4)) for name in ("depth", "mask")]
        depth, mask = 1 - np.minimum(small[0] / 60, 1), small[1]
        grid = np.linspace(-1, 1, 21, dtype=np.float32)
        mass = mask.sum((1, 2))
        whole = np.maximum(mass, 1e-6)
        away = (mask * small[0]).sum((1, 2)) / whole / 30
        here = np.stack([(mask.sum(1) * grid).sum(1) / whole, (mask.sum(2) * grid).sum(1) / whole, away], 1)
        is_seen = mass > 0
        self.last[is_seen] = here[is_seen]
        self.age = np.where(is_seen, 0, np.minimum(self.age + 0.05, 1)).astype(np.float32)
        own = observations["state"][:, OWN] / np.array([6, 6, 6, 6, 6, 6, 57, 30], np.float32)
        few = np.concatenate([self.last, np.stack([self.age, np.minimum(mass, 1), is_seen], 1)], 1)
        return np.concatenate([few, own, depth.reshape(len(own), -1) * 0.2], 1).astype(np.float32)


def fresh(key, sizes, last):
    layers = []
    for number, (a, b) in enumerate(zip(sizes, sizes[1:])):
        key, own = jax.random.split(key)
        gain = last if number == len(sizes) - 2 else 1.0
        layers.append((gain * jax.random.normal(own, (a, b)) / np.sqrt(a), jnp.zeros(b)))
    return layers


def answer(layers, x):
    for weights, bias in layers[:-1]:
        x = jnp.tanh(x @ weights + bias)
    return x @ layers[-1][0] + layers[-1][1]


@jax.jit
def act(network, x, key):
    mean = answer(network["policy"], x)
    noise = jax.random.normal(key, mean.shape)
    chance = -0.5 * (noise**2).sum(1) - network["log_std"].sum()
    return mean + jnp.exp(network["log_std"]) * noise, chance, answer(network["value"], x)[:, 0], mean


def loss(network, x, action, chance, advantage, wanted):
    mean = answer(network["policy"], x)
    now = -0.5 * (((action - mean) / jnp.exp(network["log_std"])) ** 2).sum(1) - network["log_std"].sum()
    ratio = jnp.exp(now - chance)
    gain = jnp.minimum(ratio * advantage, jnp.clip(ratio, 1 - CLIP, 1 + CLIP) * advantage).mean()
    return -gain + 0.5 * ((answer(network["value"], x)[:, 0] - wanted) ** 2).mean() - ENTROPY * network["log_std"].sum()


def imitation(network, x, expert, wanted):
    value = answer(network["value"], x)[:, 0]
    return ((answer(network["policy"], x) - expert) ** 2).mean() + 0.1 * ((value - wanted) ** 2).mean()


@functools.partial(jax.jit, static_argnums=0)
def update(loss, network, first, second, step, left, *batch):
    slopes = jax.grad(loss)(network, *batch)
    first = jax.tree.map(lambda m, g: 0.9 * m + 0.1 * g, first, slopes)
    second = jax.tree.map(lambda v, g: 0.999 * v + 0.001 * g * g, second, slopes)
    rate = RATE * left * jnp.sqrt(1 - 0.999**step) / (1 - 0.9**step)
    network = jax.tree.map(lambda p, m, v: p - rate * m / (jnp.sqrt(v) + 1e-8), network, first, second)
    return network, first, second


def judge(recipe, policy, episodes=24):
    """Mean share of steps in which the target is tracked; steps that an early end leaves out count as not tracked."""
    envs = environments(recipe, episodes)
    observations, info = envs.reset(seed=1000)
    tracked, alive, steps = np.zeros(episodes), np.ones(episodes, bool), 0
    ends = []
    while alive.any() and steps < 3000:
        observations, _, terminated, truncated, info = envs.step(policy(observations, steps))
        steps += 1
        tracked += alive & info["tracked"]
        ends += [steps] * int((alive & truncated).sum())
        alive &= ~(terminated | truncated)
    return tracked.sum() / (episodes * max(ends, default=steps))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("recipe")
    options.add_argument("--minutes", type=float, default=15)
    options.add_argument("--envs", type=tools.counted, default=32)
    options.add_argument("--warm", type=float, default=0.4, help="share of the time that imitates the expert, 0 to 1")
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    envs, sight = environments(given.recipe, given.envs, expert=True), Sight(given.envs)
    observations, info = envs.reset(seed=given.seed)
    x = sight.of(observations)
    key = jax.random.key(given.seed)
    key, a, b = jax.random.split(key, 3)
    network = {
        "policy": fresh(a, [x.shape[1], HIDDEN, HIDDEN, 5], 0.01),
        "value": fresh(b, [x.shape[1], HIDDEN, HIDDEN, 1], 1.0),
        "log_std": jnp.full(5, -1.0),
    }
    first, second = jax.tree.map(jnp.zeros_like, network), jax.tree.map(jnp.zeros_like, network)
    began, updates, rounds = time.monotonic(), 0, 0
    shuffle = np.random.default_rng(given.seed)
    best, recent, labels, kind = (0.0, network), [], [], None
    while (left := 1 - (time.monotonic() - began) / (60 * given.minutes)) > 0:
        rows, tracked = [], []
        is_warm = 1 - left < given.warm
        # The expert flies some of the environments at first, so that there is something to see.
        led = shuffle.random(given.envs) < (1 - (1 - left) / max(0.5 * given.warm, 1e-9) if is_warm else -1)
        for _ in range(STEPS):
            key, own = jax.random.split(key)
            action, chance, value, _ = map(np.asarray, act(network, x, own))
            expert = np.clip(info["expert_action"] / SCALE, -1.5, 1.5)
            flown = np.where(led[:, None], expert, np.clip(action, -1.5, 1.5)) * SCALE
            observations, reward, terminated, truncated, info = envs.step(flown)
            rows.append((x, action, chance, value, reward / 5, terminated | truncated, expert))
            tracked.append(info["tracked"])
            x = sight.of(observations, terminated | truncated)
        xs, actions, chances, values, rewards, ends, experts = map(np.stack, zip(*rows))
        key, own = jax.random.split(key)
        following = np.asarray(act(network, x, own)[2])
        advantages, trace = np.zeros_like(values), 0.0
        for step in reversed(range(STEPS)):
            goes_on = 1.0 - ends[step]
            trace = rewards[step] + DISCOUNT * following * goes_on - values[step] + DISCOUNT * TRACE * goes_on * trace
            advantages[step], following = trace, values[step]
        wanted = (advantages + values).reshape(-1)
        flat = (advantages - advantages.mean()) / (advantages.std() + 1e-6)
        flat_x = xs.reshape(-1, xs.shape[2])
        if is_warm:
            # Labels of all rounds, not of the last one alone.
            labels = [*labels[-LABELS:], (flat_x, experts.reshape(-1, 5), wanted)]
            data, objective, epochs = tuple(map(np.concatenate, zip(*labels))), imitation, 1
        else:
            data = (flat_x, actions.reshape(-1, 5), chances.reshape(-1), flat.reshape(-1), wanted)
            objective, epochs = loss, EPOCHS
        if kind != objective:
            # Momentum of another objective is of no use.
            first, second = jax.tree.map(jnp.zeros_like, network), jax.tree.map(jnp.zeros_like, network)
            updates, recent, kind = 0, [], objective
        size = len(flat_x) // BATCHES
        for _ in range(epochs):
            order = shuffle.permutation(len(data[0]))
            for part in (order[start : start + size] for start in range(0, len(order) - size + 1, size)):
                updates += 1
                network, first, second = update(objective, network, first, second, updates, left, *(values[part] for values in data))
        rounds += 1
        recent = [*recent[-9:], np.mean(tracked)]
        if len(recent) == 10 and not led.any() and np.mean(recent) > best[0]:
            best = np.mean(recent), network
        if rounds % 10 == 0:
            minutes, steps = (time.monotonic() - began) / 60, rounds * STEPS * given.envs
            name = "imitation" if is_warm else "PPO"
            print(f"{minutes:5.1f} min {steps:8d} steps: {name}, tracked {np.mean(recent):.3f}, reward {rewards.mean() * 5:.3f}", flush=True)
    network = best[1] if best[0] > 0 else network
    noise = np.random.default_rng(7)
    held = {}

    def flying_on(observations, step):
        if step == 0:
            held["velocity"] = observations["state"][:, 3:6]
        return np.concatenate([held["velocity"], np.zeros_like(observations["state"][:, :2])], 1)

    watch = {}

    def by_the_network(observations, step):
        if step == 0:
            watch["sight"] = Sight(len(observations["state"]))
        return np.clip(np.asarray(act(network, watch["sight"].of(observations), key)[3]), -1.5, 1.5) * SCALE

    policies = {
        "network": by_the_network,
        "random": lambda observations, _: noise.uniform(-1, 1, (len(observations["state"]), 5)).astype(np.float32) * SCALE,
        "constant velocity": flying_on,
    }
    for name, policy in policies.items():
        print(f"{name}: tracking rate {judge(given.recipe, policy):.3f}", flush=True)


if __name__ == "__main__":
    tools.script(main)
