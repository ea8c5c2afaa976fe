"""Settings of environments, the same for gymnasium, PettingZoo, LeRobot and vla-eval."""

from __future__ import annotations

import dataclasses
import difflib
import operator
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Sequence

from . import _cosfly
from ._calls import settings_of
from ._errors import FORMER, InvalidValue, WrongType, names_of, number_of, path_of, size_of

if TYPE_CHECKING:
    from typing import TypedDict

    class EnvOptions(TypedDict, total=False):
        """The fields of :class:`EnvConfig` but for the recipe, as keyword arguments."""

        set: Mapping[str, Any] | None
        store: str | os.PathLike[str] | None
        obs: str | Sequence[str]
        size: int | tuple[int, int]
        max_depth_m: float
        weather: str | None
        look: str
        jobs: int | None
        step_s: float
        latency_s: float | None
        expert_action: bool



class Channel(NamedTuple):
    """A channel of pictures: name, type and meaning are those of datasets."""

    name: str
    """Name in ``obs``, in recipes and in datasets."""
    dtype: str
    """Type of the values, as numpy calls it."""
    values: int
    """Values of a pixel: 1, or 3 in the last axis of a picture."""
    least: float
    """Least value."""
    greatest: float | None
    """Greatest value; None where it is ``max_depth_m``."""
    unit: str
    """Unit, as descriptions of networks call it (:func:`cosfly.onnx.describe`)."""
    doc: str
    """Meaning with unit and frame."""


class Sensor(NamedTuple):
    """A sensor that is no camera: name and meaning are those of recipes."""

    name: str
    """Name in ``obs`` and in recipes."""
    doc: str
    """Meaning with its model and its limits."""
    quantities: dict[str, str]
    """Names of the numbers of a reading, in their order, each with its meaning."""


CHANNELS: dict[str, Channel] = {facts[0]: Channel(*facts) for facts in _cosfly.channels()}
"""All channels of pictures, by name."""
SENSORS: dict[str, Sensor] = {name: Sensor(name, doc, dict(quantities)) for name, doc, quantities in _cosfly.sensors()}
"""All sensors that are no cameras, by name."""
OBSERVATIONS = ("state", *CHANNELS, *SENSORS)
LOOKS = ("simple", "full")
"""Looks of colours."""
_LARGEST_SIZE = 2048


@dataclass(frozen=True)
class EnvConfig:
    """Settings of an environment over the episodes of a recipe."""

    recipe: str | os.PathLike[str]
    """The recipe, or a folder with a ``recipe.toml``."""
    set: Mapping[str, Any] | None = None
    """Changes to values of the recipe, as of :func:`cosfly.run`."""
    store: str | os.PathLike[str] | None = None
    """Folder of the store; else that of ``COSFLY_STORE``, else ``.cosfly``."""
    obs: str | Sequence[str] = ("state",)
    """Observations: ``state`` (16 numbers), names of :data:`CHANNELS` and of :data:`SENSORS`. One alone is an array, several are a
    dictionary."""
    size: int | tuple[int, int] = 84
    """Width and height of pictures, pixels; one number is both."""
    max_depth_m: float = 200.0
    """Greatest depth in pictures, metres."""
    weather: str | None = None
    """Weather of pictures; else that of the recipe's pictures."""
    look: str = "simple"
    """Look of colours: ``simple`` or ``full``."""
    jobs: int | None = None
    """Threads that step and draw; else one per core."""
    step_s: float = 0.1
    """Time from one action to the next, seconds."""
    latency_s: float | None = None
    """Time from an observation to the effect of its action, seconds; else that of the recipe."""
    expert_action: bool = False
    """Whether ``info`` has the expert's action."""

    def __post_init__(self) -> None:
        settings_of(self.set)
        path_of(self.recipe, "the recipe of environments")
        object.__setattr__(self, "obs", names_of("obs", self.obs))
        if self.jobs is not None and not (hasattr(self.jobs, "__index__") and 1 <= operator.index(self.jobs) <= 1024):
            raise InvalidValue(f"jobs is {self.jobs!r}; it is a whole number from 1 to 1024")
        for name in ("max_depth_m", "step_s", "latency_s"):
            if (value := getattr(self, name)) is not None:
                number_of(name, value)
        if self.look not in LOOKS:
            raise InvalidValue(f"look is {self.look!r}; it is one of {', '.join(LOOKS)}")
        if self.weather is not None and self.weather not in _cosfly.weathers():
            raise InvalidValue(f"weather is {self.weather!r}; it is one of {', '.join(_cosfly.weathers())}")
        names = tuple(self.obs)
        if not names or not {*names} <= {*OBSERVATIONS} or len({*names}) < len(names):
            raise InvalidValue(f"obs is {names}; it names one or several of {', '.join(OBSERVATIONS)}, each once; channels of films, such as flow_forward, are not seen while flying")
        if not all(8 <= side <= _LARGEST_SIZE for side in self.sides):
            raise InvalidValue(f"size is {self.sides}; the sides of pictures are 8 to {_LARGEST_SIZE} pixels")
        if not 1.0 <= self.max_depth_m <= 1e6:
            raise InvalidValue(f"max_depth_m is {self.max_depth_m}; it is 1 to 1000000 m")
        if not 0.01 <= self.step_s <= 1.0 or not 0.0 <= (self.latency_s or 0.0) <= 5.0:
            raise InvalidValue(f"step_s is {self.step_s} (0.01 to 1 s) and latency_s is {self.latency_s} (0 to 5 s)")

    @classmethod
    def of(cls, recipe: str | os.PathLike[str], options: Mapping[str, Any]) -> EnvConfig:
        """The settings in keyword arguments; other names are refused with the nearest one."""
        known = [field.name for field in dataclasses.fields(cls) if field.name != "recipe"]
        for name in options:
            if name not in known:
                near = FORMER.get(name) or next(iter(difflib.get_close_matches(name, known, 1)), None)
                advice = f"did you mean `{near}`?" if near else f"the settings are {', '.join(known)}"
                raise WrongType(f"environments have no setting `{name}`; {advice}")
        return cls(recipe, **options)

    # What the extension module reads.

    @property
    def sides(self) -> tuple[int, int]:
        """Width and height of pictures, pixels."""
        return size_of((self.size, self.size) if hasattr(self.size, "__index__") else self.size)

    @property
    def channels(self) -> list[str]:
        """Channels of pictures."""
        return [name for name in self.obs if name in CHANNELS]

    @property
    def sensors(self) -> list[str]:
        """Sensors that are no cameras."""
        return [name for name in self.obs if name in SENSORS]

    @property
    def changes(self) -> list[str]:
        """Changes to the recipe, as the command line takes them."""
        return list(settings_of(self.set))

    @property
    def place(self) -> str:
        """Folder of the store."""
        return path_of(self.store if self.store is not None else os.environ.get("COSFLY_STORE") or ".cosfly")

    @property
    def threads(self) -> int:
        """Number of threads that step and draw."""
        return self.jobs if self.jobs is not None else os.cpu_count() or 1
