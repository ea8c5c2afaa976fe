"""Data and results of the scripts in this folder: recipes that are run, and jobs whose results are files."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import BinaryIO, Callable, List, Optional

import numpy as np
import tools


def run_recipe(cosfly: str, recipe: str, folder: Path, settings: List[str]) -> None:
    command = [cosfly, "run", str(Path(__file__).parent / recipe), "--out", str(folder), "--quiet"]
    tools.cosfly(command + [part for it in settings for part in ("--set", it)])


def write_whole(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """A file that is there is whole."""
    part = path.with_name(path.name + ".part")
    with part.open("wb") as file:
        write(file)
    os.replace(part, path)


class Unfinished(Exception):
    """The time is over in the middle of a job, which goes on there the next time."""


class Jobs:
    """Results of jobs as files; no job begins after the minutes are over, at `end`."""

    def __init__(self, folder: Path, minutes: Optional[float]) -> None:
        self.folder, self.end = folder, None if minutes is None else time.monotonic() + 60 * minutes
        self.left = 0
        folder.mkdir(parents=True, exist_ok=True)

    def result(self, name: str, make: Callable[[], np.ndarray]) -> Optional[np.ndarray]:
        path = self.folder / f"{name}.npy"
        if not path.exists():
            if self.end is not None and time.monotonic() > self.end:
                self.left += 1
                return None
            began = time.monotonic()
            try:
                made = make()
            except Unfinished as left:
                print(f"{name}: {left}", file=sys.stderr, flush=True)
                self.left += 1
                return None
            write_whole(path, lambda file: np.save(file, made))
            print(f"{name}: {time.monotonic() - began:.1f} s", file=sys.stderr, flush=True)
        return np.load(path)
