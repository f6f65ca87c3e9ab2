"""What goes wrong without anybody being told: in slots, in threads, in the log, in Qt itself."""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

from PySide6.QtCore import QMessageLogContext, QtMsgType, qInstallMessageHandler
from typing_extensions import override

_QUIET = ("propagateSizeHints", "This plugin does not support")


class _Defects(logging.Handler):
    """Notes the defects that the program logs."""

    def __init__(self, troubles: list[str]) -> None:
        super().__init__(logging.ERROR)
        self._troubles = troubles

    @override
    def emit(self, record: logging.LogRecord) -> None:
        error = record.exc_info[1] if record.exc_info else None
        self._troubles.append(_reported(error) if error else record.getMessage())


@contextmanager
def watched() -> Iterator[list[str]]:
    """A list to which everything is added that goes wrong while it lasts."""
    troubles: list[str] = []

    def take(
        _kind: type[BaseException], error: BaseException, _trace: TracebackType | None
    ) -> None:
        troubles.append(_reported(error))

    def take_from_thread(failure: threading.ExceptHookArgs) -> None:
        if failure.exc_value is not None:
            troubles.append(_reported(failure.exc_value))

    def take_from_qt(kind: QtMsgType, _context: QMessageLogContext, message: str) -> None:
        if kind is not QtMsgType.QtDebugMsg and not any(word in message for word in _QUIET):
            troubles.append(f"Qt: {message}")

    defects, log = _Defects(troubles), logging.getLogger("zuka")
    hook, thread_hook = sys.excepthook, threading.excepthook
    sys.excepthook, threading.excepthook = take, take_from_thread
    qt_hook = qInstallMessageHandler(take_from_qt)
    log.addHandler(defects)
    try:
        yield troubles
    finally:
        sys.excepthook, threading.excepthook = hook, thread_hook
        qInstallMessageHandler(qt_hook)
        log.removeHandler(defects)


def _reported(error: BaseException) -> str:
    return "".join(traceback.format_exception(error))
