"""``zuka`` and ``zuka open``: the window."""

from __future__ import annotations

import argparse

from app.cli.window_request import WindowRequest
from processing.core.errors import MissingInput
from processing.core.text import Text


def command(arguments: argparse.Namespace) -> WindowRequest:
    """Ask for the window with the named project or files."""
    for path in arguments.paths:
        if not path.exists():
            raise MissingInput(
                Text(
                    "There is no such file or folder.", "ファイルまたはフォルダが見つかりません。"
                ),
                Text.same(str(path)),
                Text("Check the name.", "名前を確認してください。"),
            )
    return WindowRequest(paths=tuple(arguments.paths))
