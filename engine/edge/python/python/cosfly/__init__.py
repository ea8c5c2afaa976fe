"""cosfly: datasets that teach drones to follow a moving target.

Make a dataset::

    import cosfly
    made = cosfly.run("recipe.toml", set={"stages.walkers.count": 8})
    print(made.out, cosfly.verify(made.out).sound)

Load a dataset::

    windows = cosfly.Dataset(made.out, split="train", size=(224, 126)).windows()
    sample = windows[0]          # rgb (5, 126, 224, 3) uint8, depth (5, 126, 224) float32 metres, ...

Ask the expert how to go on from any state of a drone::

    answers = cosfly.Expert("recipe.toml").plan_from([{"trajectory_id": "expert-p00000", "frame": 40, "position_in_world": [1, 2, 9]}])

World frame: CARLA's, left-handed, x forward, y right, z up, metres; angles in degrees. Everything that fails raises
:class:`cosfly.Error` with a code, a message, the place in the file and advice.
"""

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from ._calls import PathLike as _PathLike
from ._calls import (
    DoctorResult,
    EvaluateResult,
    ExportResult,
    PlanResult,
    PlanStage,
    PreviewResult,
    RunResult,
    RunStage,
    VerifyResult,
    WhyResult,
    doctor,
    evaluate,
    export,
    init,
    plan,
    preview,
    run,
    verify,
    why,
)
from ._cosfly import Table, __version__, decode_rgb
from ._errors import Error, InvalidValue, NotFound, OutOfRange, Problem, WrongType
from ._show import Frame, Town, Trajectory, rerun

if _TYPE_CHECKING:
    from . import pettingzoo as _pettingzoo
    from ._dataset import Dataset, Loader, Windows
    from ._expert import Answer, Expert
    from ._pack import Pack, pack

__all__ = [
    "Answer", "Dataset", "DoctorResult", "Error", "EvaluateResult", "Expert", "ExportResult", "Frame", "InvalidValue", "Loader",
    "NotFound", "OutOfRange", "Pack", "PlanResult", "PlanStage", "PreviewResult", "Problem", "RunResult", "RunStage", "Table", "Town",
    "Trajectory", "VerifyResult", "WhyResult", "Windows", "WrongType", "__version__",
    "decode_rgb", "doctor", "evaluate", "export", "init", "pack", "parallel_env", "plan", "preview", "rerun", "run", "verify", "why",
]  # fmt: skip

_GONE = {
    "Check": "VerifyResult", "Doctor": "DoctorResult", "Evaluation": "EvaluateResult", "Exported": "ExportResult", "Made": "RunResult",
    "Pictures": "PreviewResult", "Plan": "PlanResult", "PlannedStage": "PlanStage", "Stage": "RunStage", "Why": "WhyResult", "eval": "evaluate",
}  # fmt: skip

_LATE = {
    # Modules that import numpy, by the names that they give.
    "Dataset": "_dataset", "Loader": "_dataset", "Windows": "_dataset", "Answer": "_expert", "Expert": "_expert", "Pack": "_pack", "pack": "_pack",
}  # fmt: skip

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> _Any:
        if name in _LATE:
            found = getattr(_import_module("." + _LATE[name], __name__), name)
            globals()[name] = found
            return found
        hint = f"; it is called cosfly.{_GONE[name]}" if name in _GONE else ""
        raise AttributeError(f"module 'cosfly' has no attribute {name!r}{hint}")

    def __dir__() -> "list[str]":
        return sorted({*globals(), *__all__})


def parallel_env(recipe: _PathLike, num_drones: int = 2, **more: _Any) -> "_pettingzoo.ParallelTrack":
    """Several drones behind one target, as an environment of pettingzoo (`pip install ".[pettingzoo]"` in a clone)."""
    from .pettingzoo import ParallelTrack

    return ParallelTrack(recipe, num_drones, **more)
