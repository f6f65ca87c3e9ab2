"""Terminal or window: decided here, so that Qt is imported only for the window."""

from __future__ import annotations

import sys

from app.cli.automation.own_tools import load_own_tools
from app.cli.terminal import end_with_status, run_in_terminal
from app.jobs.error_log import start_log
from app.limits import refuse_tight_limits
from app.loading import load_without_qt
from app.screen import find_screen
from processing.core.output_streams import write_every_character


def main() -> int:
    """Run the program with the process's arguments; gives its exit status."""
    write_every_character()
    start_log()
    arguments = sys.argv[1:]
    refusal = end_with_status(refuse_tight_limits)
    if refusal is not None:
        return refusal
    load_own_tools()
    request = run_in_terminal(arguments)
    if isinstance(request, int):
        return request

    def show() -> int:
        find_screen(arguments, needs_person=request.headless_out is None)
        load_without_qt()
        from app.application import run_window

        return run_window(request)

    return end_with_status(show)


if __name__ == "__main__":
    sys.exit(main())
