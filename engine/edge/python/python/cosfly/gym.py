"""Environments for gymnasium: `gym.make_vec("cosfly/Track-v0", num_envs=64, recipe="recipes/suites/street.toml")`, once this is imported.

An environment flies the episodes of a recipe, as `cosfly fly` does; each draws its episodes from a seed of its own: the one that is
given, else one of the system's entropy, which `info["seed"]` and `np_random_seed` tell so that a run can be repeated.
Observations are 16 numbers (`obs=("state",)`), pictures (the names in `CHANNELS`, which tells the meaning of each), readings of sensors
(the names in `SENSORS`), or several of them as a dictionary. Actions are five numbers: velocity ahead, right, up (m/s), pitch rate, yaw
rate (degrees/s). `STATE` and `ACTION` name the numbers with their units. The book's page "Policies of fly" defines them, its page "Results of fly" the terms of the reward, which
`info` has as `reward_...`.
"""

from __future__ import annotations

import difflib
import operator
import os
import secrets
from typing import TYPE_CHECKING, Any, Sequence

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.envs.registration import register, registry
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from . import _cosfly
from ._cosfly import VectorEnvironment
from ._env_config import CHANNELS, OBSERVATIONS, SENSORS, EnvConfig
from ._errors import InvalidValue, WrongType, keys_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._env_config import EnvOptions

ID = "cosfly/Track-v0"
STATE: tuple[str, ...] = tuple(_cosfly.STATE)
"""Names of the numbers of `state`, each with its unit; vectors are along the heading of the camera."""
ACTION: tuple[str, ...] = tuple(_cosfly.ACTION)
"""Names of the numbers of an action, each with its unit."""

_LARGEST = (12, 12, 12, 60, 60)
_MODES = {
    AutoresetMode.NEXT_STEP: "next_step",
    AutoresetMode.SAME_STEP: "same_step",
    AutoresetMode.DISABLED: "disabled",
}
_MOST_ENVIRONMENTS = 65536


def action_space() -> spaces.Box:
    """Velocities (m/s) and rates (degrees/s), in a space of its own: copies of a space draw the same samples."""
    largest = np.array(_LARGEST, dtype=np.float32)
    return spaces.Box(-largest, largest, dtype=np.float32)


