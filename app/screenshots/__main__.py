"""``python -m app.screenshots OUT``: pictures of every tool and form, in use."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtTest import QTest

from app.application import build_window, make_application
from app.screenshots.checking import CHECKING
from app.screenshots.drawing import DRAWING
from app.screenshots.editing import EDITING
from app.screenshots.forms import FORMS, WITHOUT_STREET
from app.screenshots.frame import FRAME
from app.screenshots.painting import PAINTING
from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import SimulatedMouse
from app.screenshots.street import draw_street, open_street
from app.screenshots.views import VIEWS
from app.settings.settings import Settings
from app.settings.theme import ThemeChoice
from processing.core.output_streams import write_every_character
from processing.core.text import Language

ON_STREET: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    **FRAME,
    **VIEWS,
    **CHECKING,
    **PAINTING,
    **DRAWING,
    **EDITING,
    **FORMS,
}
NOTHING_OPEN: Mapping[str, Callable[[ScreenshotWindow], None]] = WITHOUT_STREET
_LANGUAGES: Mapping[str, tuple[Language, ...]] = {
    "en": ("en",),
    "ja": ("ja",),
    "both": ("en", "ja"),
}


def main(arguments: Sequence[str]) -> int:
    """Make the pictures that are asked for; gives the exit status."""
    parser = argparse.ArgumentParser(prog="python -m app.screenshots", description=__doc__)
    parser.add_argument("out", type=Path, help="folder of the pictures")
    parser.add_argument("--language", choices=tuple(_LANGUAGES), default="both")
    parser.add_argument("--size", type=_size, default=(1366, 768), metavar="WIDTHxHEIGHT")
    parser.add_argument("--theme", choices=("light", "dark"), default="light")
    known = (*ON_STREET, *NOTHING_OPEN)
    parser.add_argument("--only", nargs="+", choices=known, default=known, metavar="NAME")
    chosen = parser.parse_args(arguments)
    chosen.out.mkdir(parents=True, exist_ok=True)
    for language in _LANGUAGES[chosen.language]:
        with TemporaryDirectory(prefix="zuka-") as folder:
            settings = Settings(Path(folder) / "settings.ini")
            settings.choose_language(language)
            settings.choose_theme(ThemeChoice(chosen.theme))
            studio = _studio(settings, chosen.out, Path(folder), chosen.size)
            take_pictures(studio, chosen.only)
            studio.leave()
    return 0


def take_pictures(studio: ScreenshotWindow, names: Sequence[str]) -> None:
    """Make the scenes of these names, and a picture of each; nothing is open before and after."""
    if any(name in ON_STREET for name in names):
        open_street(studio)
        draw_street(studio)
        studio.remember()
    for name, make in ON_STREET.items():
        if name in names:
            make(studio)
            studio.shoot(name)
            studio.restore()
    studio.parts.document.close()
    for name, make in NOTHING_OPEN.items():
        if name in names:
            make(studio)
            studio.shoot(name)
            studio.tidy()
    studio.parts.document.close()


def _studio(
    settings: Settings, out: Path, scratch: Path, size: tuple[int, int]
) -> ScreenshotWindow:
    """A window of this size in the corner of the screen."""
    make_application().setCursorFlashTime(0)  # a caret that comes and goes never rests
    parts = build_window(settings, scratch / "projects")
    parts.window.resize(*size)
    parts.window.move(0, 0)
    parts.window.show()
    QTest.qWaitForWindowActive(parts.window)
    return ScreenshotWindow(parts, out, scratch, SimulatedMouse())


def _size(words: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{3,4})x(\d{3,4})", words)
    if found is None:
        raise argparse.ArgumentTypeError(f"{words!r} is no size such as 1366x768")
    return int(found[1]), int(found[2])


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
