"""Plug-in tools, loaded before any command and before the window."""

from __future__ import annotations

from app.cli.terminal import say
from app.jobs.error_log import log_user_error
from app.settings.language import system_language
from processing.tools.plugins.folders import plugin_files, plugin_folders


def load_own_tools() -> None:
    """Load the plug-ins of the user and the office; those that can't be are told by name.

    Without any, none of the program's own tools is loaded either: most commands need none.
    """
    files = plugin_files(plugin_folders())
    if not files:
        return
    from processing.tools.plugins.loading import load_plugins

    for error in load_plugins(files):
        log_user_error(error)
        say(error.line(system_language()))