def _rows(actions: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Actions as numbers of a shape; everything else is refused. The flock looks at the numbers themselves."""
    try:
        rows = np.asarray(actions)
    except Exception as error:
        raise InvalidValue(f"actions are no array of numbers: {error}") from error
    if rows.dtype.kind not in "fiu":
        raise InvalidValue(f"actions are of type {rows.dtype}; they are numbers, such as float32")
    if rows.shape != shape:
        raise InvalidValue(f"actions have the shape {rows.shape}; it is {shape}")
    return np.ascontiguousarray(rows, dtype=np.float32 if rows.dtype == np.float32 else np.float64)


def _seed(seed: Any) -> int | None:
    """A seed of an environment; None where none is given."""
    if seed is None:
        return None
    if isinstance(seed, (bool, np.bool_)) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise InvalidValue(f"a seed is {seed!r}; it is a whole number from 0 on")
    return int(seed) % 2**64


class _Streams:
    """Seeds of the streams that environments draw their episodes from."""

    def __init__(self, count: int) -> None:
        self.seeds: list[int | None] = [None] * count
        self.drawn: int | None = None
        """The seed that was drawn last; environment number n has n more."""

    def begin(self, given: Sequence[int | None], chosen: Sequence[bool], entropy: int | None = None) -> list[int | None]:
        """Seeds with which the streams of the chosen environments begin anew; None for those that go on. An environment that has
        never had a seed gets one from `entropy`, or from the system."""
        begun: list[int | None] = [None] * len(self.seeds)
        is_new = [on and seed is None and known is None for on, seed, known in zip(chosen, given, self.seeds)]
        if any(is_new):
            self.drawn = secrets.randbits(62) if entropy is None else entropy
        for number, on in enumerate(chosen):
            seed = (self.drawn + number) % 2**64 if is_new[number] and self.drawn is not None else given[number]
            if on and seed is not None:
                begun[number] = self.seeds[number] = seed
        return begun


class _Observations:
    """Observations of a configuration: their space, and their values in what a flock tells."""

    def __init__(self, config: EnvConfig) -> None:
        self.names, self.size, self.max_depth_m = tuple(config.obs), config.sides, config.max_depth_m

    def space(self, state: spaces.Space[Any] | None = None) -> spaces.Space[Any]:
        width, height = self.size

        def of(name: str) -> spaces.Space[Any]:
            if name == "state":
                return state or spaces.Box(-np.inf, np.inf, (16,), np.float32)
            if name in SENSORS:
                return spaces.Box(-np.inf, np.inf, (len(SENSORS[name].quantities),), np.float32)
            channel = CHANNELS[name]
            greatest = self.max_depth_m if channel.greatest is None else channel.greatest
            shape = (height, width) if channel.values == 1 else (height, width, channel.values)
            kind: Any = np.dtype(channel.dtype).type
            return spaces.Box(kind(channel.least), kind(greatest), shape, kind)

        return of(self.names[0]) if len(self.names) == 1 else spaces.Dict({name: of(name) for name in self.names})

    def of(self, told: dict[str, Any], prefix: str = "", number: int | None = None, copy: bool = False) -> Any:
        """The observations in what a flock tells: of all environments, or of one."""

        def value(name: str) -> Any:
            values = told[prefix + ("features" if name == "state" else name)]
            values = values if number is None else values[number]
            return values.copy() if copy else values

        return value(self.names[0]) if len(self.names) == 1 else {name: value(name) for name in self.names}


def _flock(
    config: EnvConfig, count: int, mode: AutoresetMode, is_team: bool = False
) -> tuple[VectorEnvironment, _Observations]:
    return VectorEnvironment(config, count, _MODES[mode], is_team), _Observations(config)


def _begin(flock: VectorEnvironment, episode: Any) -> None:
    """Begins an episode by its name."""
    if not isinstance(episode, str):
        raise WrongType(f"the episode is {episode!r:.60} ({type(episode).__name__}); it is a name, such as {flock.episodes()[0]!r}")
    if episode not in (known := flock.episodes()):
        near = difflib.get_close_matches(episode, known, 3) or known[:3]
        raise InvalidValue(f"there is no episode {episode!r}; there are {', '.join(near)}{' ...' if len(near) < len(known) else ''}")
    flock.begin_episode(0, episode)


_NOT_INFO = {"features", "rewards", "terminated", "truncated", *OBSERVATIONS}


def _is_info(name: str) -> bool:
    return name not in _NOT_INFO and not name.startswith("last_")


class TrackVector(VectorEnv):
    """Many drones that each follow a person or vehicle; one call steps all of them with the GIL released."""

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        num_envs: int = 1,
        *,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        **options: Unpack[EnvOptions],
    ) -> None:
        """Environments over the episodes of a recipe. With ``copy=False`` every reset and step fills and gives the same arrays: keep
        what is needed of them before the next call."""
        mode = AutoresetMode(autoreset_mode)
        if isinstance(num_envs, bool) or not 1 <= operator.index(num_envs) <= _MOST_ENVIRONMENTS:
            raise InvalidValue(f"num_envs is {num_envs}; it is 1 to {_MOST_ENVIRONMENTS}")
        self.num_envs = num_envs = int(num_envs)
        self.metadata = {**type(self).metadata, "autoreset_mode": mode}
        self._mode = mode
        self._flock, self._observations = _flock(EnvConfig.of(recipe, options), num_envs, mode)
        self.single_observation_space, self.single_action_space = self._observations.space(), action_space()
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(action_space(), num_envs)
        self._streams, self._is_reset = _Streams(num_envs), False
        self._copy, self._kept = bool(copy), None

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        is_single = "episode" in (options or {})  # of one environment: many take none
        chosen = self._chosen(keys_of("`options` of many environments", options, ("reset_mask",), not is_single).get("reset_mask"))
        seeds: list[int | None]
        if seed is None:
            seeds = [None] * self.num_envs
        elif isinstance(seed, (int, np.integer)):
            first = _seed(seed)
            seeds = [_seed(int(seed) + number) for number in range(self.num_envs)]
            self._np_random, self._np_random_seed = seeding.np_random(first)
        else:
            seeds = [_seed(one) for one in seed]
        if len(seeds) != self.num_envs:
            raise InvalidValue(f"{len(seeds)} seeds for {self.num_envs} environments")
        if not self._is_reset and not all(chosen):
            raise ResetNeeded("the first reset is of all environments: leave reset_mask out")
        drawn = self._streams.drawn
        begun = self._streams.begin(seeds, chosen)
        if self._streams.drawn != drawn:
            self._np_random, self._np_random_seed = seeding.np_random(self._streams.drawn)
        self._flock.reset(begun, chosen)
        self._is_reset = True
        told, observations, info = self._told()
        info["seed"], info["_seed"] = np.array(self._streams.seeds, dtype=np.uint64), np.ones(self.num_envs, dtype=bool)
        return observations, info

    def _chosen(self, mask: Any) -> list[bool]:
        if mask is None:
            return [True] * self.num_envs
        chosen = np.asarray(mask)
        if chosen.dtype != np.bool_ or chosen.shape != (self.num_envs,) or not chosen.any():
            raise InvalidValue(
                f"reset_mask is {chosen.dtype} of shape {chosen.shape}; it has a truth value for each of the {self.num_envs} "
                "environments, and one at least is true"
            )
        return [bool(one) for one in chosen]

    def step(self, actions: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        if not self._is_reset:
            raise ResetNeeded("reset() begins the episodes before the first step()")
        self._flock.step(_rows(actions, (self.num_envs, len(_LARGEST))))
        told, observations, info = self._told()
        if self._mode == AutoresetMode.SAME_STEP:
            ended = told["terminated"] | told["truncated"]
            if ended.any():
                final = np.empty(self.num_envs, dtype=object)
                for number in np.flatnonzero(ended):
                    final[number] = self._observations.of(told, "last_", number, copy=not self._copy)
                info["final_obs"], info["_final_obs"] = final, ended
        return observations, told["rewards"], told["terminated"], told["truncated"], info

    def _told(self) -> tuple[dict[str, Any], Any, dict[str, Any]]:
        """What the flock tells, the observations in it, and the infos in a dictionary of their own."""
        told = self._flock.outputs(self._copy)
        if self._copy:
            return told, self._observations.of(told), self._info(told)
        if self._kept is None:  # the arrays stay the same
            self._kept = self._observations.of(told), self._info(told)
        observations, info = self._kept
        return told, observations, dict(info)

    def _info(self, told: dict[str, Any]) -> dict[str, Any]:
        info: dict[str, Any] = {}
        for name, values in told.items():
            if _is_info(name):
                info[name], info[f"_{name}"] = values, np.ones(self.num_envs, dtype=bool)
        return info

    def episode(self, number: int) -> str:
        """Name of the episode that an environment flies."""
        return self._flock.episode(number)

    @property
    def shared_s(self) -> float:
        """Seconds that all calls so far spent in work that is shared between the threads."""
        return self._flock.shared_s()


class Track(gymnasium.Env):
    """A drone that follows a person or vehicle."""

    metadata = {"render_modes": []}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        **options: Unpack[EnvOptions],
    ) -> None:
        config = EnvConfig.of(recipe, options)
        self._flock, self._observations = _flock(config, 1, AutoresetMode.DISABLED)
        self.observation_space, self.action_space = self._observations.space(), action_space()
        self._streams, self._is_reset = _Streams(1), False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        # Harnesses give keys of their own, as LeRobot does.
        episode = keys_of("`options`", options, ("episode",), strangers=True).get("episode")
        super().reset(seed=seed)
        # `np_random` that was used before has drawn a seed already.
        known = self._np_random_seed
        entropy = None if known is None or known < 0 else _seed(known)
        begun = self._streams.begin([_seed(seed)], [True], entropy)
        if self._np_random_seed is None:
            self._np_random, self._np_random_seed = seeding.np_random(self._streams.drawn)
        if episode is None:
            self._flock.reset(begun, [True])
        else:
            self._flock.seed(begun)
            _begin(self._flock, episode)
        self._is_reset = True
        told = self._flock.outputs(True)
        info = self._info(told)
        known = self._streams.seeds[0]
        if known is not None and known < 2**63:  # what arrays of infos hold
            info["seed"] = known
        return self._observations.of(told, number=0), info

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if not self._is_reset:
            raise ResetNeeded("reset() begins an episode before the first step()")
        self._flock.step(_rows(action, (len(_LARGEST),)).reshape(1, -1))
        told = self._flock.outputs(True)
        ended = bool(told["terminated"][0]), bool(told["truncated"][0])
        return self._observations.of(told, number=0), float(told["rewards"][0]), *ended, self._info(told)

    def _info(self, told: dict[str, Any]) -> dict[str, Any]:
        info = {name: values[0] for name, values in told.items() if _is_info(name)}
        info["episode"] = self._flock.episode(0)
        return info

    def episodes(self) -> list[str]:
        """Names of all episodes; `reset(options={"episode": NAME})` begins one of them."""
        return self._flock.episodes()

    @property
    def planned_steps(self) -> int:
        """Steps of the whole episode that is flown."""
        return self._flock.planned_steps(0)


if ID not in registry:
    register(id=ID, entry_point="cosfly.gym:Track", vector_entry_point="cosfly.gym:TrackVector")
