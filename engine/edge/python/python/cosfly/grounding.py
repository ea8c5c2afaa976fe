"""A reward for saying where the target is: policies that fly and ground at once, over the environments of `cosfly.gym`.

    envs = GroundedVector(gym.make_vec("cosfly/Track-v0", ..., obs=("rgb", "mask")))

Actions have five more numbers, 0 to 1: left, top, right and bottom edge of the target's box in the picture that the action answers, as
shares of its width and height, and the belief that the target is seen there at all. The reward has one more term, `reward_grounding`
in `info`: where the target is seen, the belief times the overlap of the boxes (intersection over union); elsewhere, one minus the
belief. The mask that tells the truth is no observation, unless `shows_mask` is true.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from gymnasium.vector.utils import batch_space

from ._errors import InvalidValue, number_of

GROUNDING: tuple[str, ...] = ("left", "top", "right", "bottom", "is_seen")
"""Names of the numbers that follow those of `cosfly.gym.ACTION`: edges as shares of the picture, and the belief that it is seen."""


def boxes_of(masks: np.ndarray) -> np.ndarray:
    """Boxes around the pixels of masks (..., height, width) that are not 0: left, top, right, bottom (..., 4), as shares of width and
    height; NaN where there are none. A pixel is as wide as it is: the box of all pixels is (0, 0, 1, 1)."""
    masks = np.asarray(masks) != 0
    height, width = masks.shape[-2:]
    columns, rows = masks.any(-2), masks.any(-1)
    edges = [columns.argmax(-1) / width, rows.argmax(-1) / height]
    edges += [1 - columns[..., ::-1].argmax(-1) / width, 1 - rows[..., ::-1].argmax(-1) / height]
    return np.where(columns.any(-1)[..., None], np.stack(edges, -1), np.nan)


def overlaps(boxes: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Intersection over union of boxes (..., 4); 0 for boxes without an area, and for NaN."""
    boxes, others = np.asarray(boxes, float), np.asarray(others, float)
    sides = np.minimum(boxes[..., 2:], others[..., 2:]) - np.maximum(boxes[..., :2], others[..., :2])
    shared = np.clip(sides, 0, None).prod(-1)
    areas = [np.clip(some[..., 2:] - some[..., :2], 0, None).prod(-1) for some in (boxes, others)]
    union = areas[0] + areas[1] - shared
    return np.divide(shared, union, out=np.zeros(union.shape), where=union > 0)


