"""Environments for gymnasium: `gym.make_vec("cosfly/Track-v0", num_envs=64, recipe="recipes/suites/street.toml")`.

An environment flies the episodes of a recipe, as `cosfly fly` does; each draws its episodes from a seed of its own.
Observations are 16 numbers, actions five: velocity ahead, right, up (m/s), yaw rate, pitch rate (degrees/s). The book's page
"Flying in closed loop" defines them, and the terms of the reward, which `info` has as `reward_...`.
"""

from __future__ import annotations

import os
from typing import Any, Sequence

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from ._cosfly import Flock
from ._gym import register

OBSERVATIONS = gymnasium.spaces.Box(-np.inf, np.inf, (16,), np.float32)
_LARGEST = np.array([12, 12, 12, 60, 60], dtype=np.float32)
ACTIONS = gymnasium.spaces.Box(-_LARGEST, _LARGEST, dtype=np.float32)


def _flock(
    recipe: str | os.PathLike[str],
    count: int,
    mode: AutoresetMode,
    *,
    overrides: Sequence[str],
    store: str | os.PathLike[str] | None,
    obs: Sequence[str],
    step_s: float,
    latency_s: float,
    expert_action: bool,
) -> Flock:
    if tuple(obs) != ("state",):
        raise ValueError(f"obs is {tuple(obs)}; ('state',) is what environments give yet")
    if not 0.01 <= step_s <= 1.0 or not 0.0 <= latency_s <= 5.0:
        raise ValueError(f"step_s is {step_s} (0.01 to 1 s) and latency_s is {latency_s} (0 to 5 s)")
    place = os.fspath(store if store is not None else os.environ.get("COSFLY_STORE") or ".cosfly")
    name = {
        AutoresetMode.NEXT_STEP: "next_step",
        AutoresetMode.SAME_STEP: "same_step",
        AutoresetMode.DISABLED: "disabled",
    }[mode]
    return Flock(os.fspath(recipe), list(overrides), place, count, step_s, latency_s, name, expert_action)


_NOT_INFO = ("features", "last_features", "rewards", "terminated", "truncated")


class TrackVector(VectorEnv):
    """Many drones that each follow a person; one call steps all of them with the GIL released."""

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        num_envs: int = 1,
        *,
        overrides: Sequence[str] = (),
        store: str | os.PathLike[str] | None = None,
        obs: Sequence[str] = ("state",),
        step_s: float = 0.1,
        latency_s: float = 0.0,
        expert_action: bool = False,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
    ) -> None:
        mode = AutoresetMode(autoreset_mode)
        self.num_envs = num_envs
        self.metadata = {**type(self).metadata, "autoreset_mode": mode}
        self.single_observation_space, self.single_action_space = OBSERVATIONS, ACTIONS
        self.observation_space = batch_space(OBSERVATIONS, num_envs)
        self.action_space = batch_space(ACTIONS, num_envs)
        self._mode = mode
        self._flock = _flock(
            recipe, num_envs, mode, overrides=overrides, store=store, obs=obs, step_s=step_s, latency_s=latency_s,
            expert_action=expert_action,
        )

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        seeds: list[int | None]
        if seed is None:
            seeds = [None] * self.num_envs
        elif isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + number for number in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"{len(seeds)} seeds for {self.num_envs} environments")
        mask = (options or {}).get("reset_mask")
        self._flock.reset(seeds, None if mask is None else [bool(chosen) for chosen in mask])
        told = self._flock.outputs()
        return told["features"], self._info(told)

    def step(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        self._flock.step(np.ascontiguousarray(actions, dtype=np.float32))
        told = self._flock.outputs()
        info = self._info(told)
        ended = told["terminated"] | told["truncated"]
        if self._mode == AutoresetMode.SAME_STEP and ended.any():
            final = np.empty(self.num_envs, dtype=object)
            for number in np.flatnonzero(ended):
                final[number] = told["last_features"][number]
            info["final_obs"], info["_final_obs"] = final, ended
        return told["features"], told["rewards"], told["terminated"], told["truncated"], info

    def _info(self, told: dict[str, Any]) -> dict[str, Any]:
        info: dict[str, Any] = {}
        for name, values in told.items():
            if name not in _NOT_INFO:
                info[name], info[f"_{name}"] = values, np.ones(self.num_envs, dtype=bool)
        return info

    def episode(self, number: int) -> str:
        """Name of the episode that an environment flies."""
        return self._flock.episode(number)


class Track(gymnasium.Env):
    """A drone that follows a person."""

    metadata = {"render_modes": []}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        *,
        overrides: Sequence[str] = (),
        store: str | os.PathLike[str] | None = None,
        obs: Sequence[str] = ("state",),
        step_s: float = 0.1,
        latency_s: float = 0.0,
        expert_action: bool = False,
    ) -> None:
        self.observation_space, self.action_space = OBSERVATIONS, ACTIONS
        self._flock = _flock(
            recipe, 1, AutoresetMode.DISABLED, overrides=overrides, store=store, obs=obs, step_s=step_s,
            latency_s=latency_s, expert_action=expert_action,
        )

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        self._flock.reset([seed], None)
        told = self._flock.outputs()
        return told["features"][0], self._info(told)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        self._flock.step(np.asarray(action, dtype=np.float32).reshape(1, -1))
        told = self._flock.outputs()
        ended = bool(told["terminated"][0]), bool(told["truncated"][0])
        return told["features"][0], float(told["rewards"][0]), *ended, self._info(told)

    def _info(self, told: dict[str, Any]) -> dict[str, Any]:
        info = {name: values[0] for name, values in told.items() if name not in _NOT_INFO}
        info["episode"] = self._flock.episode(0)
        return info


register()
