"""Exceptions of the package."""

from __future__ import annotations

import difflib
import functools
import inspect
import operator
import os
import re
import warnings
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence, TypeVar, cast

Call = TypeVar("Call", bound=Callable[..., Any])


@dataclass(frozen=True)
class Problem:
    """One problem that an :class:`Error` reports."""

    code: str
    """Stable name, such as ``recipe-unknown-key``; the book's index of codes lists all."""
    message: str
    """Statement of the problem, with its causes."""
    hints: tuple[str, ...]
    """Allowed values and next steps."""
    place: tuple[str, int, int] | None
    """File, line and column (from 1), where the problem has a place in a file."""


class Error(Exception):
    """A call that cannot be carried out; the text is the one that the command line prints."""

    _code = "unknown"

    def __init__(self, text: str, problems: Sequence[dict] = ()):
        Exception.__init__(self, text)  # PyTorch gives the text of a worker's error alone
        self.problems: tuple[Problem, ...] = tuple(
            Problem(it["code"], it["message"], tuple(it["hints"]), tuple(it["place"]) if it["place"] else None)
            for it in problems
        )

    @property
    def code(self) -> str:
        """Code of the first problem."""
        found = re.search(r"error\[([a-z0-9-]+)\]", str(self))
        return self.problems[0].code if self.problems else found[1] if found else self._code

    @property
    def hints(self) -> tuple[str, ...]:
        """Allowed values and next steps, of all problems."""
        return tuple(hint for problem in self.problems for hint in problem.hints)

    @property
    def place(self) -> tuple[str, int, int] | None:
        """File, line and column (from 1) of the first problem that has a place."""
        return next((problem.place for problem in self.problems if problem.place), None)

    def __reduce__(self):
        problems = [dict(code=p.code, message=p.message, hints=p.hints, place=p.place) for p in self.problems]
        return type(self), (str(self), problems)

    __str__ = Exception.__str__  # KeyError would quote the text


class InvalidValue(Error, ValueError):
    """A value that is not allowed."""

    _code = "python-value"


class WrongType(Error, TypeError):
    """A value of a type that is not allowed."""

    _code = "python-type"


class NotFound(Error, KeyError):
    """A name that does not exist: of a trajectory, a table's column, a town."""

    _code = "python-name"


class OutOfRange(Error, IndexError):
    """A number beyond the last sample or frame."""

    _code = "python-number"


def path_of(value: Any, what: str = "a path") -> str:
    """The text of a path; what is none is refused."""
    try:
        return os.fspath(value)
    except TypeError:
        raise WrongType(f"{what} is a text or a path, not {value!r:.60} ({type(value).__name__})") from None


def names_of(what: str, given: Any) -> tuple[str, ...]:
    """The names of a list, or the one name that is given alone."""
    if isinstance(given, str):
        return (given,)
    if isinstance(given, (bytes, Mapping)) or not hasattr(given, "__iter__"):
        raise WrongType(f"`{what}` is {given!r:.60} ({type(given).__name__}); it is a name or a list of names")
    names = tuple(given)
    for name in names:
        if not isinstance(name, str):
            raise WrongType(f"`{what}` has {name!r:.60} ({type(name).__name__}) in it; it is a name or a list of names")
    return names


def size_of(size: Any) -> tuple[int, int]:
    """Width and height of pictures, pixels."""
    try:
        width, height = (operator.index(side) for side in size)
    except (TypeError, ValueError):
        raise WrongType(f"`size` is {size!r:.60}; it is (width, height), whole numbers of pixels") from None
    if min(width, height) < 1 or max(width, height) > 16_384:
        raise InvalidValue(f"the size is {width} x {height}; sides are from 1 to 16384 pixels")
    return width, height


def number_of(name: str, value: Any) -> float:
    """A number; what is none is refused."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__float__"):
        raise WrongType(f"`{name}` is {value!r:.60} ({type(value).__name__}); it is a number")
    return float(value)


def keys_of(what: str, given: Any, allowed: Sequence[str], strangers: bool = False) -> Mapping[str, Any]:
    """A dictionary whose keys are all ``allowed``; nothing at all is an empty one. With ``strangers``, keys that are like none of them
    get a warning instead."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise WrongType(f"{what} is {given!r:.60}; it is a dictionary with {_listed(allowed)}")
    for key in given:
        if key not in allowed:
            near = difflib.get_close_matches(str(key), allowed, 1)
            advice = f"did you mean `{near[0]}`?" if near else f"there is {_listed(allowed)}"
            if near or not strangers:
                raise InvalidValue(f"{what} has no key {key!r}; {advice}")
            warnings.warn(f"{what} has no key {key!r}, which does nothing; {advice}", stacklevel=3)
    return given


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


FORMER = {"overrides": "set", "threads": "jobs"}
"""Former names of options that several functions have, and what they are called now."""


def options(**gone: str) -> Callable[[Call], Call]:
    """Refuses keywords that a function does not have, with the nearest name; ``gone`` says what its own former ones are called now."""

    def of(function: Call) -> Call:
        known = inspect.signature(function).parameters
        takes_more = any(it.kind is it.VAR_KEYWORD for it in known.values())
        now = {name: f"`{it}`" for name, it in FORMER.items() if it in known} | gone

        @functools.wraps(function)
        def call(*values: Any, **given: Any) -> Any:
            for name in given:
                if name in now:
                    raise WrongType(f"`{name}` is no option any more: use {now[name]}")
                if name not in known and not takes_more:
                    near = difflib.get_close_matches(name, known, 1)
                    raise WrongType(f"there is no option `{name}`" + (f"; did you mean `{near[0]}`?" if near else ""))
            return function(*values, **given)

        return cast(Call, call)

    return of
