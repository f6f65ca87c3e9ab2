"""The log: what users can send with a report, and the sentence for a defect of the program."""

from __future__ import annotations

import logging
from pathlib import Path

from platformdirs import user_log_path

from processing.core.errors import NoSpace, UserError
from processing.core.text import Text

_LOG = logging.getLogger("zuka")


class Defect(UserError):
    """A fault of the program itself, told in one sentence; the log has the rest."""


def log_path() -> Path:
    """Where the log is written."""
    return user_log_path("zuka", appauthor=False) / "zuka.log"


def start_log() -> None:
    """Write the log to its file from now on; without one where the disk refuses."""
    _LOG.setLevel(logging.INFO)
    _LOG.propagate = False
    try:
        log_path().parent.mkdir(parents=True, exist_ok=True)
        # Names of files may be no text.
        handler: logging.Handler = logging.FileHandler(
            log_path(), encoding="utf-8", errors="backslashreplace", delay=True
        )
    except OSError:
        handler = logging.NullHandler()
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    _LOG.handlers = [handler]


def log_user_error(error: UserError) -> None:
    """Note what a user was told."""
    _LOG.warning(error.line("en"))


def defect_of(error: BaseException) -> UserError:
    """Note an unexpected error with its traceback; gives what to tell the user.

    Returns
    -------
    UserError
        A `Defect`; or `NoSpace` where memory was short, which is none of the program's.
    """
    _LOG.error("defect", exc_info=error)
    if isinstance(error, MemoryError):
        return NoSpace(
            Text("There is not enough memory for this.", "メモリーが不足しています。"),
            Text.same(str(error) or type(error).__name__),
            Text(
                "Close other programs or take a smaller part; nothing you saved is lost.",
                "ほかのプログラムを閉じるか、範囲を小さくしてください。"
                "保存済みの内容は失われていません。",
            ),
        )
    return Defect(
        Text(
            f"Zuka has a defect here: {type(error).__name__}: {error}.",
            f"Zukaの不具合です（{type(error).__name__}: {error}）。",
        ),
        Text.same(str(log_path())),
        Text(
            "Nothing you saved is lost; please report it and send the log.",
            "保存済みの内容は失われていません。ログを添えてご報告ください。",
        ),
    )
