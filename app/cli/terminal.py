"""A command from its arguments to its exit status; the one place where its errors end."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from types import FrameType
from typing import TypeVar

from app.cli.parser import read_arguments
from app.cli.window_request import WindowRequest
from app.jobs.error_log import Defect, defect_of, log_user_error
from app.settings.language import system_language
from processing.core.errors import Cancelled, UserError

StatusT = TypeVar("StatusT")
DONE, DEFECT, BAD_INPUT, CANCELLED = 0, 1, 2, 3


def run_in_terminal(arguments: Sequence[str]) -> int | WindowRequest:
    """Run a command.

    Returns
    -------
    int or WindowRequest
        The exit status: 0 done, 1 a defect, 2 bad input, 3 cancelled; or what the window is to
        show.
    """
    signal.signal(signal.SIGTERM, _stop)

    def act() -> int | WindowRequest:
        command, namespace = read_arguments(arguments)
        return command(namespace)

    return end_with_status(act)


def end_with_status(act: Callable[[], StatusT]) -> StatusT | int:
    """Do something; whatever goes wrong ends here, as one line and an exit status."""
    try:
        return act()
    except UserError as error:
        log_user_error(error)
        say(error.line(system_language()))
        return BAD_INPUT
    except (Cancelled, KeyboardInterrupt):
        return CANCELLED
    except BrokenPipeError:
        # The reader of our output has gone, as “head” does; there is nobody to tell.
        sys.stderr.close()
        return DONE
    except Exception as error:  # noqa: BLE001 - the last stop: told in one sentence and logged
        told = defect_of(error)
        say(told.line(system_language()))
        return DEFECT if isinstance(told, Defect) else BAD_INPUT


def say(line: str) -> None:
    """Write a line to standard error."""
    print(line, file=sys.stderr)  # noqa: T201 - the terminal is where this belongs


def _stop(_signal: int, _frame: FrameType | None) -> None:
    raise Cancelled
