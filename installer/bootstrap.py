"""From a fresh checkout to the demo or the tests: ``python installer/bootstrap.py demo``.

Uses the standard library only. This file stays readable for old interpreters, so that the
check of the version below can speak before anything else fails.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OLDEST, TOO_NEW = (3, 11), (3, 14)
COMMANDS = {
    "setup": "make the environment in .venv",
    "demo": "set up, then run the demo (by itself where there is no display)",
    "test": "set up, then run every check and test; what follows -- goes to pytest",
    "screenshots": "set up, then take pictures of every tool and form in use",
    "translations": "set up, then collect the texts for translation and compile them",
}


def version_complaint(version: "tuple[int, int]") -> str:
    """One sentence when the interpreter is not one Zuka runs on; empty when it is."""
    if OLDEST <= version < TOO_NEW:
        return ""
    found = ".".join(str(part) for part in version)
    return (
        f"Zuka needs Python 3.11, 3.12 or 3.13, and this is Python {found} ({sys.executable}); "
        f"run the command again with one of those, for example: make PYTHON=python3.11 demo"
    )


def main() -> int:
    """Run the command given on the command line; gives its exit status."""
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="\n".join(f"{name:13} {words}" for name, words in COMMANDS.items()),
    )
    parser.add_argument("command", choices=tuple(COMMANDS))
    parser.add_argument(
        "more", nargs="*", metavar="-- ARGS", help="for test: pytest's; for screenshots: its own"
    )
    chosen = parser.parse_args()
    complaint = version_complaint(sys.version_info[:2])
    if complaint:
        sys.stderr.write(complaint + "\n")
        return 2
    sys.path.insert(0, str(ROOT))
    from installer.commands import run

    return run(chosen.command, ROOT, tuple(chosen.more))


if __name__ == "__main__":
    sys.exit(main())
