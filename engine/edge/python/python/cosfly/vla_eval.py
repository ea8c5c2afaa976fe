"""A benchmark for `vla-eval`: `benchmark: "cosfly.vla_eval:TrackBenchmark"`, with `params: {recipe: recipes/suites/street.toml}`.

Each episode of the recipe is a task. Observations have `state` (16 numbers), `task_description` and, on
request (`pictures: [depth, mask]`), `images`, and a key for each of `sensors: [laser_altimeter]`; an action has `actions`:
velocity ahead, right, up (m/s), pitch rate, yaw rate (degrees/s). The book's page "Policies of fly" defines them.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np
from vla_eval.benchmarks.base import StepBenchmark, StepResult
from vla_eval.specs import DimSpec

from ._env_config import CHANNELS, SENSORS, EnvConfig
from ._errors import InvalidValue, names_of
from ._outcome import Outcome
from .gym import Track

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._env_config import EnvOptions

PROMPT = "Follow the target and keep it in view."


class TrackBenchmark(StepBenchmark):
    """Drones that follow people: the episodes of a recipe, each flown once."""

    render_backends = frozenset({"cpu", "gpu"})

    @classmethod
    def configure_render(cls, mode: str) -> dict[str, str]:
        """Nothing is needed: pictures are drawn on the processor."""
        return {}

    def __init__(
        self,
        recipe: str | os.PathLike[str],
        *,
        prompt: str = PROMPT,
        pictures: str | Sequence[str] = (),
        sensors: str | Sequence[str] = (),
        **options: Unpack[EnvOptions],
    ) -> None:
        super().__init__()
        self._pictures, self._sensors = names_of("pictures", pictures), names_of("sensors", sensors)
        unknown = [name for name in self._pictures if name not in CHANNELS] + [name for name in self._sensors if name not in SENSORS]
        if unknown:
            raise InvalidValue(f"pictures and sensors name {unknown}; pictures are {', '.join(CHANNELS)}, sensors are {', '.join(SENSORS)}")
        config = EnvConfig.of(recipe, {**options, "obs": ("state", *self._pictures, *self._sensors)})
        self._env = Track(recipe, **{**options, "obs": config.obs})
        self._suite = os.path.splitext(os.path.basename(os.fspath(recipe)))[0]
        self._prompt, self._step_s = prompt, config.step_s
        self._outcome = Outcome(1, config.step_s)

    def get_tasks(self) -> list[dict[str, Any]]:
        return [{"name": name, "suite": self._suite} for name in self._env.episodes()]

    def reset(self, task: dict[str, Any]) -> Any:
        state, _ = self._env.reset(options={"episode": task["name"]})
        self._outcome = Outcome(self._env.planned_steps, self._step_s)
        return state

    def step(self, action: dict[str, Any]) -> StepResult:
        numbers = np.asarray(action.get("actions", action.get("action")), dtype=np.float32)
        numbers = numbers.reshape(-1, numbers.shape[-1])[0] if numbers.ndim else numbers
        if numbers.shape != (5,) or not np.isfinite(numbers).all():
            raise InvalidValue(f"an action is five finite numbers, not {action!r:.200}")
        state, reward, terminated, truncated, info = self._env.step(numbers)
        self._outcome.count(bool(info["tracked"]), reward, terminated, truncated)
        return StepResult(obs=state, reward=reward, done=terminated or truncated, info=info)

    def make_obs(self, raw_obs: Any, task: dict[str, Any]) -> dict[str, Any]:
        if not isinstance(raw_obs, dict):
            return {"state": raw_obs, "task_description": self._prompt}
        told = {"state": raw_obs["state"], "task_description": self._prompt, **{name: raw_obs[name] for name in self._sensors}}
        return {**told, "images": {name: raw_obs[name] for name in self._pictures}} if self._pictures else told

    def get_step_result(self, step_result: StepResult) -> dict[str, Any]:
        outcome = self._outcome
        return {"success": outcome.success, "tracking_rate": outcome.tracking_rate, "reward": outcome.reward}

    async def get_time(self) -> float:
        """Simulated time since the beginning of the episode, seconds."""
        return self._outcome.steps * self._step_s

    def get_hold_action(self, last_action: dict[str, Any] | None) -> dict[str, Any]:
        """Stop and look where the camera looked."""
        return {"actions": np.zeros(5, dtype=np.float32)}

    def get_metric_keys(self) -> dict[str, str]:
        return {"success": "mean", "tracking_rate": "mean", "reward": "mean"}

    def get_action_spec(self) -> dict[str, DimSpec]:
        text = "velocity ahead, right, up (m/s), pitch rate, yaw rate (degrees/s)"
        return {"actions": DimSpec("actions", 5, "cosfly_velocity", description=text)}

    def get_observation_spec(self) -> dict[str, DimSpec]:
        images = {name: DimSpec(name, 0, "image", description="rows, columns") for name in self._pictures}
        sensors = {
            name: DimSpec(name, len(SENSORS[name].quantities), "cosfly_sensor", description=", ".join(SENSORS[name].quantities))
            for name in self._sensors
        }
        return {
            **images,
            **sensors,
            "state": DimSpec("state", 16, "cosfly_state", description="the state of `cosfly fly`"),
            "task_description": DimSpec("task_description", 0, "language"),
        }

    def get_metadata(self) -> dict[str, Any]:
        return {"name": f"cosfly/{self._suite}", "step_s": self._step_s, "max_steps": 100_000}
