"""A screen for programs where there is none: an Xvfb of our own, gone when they are done."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from installer.steps import Stop

USUAL_SCREEN = "1600x1000x24"


def has_display(variables: Mapping[str, str]) -> bool:
    """Tell whether a window can be shown to someone."""
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(variables.get("DISPLAY") or variables.get("WAYLAND_DISPLAY"))


@contextmanager
def virtual_display(
    variables: Mapping[str, str], screen: str = USUAL_SCREEN
) -> Iterator[dict[str, str]]:
    """Give the environment of programs that draw on a virtual screen while the body runs.

    Off Linux, where windows need no such thing, the environment is given as it is.

    Parameters
    ----------
    screen : str
        Its size as Xvfb wants it: width, height and depth.

    Raises
    ------
    Stop
        When Xvfb does not start.
    """
    if not sys.platform.startswith("linux"):
        yield dict(variables)
        return
    server, number = _started(variables, screen)
    try:
        yield _drawn_on(variables, number)
    finally:
        server.terminate()
        server.wait()


def _started(variables: Mapping[str, str], screen: str) -> tuple[subprocess.Popen[bytes], str]:
    """Start Xvfb; it chooses a free display and writes the number into our pipe when ready."""
    reader, writer = os.pipe()
    command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", screen, "-nolisten", "tcp"]
    try:
        server = subprocess.Popen(
            [*command, "-noreset"],
            env=dict(variables),
            pass_fds=(writer,),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except FileNotFoundError:
        os.close(reader)
        raise Stop("Xvfb is missing; install the package xvfb and run again") from None
    finally:
        os.close(writer)
    with os.fdopen(reader) as answer:
        number = answer.readline().strip()
    if not number:
        server.wait()
        raise Stop("Xvfb does not start; run it by hand to see why: Xvfb -displayfd 1", 1)
    return server, number


def _drawn_on(variables: Mapping[str, str], number: str) -> dict[str, str]:
    given = {name: value for name, value in variables.items() if name != "WAYLAND_DISPLAY"}
    return {**given, "DISPLAY": f":{number}", "QT_QPA_PLATFORM": "xcb"}
