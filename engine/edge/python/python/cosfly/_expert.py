"""The expert's way on from any state of a drone (relabelling, as for DAgger)."""

from __future__ import annotations

import json
import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Sequence

import numpy as np

from . import _cosfly
from ._calls import PathLike, Settings, _options, settings


@dataclass(frozen=True)
class Answer:
    """The expert's answer to one state."""

    trajectory: str
    frame: int
    """Frame of the state; -1 where the state has none that is a number."""
    planned: bool
    """Whether there is a flight from this state within all limits."""
    reason: Optional[str]
    """Why there is none."""
    frames: np.ndarray
    """Frames of the waypoints, (N,) int."""
    poses: np.ndarray
    """x, y, z (m), pitch, yaw (degrees) in the world frame, (N, 5)."""
    visibility: np.ndarray
    """Visible share of the target's body points, (N,), 0..1."""
    certificate: Optional[Dict[str, Any]]
    """Clearance, speed, acceleration, jerk and mean visibility of the whole answer."""
    error: Optional[str] = None
    """Message where the state itself is not allowed, such as NaN."""


class Expert:
    """The expert of a finished recipe: run the recipe first, with the same settings and store."""

    def __init__(self, recipe: PathLike, *, set: Settings = None, store: Optional[PathLike] = None):
        self._arguments = ["ask-expert", os.fspath(recipe), "--batch", *settings(set), *_options(store=store)]

    def plan_from(self, states: Sequence[Mapping[str, Any]], *, jobs: Optional[int] = None) -> List[Answer]:
        """Ask about states, in their order, over all cores.

        A state is a dictionary: ``trajectory`` (id), ``frame``, ``position`` (x, y, z in the world frame, metres), and
        optionally ``velocity`` (m/s; that of the published flight in this frame unless given) and ``horizon_s``. A state that is not allowed gives an answer with ``error``; only
        a recipe that was not run raises :class:`cosfly.Error`.
        """
        lines = [json.dumps({key: _plain(value) for key, value in state.items()}) for state in states]
        if not lines:
            return []
        jobs = max(1, min(jobs or os.cpu_count() or 1, math.ceil(len(lines) / 4)))
        size = math.ceil(len(lines) / jobs)
        parts = [lines[start : start + size] for start in range(0, len(lines), size)]
        if len(parts) == 1:
            return self._ask(parts[0])
        with ThreadPoolExecutor(len(parts)) as pool:
            return [answer for part in pool.map(self._ask, parts) for answer in part]

    def _ask(self, lines: List[str]) -> List[Answer]:
        _, text, _ = _cosfly.call(self._arguments, "\n".join(lines).encode() + b"\n")
        return [_answer(json.loads(line), json.loads(asked)) for line, asked in zip(text.splitlines(), lines)]


def _plain(value: Any) -> Any:
    value = value.tolist() if hasattr(value, "tolist") else value
    values = value if isinstance(value, (list, tuple)) else [value]
    if any(isinstance(it, float) and not math.isfinite(it) for it in values):
        # JSON has no NaN: a text there is refused with the name of the field.
        return str(value)
    return value


def _answer(found: Dict[str, Any], asked: Dict[str, Any]) -> Answer:
    waypoints = found.get("waypoints") or []
    position = lambda it: it.get("position_in_world") or it.get("position")
    poses = [[*position(it), it["pitch_deg"], it["yaw_deg"]] for it in waypoints]
    error, frame = found.get("error"), found.get("frame", asked.get("frame"))
    return Answer(
        trajectory=str(found.get("trajectory", asked.get("trajectory"))),
        frame=frame if isinstance(frame, int) else -1,
        planned=bool(found.get("planned", False)),
        reason=found.get("reason"),
        frames=np.array([it["frame"] for it in waypoints], dtype=np.int64),
        poses=np.array(poses, dtype=np.float64).reshape(-1, 5),
        visibility=np.array([it["visibility"] for it in waypoints], dtype=np.float64),
        certificate=found.get("certificate"),
        error=error["message"] if error else None,
    )
