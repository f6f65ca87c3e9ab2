"""What each command of the bootstrap does, step by step."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from installer import system_packages, translations
from installer.display import has_display, virtual_display
from installer.environment import Environment
from installer.steps import Stop, fingerprint, status_of, tell

DEMO_OUTPUT = "demo-output"
SCREENSHOTS = "screenshots"
_LARGE_SCREEN = "2560x1440x24"
_MOST_TEST_PROCESSES = 6
"""Each takes up to 2 GB, and the longest test takes a while whatever runs beside it."""

CHECKS: tuple[tuple[str, ...], ...] = (
    ("ruff", "format", "--check", "--quiet", "."),
    ("ruff", "check", "--quiet", "."),
    ("mypy",),
    ("lint-imports", "--no-cache"),
)


def run(command: str, root: Path, arguments: Sequence[str]) -> int:
    """Set up the checkout, then do what the command asks for.

    Parameters
    ----------
    command : str
        ``setup``, ``demo``, ``test``, ``screenshots`` or ``translations``.
    root : Path
        The checkout.
    arguments : Sequence[str]
        For ``test``: added to pytest's command line; for ``screenshots``: to its own.

    Returns
    -------
    int
        The exit status; a stop has printed its one line.
    """
    environment = Environment(root, os.environ)
    try:
        set_up(environment)
        if command == "demo":
            return _demo(environment)
        if command == "test":
            return _test(environment, arguments)
        if command == "screenshots":
            return _screenshots(environment, arguments)
        if command == "translations":
            translations.collect(environment, root / translations.FOLDER)
            translations.compile_all(environment)
    except Stop as stop:
        tell(str(stop))
        return stop.status
    return 0


def set_up(environment: Environment) -> None:
    """Make everything that the program needs to run; what is there already is left alone."""
    system_packages.provide(environment.variables)
    environment.prepare()
    translations.compile_all(environment)
    _warm_kernels(environment)


def _warm_kernels(environment: Environment) -> None:
    sources = (environment.root / "processing").rglob("*.py")
    lock = environment.root / "requirements.lock"
    stamp, mark = environment.stamp("kernels"), fingerprint([*sources, lock])
    if stamp.fits(mark):
        return
    stamp.lift()
    tell("compiling the kernels")
    environment.run("python", "-m", "installer.warm_kernels")
    stamp.set(mark)


def _demo(environment: Environment) -> int:
    program = environment.program("zuka")
    if has_display(environment.variables):
        return status_of(
            [program, "demo"], folder=environment.root, environment=environment.variables
        )
    tell(f"there is no display: the demo runs by itself and leaves its results in {DEMO_OUTPUT}/")
    with virtual_display(environment.variables) as variables:
        return status_of(
            [program, "demo", "--headless", "--out", DEMO_OUTPUT],
            folder=environment.root,
            environment=variables,
        )


def _test(environment: Environment, pytest_arguments: Sequence[str]) -> int:
    for program, *arguments in CHECKS:
        tell(" ".join((program, *arguments)))
        environment.run(program, *arguments)
    sys.stderr.flush()
    beside = ("--numprocesses", str(processes_for_tests()), "--dist", "worksteal")
    with virtual_display(environment.variables) as variables:
        return status_of(
            [environment.program("python"), "-m", "pytest", *beside, *pytest_arguments],
            folder=environment.root,
            environment=variables,
        )


def processes_for_tests() -> int:
    """Give how many processes run the tests: one a core, and no more than memory bears."""
    return max(2, min(_MOST_TEST_PROCESSES, os.cpu_count() or 1))


def _screenshots(environment: Environment, arguments: Sequence[str]) -> int:
    """Take the pictures on a screen of their own, so that nothing else is on them."""
    with virtual_display(environment.variables, _LARGE_SCREEN) as variables:
        return status_of(
            [environment.program("python"), "-m", "app.screenshots", SCREENSHOTS, *arguments],
            folder=environment.root,
            environment=variables,
        )
