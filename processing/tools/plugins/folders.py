"""Where plug-in tools lie: the user's own folder, and those that an office names."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from platformdirs import user_config_path

FOLDERS = "ZUKA_PLUGINS"
"""Environment variable: folders of an office, beside the user's own."""


def plugin_folders() -> tuple[Path, ...]:
    """The user's folder of plug-ins, and those of `FOLDERS`."""
    named = os.environ.get(FOLDERS, "").split(os.pathsep)
    own = user_config_path("zuka", appauthor=False) / "plugins"
    return (own, *(Path(one) for one in named if one))


def plugin_files(folders: Iterable[Path]) -> tuple[Path, ...]:
    """The plug-ins of some folders; a folder that is not there has none.

    Files whose names begin with ``_`` are parts of others.
    """
    every = (path for folder in folders if folder.is_dir() for path in sorted(folder.glob("*.py")))
    return tuple(path for path in every if not path.name.startswith("_"))
