"""The turns of a drive as they are kept in its folder."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from processing.errors import BadFile, told_as_user_error
from processing.points.turns import Turns
from processing.text import Text

_FILE_NAME = "turns.npz"
_NUMBERS = ("turn_rate_hz", "pulse_rate_hz", "pulses_per_turn", "coherence")
_ARRAYS = ("reference_times", "fold_pulses", "segments", "row_ends")


def write_turns(folder: Path, turns: Turns) -> None:
    """Write a drive's turns into its folder."""
    path = folder / _FILE_NAME
    values = {name: getattr(turns, name) for name in (*_NUMBERS, *_ARRAYS)}
    with told_as_user_error(path):
        np.savez(path, allow_pickle=False, method=turns.method, **values)


def read_turns(folder: Path) -> Turns | None:
    """A drive's turns; None when it has none.

    Raises
    ------
    BadFile
        The file is damaged.
    """
    path = folder / _FILE_NAME
    if not path.is_file():
        return None
    with told_as_user_error(path):
        try:
            with np.load(path, allow_pickle=False) as stored:
                numbers = {name: float(stored[name]) for name in _NUMBERS}
                arrays = {name: stored[name] for name in _ARRAYS}
                return Turns(method=str(stored["method"]), **numbers, **arrays)
        except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise BadFile(
                Text("The rows of a drive are damaged.", "ドライブの行データが壊れています。"),
                Text.same(f"{path}: {error}"),
                Text(
                    "Import the drive again from the delivered files.",
                    "納品ファイルからドライブを再インポートしてください。",
                ),
            ) from error
