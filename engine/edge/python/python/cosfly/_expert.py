"""The expert's way on from any state of a drone (relabelling, as for DAgger)."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any, Mapping, Sequence

import numpy as np

from . import _cosfly
from ._calls import PathLike, Settings, settings_of
from ._errors import options, path_of


@dataclass(frozen=True)
class Answer:
    """The expert's answer to one state."""

    trajectory_id: str
    frame: int
    """Frame of the state; -1 where the state has none that is a number."""
    planned: bool
    """Whether there is a flight from this state within all limits."""
    reason: str | None
    """Why there is none."""
    frames: np.ndarray
    """Frames of the waypoints, (N,) int."""
    poses: np.ndarray
    """x, y, z (m), pitch, yaw (degrees) in the world frame, (N, 5)."""
    visibility: np.ndarray
    """Visible share of the target's body points, (N,), 0..1."""
    certificate: dict[str, Any] | None
    """Clearance, speed, acceleration, jerk and mean visibility of the whole answer."""
    error: str | None = None
    """Message where the state itself is not allowed, such as NaN."""


class Expert:
    """The expert of a finished recipe: run the recipe first, with the same settings and store.

    The recipe is planned with the first question; towns and flights that were asked for are kept. A recipe that is run
    anew takes a new object.
    """

    @options(threads="`jobs` of the method `plan_from()`")
    def __init__(self, recipe: PathLike, *, set: Settings = None, store: PathLike | None = None):
        place = None if store is None else path_of(store)
        self._options = json.dumps({"recipe": path_of(recipe, "the recipe of an expert"), "set": settings_of(set), "store": place})
        self._opened: tuple[int, _cosfly.ExpertService | None] = (-1, None)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": (-1, None)}

    @options()
    def plan_from(self, states: Sequence[Mapping[str, Any]], *, jobs: int | None = None) -> list[Answer]:
        """Ask about states, in their order, over ``jobs`` or all cores.

        A state is a dictionary: ``trajectory_id``, ``frame``, ``position_in_world`` (x, y, z, metres), and optionally
        ``velocity_in_world`` (m/s; that of the published flight in this frame unless given) and ``horizon_s``. A state
        that is not allowed gives an answer with ``error``; only a recipe that was not run raises :class:`cosfly.Error`.
        """
        lines = [json.dumps({key: _plain(value) for key, value in state.items()}) for state in states]
        if not lines:
            return []
        parts = max(1, min(jobs or os.cpu_count() or 1, math.ceil(len(lines) / 4)))
        answers = self._service.answers(lines, parts)
        return [_answer(json.loads(line), json.loads(asked)) for line, asked in zip(answers, lines)]

    @property
    def _service(self) -> _cosfly.ExpertService:
        process, service = self._opened
        if service is None or process != os.getpid():  # threads do not survive a fork
            service = _cosfly.ExpertService(self._options)
            self._opened = (os.getpid(), service)
        return service


def _plain(value: Any) -> Any:
    value = value.tolist() if hasattr(value, "tolist") else value
    values = value if isinstance(value, (list, tuple)) else [value]
    if any(isinstance(it, float) and not math.isfinite(it) for it in values):
        # JSON has no NaN: a text there is refused with the name of the field.
        return str(value)
    return value


def _answer(found: dict[str, Any], asked: dict[str, Any]) -> Answer:
    waypoints = found.get("waypoints") or []
    poses = [[*it["position_in_world"], it["pitch_deg"], it["yaw_deg"]] for it in waypoints]
    error, frame = found.get("error"), found.get("frame", asked.get("frame"))
    return Answer(
        trajectory_id=str(found.get("trajectory_id", asked.get("trajectory_id"))),
        frame=frame if isinstance(frame, int) else -1,
        planned=bool(found.get("planned", False)),
        reason=found.get("reason"),
        frames=np.array([it["frame"] for it in waypoints], dtype=np.int64),
        poses=np.array(poses, dtype=np.float64).reshape(-1, 5),
        visibility=np.array([it["visibility"] for it in waypoints], dtype=np.float64),
        certificate=found.get("certificate"),
        error=error["message"] if error else None,
    )
