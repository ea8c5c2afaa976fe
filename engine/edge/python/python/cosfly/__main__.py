"""The command line: ``cosfly`` or ``python -m cosfly``."""

import signal
import sys

from . import _cosfly


def main() -> None:
    """Run the command line with the arguments of the process."""
    # Ctrl-C ends commands as it does without Python; `cosfly run` keeps finished items.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    sys.exit(_cosfly.main(sys.argv[1:]))


if __name__ == "__main__":
    main()
