"""What these scripts share: packages that may be missing, the program cosfly, and errors that a user can mend, told in a line."""

from __future__ import annotations

import argparse
import importlib
import pathlib
import subprocess
import sys
from typing import Any, Callable, List

PACKAGES = {
    "torch": "`apt-get install python3-torch libopenblas0` on Debian and Ubuntu, `pip install torch` elsewhere",
    "cosfly": "`pip install .` in the repository",
    "PIL": "`pip install pillow`",
}


def need(*names: str) -> None:
    """Ends the script where a package is missing, and says how to install it."""
    for name in names:
        try:
            importlib.import_module(name)
        except ImportError as error:
            missing = (error.name or name).split(".")[0]
            raise SystemExit(f"{missing} is missing: {PACKAGES.get(missing, f'`pip install {missing}`')}") from None


def counted(text: str) -> int:
    """A whole number from 1 on, for `argparse`."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"`{text}` is no whole number from 1 on")
    return int(text)


def flown_anew(parser: argparse.ArgumentParser, suites: List[str]) -> argparse.Namespace:
    """The command line of a script that learns from flights over new walks of suites: the file that it writes, and a new folder for its work."""
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--cosfly", default="cosfly", help="the program (default: cosfly)")
    parser.add_argument("--store", help="folder of the store, as for `cosfly run`")
    parser.add_argument("--suites", nargs="+", default=suites, help="suites whose walks are drawn anew, never those of the judge")
    parser.add_argument("--seed", type=int, default=7001, help="seed of these walks and of the network (default: 7001)")
    given = parser.parse_args()
    if given.work.exists() and any(given.work.iterdir()):
        parser.error(f"{given.work} is not empty; give a new folder")
    given.work.mkdir(parents=True, exist_ok=True)
    return given


def cosfly(command: List[Any], **options: Any) -> subprocess.CompletedProcess:
    """Runs the program; where it fails, the script ends with its exit code, and its words are above."""
    try:
        done = subprocess.run([str(word) for word in command], **options)
    except OSError as error:
        raise SystemExit(f"cannot start `{command[0]}`: {error.strerror}; name the program with `--cosfly`") from None
    if done.returncode:
        raise SystemExit(done.returncode)
    return done


def script(main: Callable[[], Any]) -> None:
    """Runs a script's `main`; files that cannot be read or written, and cosfly's errors, are told in a line."""
    try:
        main()
    except OSError as error:
        raise SystemExit(f"`{error.filename}`: {error.strerror}" if error.filename else str(error)) from None
    except Exception as error:
        if not isinstance(error, getattr(sys.modules.get("cosfly"), "Error", ())):
            raise
        raise SystemExit(str(error)) from None
