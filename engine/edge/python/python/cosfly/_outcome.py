"""Outcome of an episode of :mod:`cosfly.gym`, as `cosfly fly` defines it."""

from __future__ import annotations


class Outcome:
    """Counts the steps of an episode."""

    def __init__(self, planned_steps: int, step_s: float) -> None:
        self.planned_steps = max(planned_steps, 1)
        self.last_steps = max(round(1.0 / step_s), 1)
        self.steps = self.tracked_steps = self.tracked_run = 0
        self.reward = 0.0
        self.is_finished = self.is_over = False

    def count(self, tracked: bool, reward: float, terminated: bool, truncated: bool) -> None:
        """Counts a step."""
        self.steps += 1
        self.tracked_steps += tracked
        self.tracked_run = self.tracked_run + 1 if tracked else 0
        self.reward += reward
        self.is_finished, self.is_over = truncated, terminated or truncated

    @property
    def success(self) -> bool:
        """Whether the end of the walk is reached and the target was tracked in the last second."""
        return self.is_finished and self.tracked_run >= self.last_steps

    @property
    def tracking_rate(self) -> float:
        """Share of all steps of the episode in which the target was tracked."""
        return self.tracked_steps / self.planned_steps
