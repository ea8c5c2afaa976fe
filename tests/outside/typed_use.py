"""Use of the package under pyright's strict mode; the names and types that users rely on."""

# pyright: strict

from pathlib import Path
from typing import Any, Dict, List, Optional

import numpy as np
import numpy.typing as npt

import cosfly
import cosfly.torch


def use(folder: Path) -> Optional[float]:
    made: cosfly.RunResult = cosfly.run(folder, set={"seed": 3}, jobs=2, progress=False)
    stages: List[str] = [stage.stage for stage in made.stages if stage.ran > 0]
    check: cosfly.VerifyResult = cosfly.verify(folder)
    plan: cosfly.PlanResult = cosfly.plan({"name": "x", "stages": {}})
    windows: cosfly.Windows = cosfly.Dataset(folder, split="train", channels=("rgb",), size=(80, 45)).windows()
    sample: Dict[str, Any] = windows[0]
    order: npt.NDArray[np.int64] = windows.order(seed=1, shard=(0, 2))
    for batch in windows.loader(8, seed=1):
        print(sorted(batch), sample["rgb"], order[:3], stages, plan.to_run)
    answers = cosfly.Expert(folder).plan_from([{"trajectory_id": "a", "frame": 1, "position_in_world": [0.0, 1.0, 2.0]}])
    picture = cosfly.decode_rgb(b"", size=(8, 8))
    flight: cosfly.Trajectory = windows.trajectory("expert-p00000")
    frame: cosfly.Frame = flight[3]
    print(len(flight), frame.png("rgb"), windows.town().name, windows.size_of("expert-p00000"))
    loader = cosfly.torch.Loader(windows, 8, workers=2, seed=1)
    loader.load_state_dict(loader.state_dict())
    try:
        cosfly.evaluate(folder, "mine.jsonl")
    except cosfly.Error as error:
        print(error.code, error.hints, error.place, picture.shape)
    return float(answers[0].poses[0, 0]) if check.sound else None
