"""Several drones behind one target for pettingzoo: `cosfly.parallel_env("recipes/suites/street.toml", num_drones=3)`.

The drones fly the same episode at the same time: the first from the episode's start, the others from places turned around the
target. They can hit each other. An observation is what `cosfly/Track-v0` gives; its state goes on after the 16 numbers with seven on
each other drone: whether it flies, its place from the drone (m) and its velocity (m/s), both ahead, right, up. A drone whose episode
is over leaves; the others fly on.
"""

from __future__ import annotations

import operator
import os
from copy import deepcopy
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from pettingzoo import ParallelEnv

from ._env_config import EnvConfig
from ._errors import InvalidValue, keys_of
from .gym import _begin, _flock, _is_info, _rows, _seed, _Streams, action_space

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._env_config import EnvOptions

_OTHER = 7


class ParallelTrack(ParallelEnv):  # type: ignore[misc]
    """Drones that follow one person or vehicle together."""

    metadata: dict[str, Any] = {"name": "cosfly_track_v0", "render_modes": [], "is_parallelizable": True}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        num_drones: int = 2,
        **options: Unpack[EnvOptions],
    ) -> None:
        if isinstance(num_drones, bool) or not 1 <= operator.index(num_drones) <= 64:
            raise InvalidValue(f"num_drones is {num_drones}; it is 1 to 64")
        config = EnvConfig.of(recipe, options)
        self._flock, self._observations = _flock(config, num_drones, AutoresetMode.DISABLED, is_team=True)
        self.render_mode = None
        self.possible_agents = [f"drone_{number}" for number in range(num_drones)]
        self.agents: list[str] = []
        self._numbers = {agent: number for number, agent in enumerate(self.possible_agents)}
        state = spaces.Box(-np.inf, np.inf, (16 + _OTHER * (num_drones - 1),), np.float32)
        # Spaces draw samples from seeds of their own: none is shared.
        self.observation_spaces = {agent: self._observations.space(deepcopy(state)) for agent in self.possible_agents}
        self.action_spaces = {agent: action_space() for agent in self.possible_agents}
        self._streams, self._is_reset = _Streams(1), False

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Begins an episode with all drones: one that the seed draws, or `options={"episode": NAME}`. Without a seed, one of the
        system's entropy draws; `np_random_seed` and the infos tell it."""
        # The interface's own test gives keys that no environment has, and wants them to do nothing.
        episode = keys_of("`options`", options, ("episode",), strangers=True).get("episode")
        begun = self._streams.begin([_seed(seed)], [True]) + [None] * (len(self.possible_agents) - 1)
        if episode is None:
            self._flock.reset(begun, None)
        else:
            self._flock.seed(begun)
            _begin(self._flock, episode)
        self._is_reset = True
        self.agents = list(self.possible_agents)
        told = self._told()
        observations = {agent: self._observations.of(told, number=self._numbers[agent]) for agent in self.agents}
        return observations, {agent: {**self._info(told, agent), "seed": self.np_random_seed} for agent in self.agents}

    @property
    def np_random_seed(self) -> int | None:
        """The seed that draws the episodes, given or drawn; None before the first reset."""
        return self._streams.seeds[0]

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        if not self._is_reset:
            raise ResetNeeded("reset() begins an episode before the first step()")
        flying = list(self.agents)
        missing, unknown = [it for it in flying if it not in actions], [it for it in actions if it not in self._numbers]
        if missing or unknown:
            raise InvalidValue(f"actions are of {sorted(map(str, actions))}; they are of the drones that fly: {flying}")
        rows = np.zeros((len(self.possible_agents), 5), dtype=np.float64)
        for agent in flying:
            try:
                rows[self._numbers[agent]] = _rows(actions[agent], (5,))
            except ValueError as error:
                raise InvalidValue(f"{agent}: {error}") from None
        self._flock.step(rows)
        told = self._told()
        number = self._numbers
        observations = {agent: self._observations.of(told, number=number[agent]) for agent in flying}
        rewards = {agent: float(told["rewards"][number[agent]]) for agent in flying}
        terminated = {agent: bool(told["terminated"][number[agent]]) for agent in flying}
        truncated = {agent: bool(told["truncated"][number[agent]]) for agent in flying}
        self.agents = [agent for agent in flying if not (terminated[agent] or truncated[agent])]
        return observations, rewards, terminated, truncated, {agent: self._info(told, agent) for agent in flying}

    def episodes(self) -> list[str]:
        """Names of all episodes; `reset(options={"episode": NAME})` begins one of them."""
        return self._flock.episodes()

    def render(self) -> None:
        """There is nothing to see: `obs` has the pictures."""

    def close(self) -> None:
        """Nothing is left open."""

    def _told(self) -> dict[str, Any]:
        told = self._flock.outputs(True)
        told["features"] = np.concatenate([told["features"], told.pop("beside")], axis=1)
        return told

    def _info(self, told: dict[str, Any], agent: str) -> dict[str, Any]:
        number = self._numbers[agent]
        info = {name: values[number] for name, values in told.items() if _is_info(name)}
        info["episode"] = self._flock.episode(number)
        return info
