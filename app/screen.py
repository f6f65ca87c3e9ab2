"""The screen that a window needs: one sentence where there is none, instead of an abort of Qt's."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Mapping, Sequence

from processing.core.errors import MissingInput
from processing.core.text import Text

_VIRTUAL = ("xvfb-run", "-a", "-s", "-screen 0 1600x1000x24 -nolisten tcp")
"""A screen that nobody sees, and OpenGL on it; it goes with the program."""


def has_screen(variables: Mapping[str, str]) -> bool:
    """Whether the system says on which screen windows are shown, or which other way was chosen."""
    if not sys.platform.startswith("linux"):
        return True
    named = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    return any(variables.get(name) for name in named)


def find_screen(arguments: Sequence[str], *, needs_person: bool) -> None:
    """Go on where there is a screen; else start again on a virtual one, if nobody has to see it.

    Parameters
    ----------
    arguments : sequence of str
        Of this process, without the program's name.
    needs_person : bool
        Whether the window is for somebody to look at.

    Raises
    ------
    MissingInput
        There is no screen, or nothing to make a virtual one with.
    """
    if has_screen(os.environ):
        return
    if needs_person:
        raise MissingInput(
            Text("There is no screen for the window.", "ウィンドウを表示する画面がありません。"),
            Text("DISPLAY, WAYLAND_DISPLAY", "DISPLAY、WAYLAND_DISPLAY"),
            Text(
                "Start it in a desktop session, or use the commands that zuka --help lists.",
                "デスクトップ環境で起動するか、zuka --help に示すコマンドを使ってください。",
            ),
        )
    program = shutil.which(_VIRTUAL[0])
    if program is None:
        raise MissingInput(
            Text("There is no screen, and no virtual one.", "画面も仮想画面もありません。"),
            Text("DISPLAY, xvfb-run", "DISPLAY、xvfb-run"),
            Text(
                "Install the package xvfb and run it again.",
                "xvfbパッケージをインストールして、もう一度実行してください。",
            ),
        )
    itself = () if getattr(sys, "frozen", False) else ("-P", "-m", "app")
    os.execv(program, [*_VIRTUAL, sys.executable, *itself, *arguments])  # noqa: S606 - ours
