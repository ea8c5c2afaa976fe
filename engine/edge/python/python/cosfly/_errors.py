"""Exceptions of the package."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Optional, Sequence, Tuple


@dataclass(frozen=True)
class Problem:
    """One problem that an :class:`Error` reports."""

    code: str
    """Stable name, such as ``recipe-unknown-key``; the book's index of codes lists all."""
    message: str
    """Statement of the problem, with its causes."""
    hints: Tuple[str, ...]
    """Allowed values and next steps."""
    place: Optional[Tuple[str, int, int]]
    """File, line and column (from 1), where the problem has a place in a file."""


class Error(Exception):
    """A call that cannot be carried out; the text is the one that the command line prints."""

    def __init__(self, text: str, problems: Sequence[dict] = ()):
        super().__init__(text)  # PyTorch gives the text of a worker's error alone
        self.problems: Tuple[Problem, ...] = tuple(
            Problem(it["code"], it["message"], tuple(it["hints"]), tuple(it["place"]) if it["place"] else None)
            for it in problems
        )

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def code(self) -> str:
        """Code of the first problem; of a wrong argument ``argument``."""
        found = re.search(r"error\[([a-z0-9-]+)\]", str(self))
        return self.problems[0].code if self.problems else found[1] if found else "argument"

    @property
    def hints(self) -> Tuple[str, ...]:
        """Allowed values and next steps, of all problems."""
        return tuple(hint for problem in self.problems for hint in problem.hints)

    @property
    def place(self) -> Optional[Tuple[str, int, int]]:
        """File, line and column (from 1) of the first problem that has a place."""
        return next((problem.place for problem in self.problems if problem.place), None)

    def __reduce__(self):
        problems = [dict(code=p.code, message=p.message, hints=p.hints, place=p.place) for p in self.problems]
        return type(self), (str(self), problems)


class BadValue(Error, ValueError):
    """An argument with a value that is not allowed."""


class BadType(Error, TypeError):
    """An argument of a type that is not allowed."""


class NotFound(Error, KeyError):
    """A name that a dataset does not have."""


class OutOfRange(Error, IndexError):
    """A number beyond the end of what it counts."""


class AlreadyThere(Error, FileExistsError):
    """A folder that would be written is there already."""


class NotThere(Error, FileNotFoundError):
    """A file or folder that is read is not there."""
