"""What each command of the bootstrap does, step by step."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
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
        set_up(environment, only_for_demo=command == "demo")
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


def set_up(environment: Environment, *, only_for_demo: bool = False) -> None:
    """Make everything that the program needs to run; what is there already is left alone.

    Parameters
    ----------
    only_for_demo : bool
        Leave out the kernels that the demo doesn't use.
    """
    system_packages.provide(environment.variables)
    environment.prepare()
    translations.compile_all(environment)
    compile_modules(environment)
    _warm_kernels(environment, only_for_demo=only_for_demo)


def compile_modules(environment: Environment) -> None:
    """Leave the byte code of all modules beside them; what is up to date is only looked at.

    Where Python may not write it, each start of the program would compile a thousand files: a third
    of the time until it answers.
    """
    words = "-m", "compileall", "-q", "-j", "0"
    environment.run("python", *words, "app", "processing", "resources", "widgets")


def _kernels_mark(environment: Environment) -> str:
    sources = (environment.root / "processing").rglob("*.py")
    return fingerprint([*sources, environment.root / "requirements.lock"])


def _warm_kernels(environment: Environment, *, only_for_demo: bool) -> None:
    """Compile the kernels; those whose sources are the same are only looked up."""
    stamp, some = environment.stamp("kernels"), environment.stamp("demo-kernels")
    mark = _kernels_mark(environment)
    if stamp.fits(mark) or (only_for_demo and some.fits(mark)):
        return
    made, options = (some, ("--demo",)) if only_for_demo else (stamp, ())
    made.lift()
    tell("compiling the kernels" + (" that the demo uses" if only_for_demo else ""))
    environment.run("python", "-m", "installer.warm_kernels", *options)
    made.set(mark)


@contextmanager
def _other_kernels_beside(environment: Environment) -> Iterator[subprocess.Popen[bytes] | None]:
    """Compile the kernels that the demo doesn't use while the body runs, as far as it gets.

    The compiler's process is given, or None where all are compiled.
    """
    stamp, mark = environment.stamp("kernels"), _kernels_mark(environment)
    if stamp.fits(mark):
        yield None
        return
    words = ("-m", "installer.warm_kernels", "--processes", "1")
    compiler = subprocess.Popen(
        [environment.program("python"), *words],
        cwd=environment.root,
        env=environment.variables,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield compiler
    finally:
        if compiler.poll() == 0:
            stamp.set(mark)
        compiler.terminate()
        compiler.wait()


def _demo(environment: Environment) -> int:
    program = environment.program("zuka")
    if has_display(environment.variables):
        with _other_kernels_beside(environment):
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
