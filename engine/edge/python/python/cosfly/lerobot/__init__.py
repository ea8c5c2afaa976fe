"""An environment for LeRobot: importing this module registers the configuration `cosfly`.

`lerobot-eval --env.discover_packages_path=cosfly.lerobot --env.type=cosfly --env.recipe=recipes/suites/street.toml ...`, or
`lerobot.envs.factory.make_env(CosflyEnv(recipe=...), n_envs=4)`. Observations have `agent_pos` (16 numbers), which
LeRobot calls `observation.state`, and with `size` colours as `pixels`, which LeRobot calls `observation.image`; an action is five
numbers: velocity ahead, right, up (m/s), pitch rate, yaw rate (degrees/s). A package, because LeRobot discovers no modules.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np

from .._outcome import Outcome
from ..gym import Track, action_space

ID = "cosfly/LeRobotTrack-v0"
_RENDERED_SIZE = 128
PROMPT = "Follow the target and keep it in view."


class LeRobotTrack(gymnasium.Env):
    """:class:`cosfly.gym.Track` with the names of observations and infos that LeRobot expects."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        recipe: str,
        step_s: float = 0.1,
        prompt: str = PROMPT,
        size: int = 0,
        render_mode: str | None = None,
        **more: Any,
    ) -> None:
        is_drawn = bool(size or render_mode)
        pictures = {"obs": ("state", "rgb"), "size": size or _RENDERED_SIZE} if is_drawn else {}
        self._track = Track(recipe, step_s=step_s, **pictures, **more)
        self.render_mode, self._size, self._picture = render_mode, size, None
        self.metadata = {**type(self).metadata, "render_fps": max(round(1.0 / step_s), 1)}
        self._step_s, self.task_description, self.task = step_s, prompt, prompt
        space = self._track.observation_space
        names = {"agent_pos": space["state"] if is_drawn else space}
        if size:
            names["pixels"] = space["rgb"]
        self.observation_space = gymnasium.spaces.Dict(names)
        self.action_space = action_space()
        self._outcome = Outcome(1, step_s)

    @property
    def _max_episode_steps(self) -> int:
        return self._track.planned_steps

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        super().reset(seed=seed)
        observation, info = self._track.reset(seed=seed, options=options)
        self._outcome = Outcome(self._track.planned_steps, self._step_s)
        return self._named(observation), {**info, "is_success": False}

    def step(self, action: np.ndarray) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        observation, reward, terminated, truncated, info = self._track.step(action)
        self._outcome.count(bool(info["tracked"]), reward, terminated, truncated)
        told = {**info, "is_success": self._outcome.success, "tracking_rate": self._outcome.tracking_rate}
        return self._named(observation), reward, terminated, truncated, told

    def render(self) -> Any:
        """The picture of the last step; none without ``render_mode="rgb_array"``."""
        return self._picture if self.render_mode else None

    def _named(self, observation: Any) -> dict[str, np.ndarray]:
        if not isinstance(observation, dict):
            return {"agent_pos": observation}
        self._picture = observation["rgb"]
        return {"agent_pos": observation["state"], **({"pixels": self._picture} if self._size else {})}


def _register() -> None:
    from gymnasium.envs.registration import register, registry

    if ID not in registry:
        register(id=ID, entry_point="cosfly.lerobot:LeRobotTrack")


_register()

try:
    from lerobot.configs.types import FeatureType, PolicyFeature
    from lerobot.envs.configs import EnvConfig
except ImportError:  # The environment works without LeRobot; its configuration does not.
    pass
else:

    @EnvConfig.register_subclass("cosfly")
    @dataclass
    class CosflyEnv(EnvConfig):
        """LeRobot's configuration of the environment."""

        task: str | None = "LeRobotTrack-v0"
        fps: int = 10
        recipe: str = "recipes/suites/street.toml"
        # Width and height of pictures in pixels; without pictures at 0.
        size: int = 0
        # Look of the pictures: `simple` or `full`; in the weather of the recipe.
        look: str = "simple"
        features: dict[str, PolicyFeature] = field(
            default_factory=lambda: {
                "action": PolicyFeature(type=FeatureType.ACTION, shape=(5,)),
                "agent_pos": PolicyFeature(type=FeatureType.STATE, shape=(16,)),
            }
        )
        features_map: dict[str, str] = field(
            default_factory=lambda: {"action": "action", "agent_pos": "observation.state"}
        )

        def __post_init__(self) -> None:
            if self.size:
                self.features["pixels"] = PolicyFeature(type=FeatureType.VISUAL, shape=(self.size, self.size, 3))
                self.features_map["pixels"] = "observation.image"

        @property
        def package_name(self) -> str:
            """Package that registers the environment."""
            return "cosfly.lerobot"

        @property
        def gym_id(self) -> str:
            """Id of the environment."""
            return ID

        @property
        def gym_kwargs(self) -> dict[str, Any]:
            """Arguments of the environment."""
            drawn = {"size": self.size, "look": self.look, "render_mode": "rgb_array"}
            return {"recipe": self.recipe, "step_s": 1.0 / self.fps, **drawn}
