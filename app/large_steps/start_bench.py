"""The window, shown once as the program shows it; prints when it was painted and took events.

Run by ``zuka bench start`` in a process of its own: ``python -m app.large_steps.start_bench``. It
prints the moment as seconds since 1970, for the process that started it to subtract from.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from app.cli.terminal import run_in_terminal
from app.loading import load_without_qt
from processing.core.output_streams import write_every_character


def show_window() -> float:
    """When the window was painted and the event loop idle, seconds since 1970."""
    run_in_terminal([])  # what the program does before it knows that a window is wanted

    # As the program itself: Qt is loaded only now.
    load_without_qt()
    from PySide6.QtCore import QTimer

    from app.application import build_window, make_application
    from app.settings.settings import Settings

    application = make_application()
    with TemporaryDirectory(prefix="zuka-") as folder:
        parts = build_window(Settings(Path(folder) / "settings.ini"), Path(folder))
        parts.window.show()
        application.processEvents()
        QTimer.singleShot(0, application.quit)
        application.exec()
        usable = time.time()
        parts.window.close()
    return usable


if __name__ == "__main__":
    write_every_character()
    sys.stdout.write(f"{show_window()}\n")
