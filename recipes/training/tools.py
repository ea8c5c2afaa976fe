"""What these scripts share: packages that may be missing, the program cosfly, and errors that a user can mend, told in a line."""

from __future__ import annotations

import argparse
import importlib
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