def grounding_rewards(answers: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Rewards, 0 to 1, of answers (..., 5), in the order of :data:`GROUNDING`, beside the true boxes (..., 4)."""
    belief = np.clip(answers[..., 4], 0, 1)
    return np.where(np.isnan(boxes[..., 0]), 1 - belief, belief * overlaps(answers[..., :4], boxes))


class _Grounding:
    """What both kinds of environments share: spaces, weight, and observations without the mask."""

    def __init__(self, space: spaces.Space[Any], weight: float, shows_mask: bool) -> None:
        if not (isinstance(space, spaces.Dict) and "mask" in space.spaces):
            raise InvalidValue('grounding needs the observation `mask` beside another one, such as `obs=("rgb", "mask")`')
        number_of("weight", weight)
        if not np.isfinite(weight):
            raise InvalidValue(f"weight is {weight}; it is a finite number")
        self.weight = float(weight)
        self.names = [name for name in space.spaces if shows_mask or name != "mask"]
        self.space = self.seen({name: space.spaces[name] for name in self.names}, spaces.Dict)

    def seen(self, observations: dict[str, Any], many: Any = dict) -> Any:
        """The observations of a policy: one alone is its array, several are a dictionary."""
        chosen = {name: observations[name] for name in self.names}
        return many(chosen) if len(chosen) > 1 else next(iter(chosen.values()))

    @staticmethod
    def actions(space: spaces.Box) -> spaces.Box:
        low, high = (np.concatenate([side, np.full(5, end, np.float32)]) for side, end in ((space.low, 0), (space.high, 1)))
        return spaces.Box(low, high, dtype=np.float32)

    @staticmethod
    def parts(actions: Any, shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
        """The action of the drone and the answer of its policy."""
        rows = np.asarray(actions)
        if rows.shape != shape:
            raise InvalidValue(f"actions have the shape {rows.shape}; it is {shape}: {len(GROUNDING)} numbers more than without grounding")
        answers = rows[..., -5:].astype(float)
        if not np.isfinite(answers).all():
            raise InvalidValue("a box or a belief is no finite number; boxes are shares of the picture, from 0 to 1")
        return rows[..., :-5], answers


class GroundedVector(VectorWrapper):
    """Many environments whose policies also say where their targets are. `info` has the true boxes as `target_box`."""

    def __init__(self, env: VectorEnv, weight: float = 1.0, shows_mask: bool = False) -> None:
        super().__init__(env)
        self._grounding = _Grounding(env.single_observation_space, weight, shows_mask)
        self.single_observation_space = self._grounding.space
        self.observation_space = batch_space(self._grounding.space, env.num_envs)
        self.single_action_space = _Grounding.actions(env.single_action_space)
        self.action_space = batch_space(self.single_action_space, env.num_envs)
        self._begins = env.metadata.get("autoreset_mode") == AutoresetMode.NEXT_STEP
        self._ended = np.zeros(env.num_envs, bool)
        self._boxes = np.full((env.num_envs, 4), np.nan)  # a step before the first reset is refused by the environments

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observations, info = self.env.reset(seed=seed, options=options)
        self._ended = np.zeros(self.env.num_envs, bool)
        return self._told(observations, info)

    def step(self, actions: Any) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        flown, answers = self._grounding.parts(actions, self.action_space.shape)
        # Actions after an end are not flown: they begin the next episode.
        grounding = np.where(self._ended, 0.0, grounding_rewards(answers, self._boxes))
        observations, rewards, terminated, truncated, info = self.env.step(flown)
        self._ended = (terminated | truncated) & self._begins
        info["reward_grounding"], info["_reward_grounding"] = grounding, np.ones(len(grounding), bool)
        if "final_obs" in info:
            final = [None if one is None else self._grounding.seen(one) for one in info["final_obs"]]
            info["final_obs"] = np.fromiter(final, object, len(final))
        observations, info = self._told(observations, info)
        return observations, rewards + self._grounding.weight * grounding, terminated, truncated, info

    def _told(self, observations: dict[str, Any], info: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        self._boxes = boxes_of(observations["mask"])
        info["target_box"], info["_target_box"] = self._boxes, np.ones(len(self._boxes), bool)
        return self._grounding.seen(observations), info


class Grounded(gymnasium.Wrapper, RecordConstructorArgs):
    """An environment whose policy also says where its target is. `info` has the true box as `target_box`."""

    def __init__(self, env: gymnasium.Env, weight: float = 1.0, shows_mask: bool = False) -> None:
        RecordConstructorArgs.__init__(self, weight=weight, shows_mask=shows_mask)
        gymnasium.Wrapper.__init__(self, env)
        self._grounding = _Grounding(env.observation_space, weight, shows_mask)
        self.observation_space, self.action_space = self._grounding.space, _Grounding.actions(env.action_space)
        self._box = np.full(4, np.nan)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        return self._told(*self.env.reset(seed=seed, options=options))

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        flown, answer = self._grounding.parts(action, self.action_space.shape)
        grounding = float(grounding_rewards(answer, self._box))
        observation, reward, terminated, truncated, info = self.env.step(flown)
        info["reward_grounding"] = grounding
        observation, info = self._told(observation, info)
        return observation, float(reward) + self._grounding.weight * grounding, terminated, truncated, info

    def _told(self, observation: dict[str, Any], info: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        self._box = info["target_box"] = boxes_of(observation["mask"])
        return self._grounding.seen(observation), info
