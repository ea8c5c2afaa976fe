"""Drones that follow people, as an environment of LeRobot's hub: this folder is a whole repository of it.

    from lerobot.envs.factory import make_env
    envs = make_env("USER/REPOSITORY", n_envs=4, trust_remote_code=True)

Episodes are those of `recipe.toml` beside this file, else those of cosfly's own small recipe. Needs cosfly and lerobot.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import cosfly
from cosfly.lerobot import CosflyEnv
from lerobot.envs.factory import make_env as make_env_of

# Gone when the program ends.
_OWN = tempfile.TemporaryDirectory(prefix="cosfly-")


def _recipe() -> Path:
    beside = Path(__file__).with_name("recipe.toml")
    if beside.is_file():
        return beside
    folder = Path(tempfile.mkdtemp(dir=_OWN.name)) / "small"
    cosfly.init(folder)
    return folder / "recipe.toml"


def make_env(n_envs: int = 1, use_async_envs: bool = False, cfg: Any = None) -> Any:
    """The environments, as LeRobot asks for them; `size` and `look` of `cfg` are those of the pictures."""
    pictures = {name: getattr(cfg, name) for name in ("size", "look") if hasattr(cfg, name)}
    return make_env_of(CosflyEnv(recipe=str(_recipe()), **pictures), n_envs=n_envs, use_async_envs=use_async_envs)
