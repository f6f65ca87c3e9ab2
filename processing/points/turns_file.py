"""The turns of a drive as they are kept in its folder."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.errors import BadFile, told_as_user_error
from processing.points.array_files import read_arrays
from processing.points.turns import Turns
from processing.text import Text

_FILE_NAME = "turns.npz"


def write_turns(folder: Path, turns: Turns) -> None:
    """Write a drive's turns into its folder."""
    path = folder / _FILE_NAME
    with told_as_user_error(path):
        np.savez(
            path,
            allow_pickle=False,
            method=np.array(turns.method),
            turn_rate_hz=np.array(turns.turn_rate_hz),
            pulse_rate_hz=np.array(turns.pulse_rate_hz),
            pulses_per_turn=np.array(turns.pulses_per_turn),
            reference_times=turns.reference_times,
            fold_pulses=turns.fold_pulses,
            segments=turns.segments,
            row_ends=turns.row_ends,
            coherence=np.array(turns.coherence),
        )


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
            stored = read_arrays(path)
            turns = Turns(
                method=str(stored["method"]),
                turn_rate_hz=float(stored["turn_rate_hz"]),
                pulse_rate_hz=float(stored["pulse_rate_hz"]),
                pulses_per_turn=float(stored["pulses_per_turn"]),
                reference_times=stored["reference_times"],
                fold_pulses=stored["fold_pulses"],
                segments=stored["segments"],
                row_ends=stored["row_ends"],
                coherence=float(stored["coherence"]),
            )
            _check(turns)
        except (ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise BadFile(
                Text("The rows of a drive are damaged.", "走行データの行データが壊れています。"),
                Text.same(f"{path}: {error}"),
                Text(
                    "Import the drive again from the delivered files.",
                    "納品ファイルから走行データを再インポートしてください。",
                ),
            ) from error
    return turns


def _check(turns: Turns) -> None:
    """Refuse by a ValueError what rows and kernels can't go by."""
    rates = (turns.turn_rate_hz, turns.pulse_rate_hz, turns.pulses_per_turn)
    if not all(0 < rate < math.inf for rate in rates):
        message = f"rates {rates}"
        raise ValueError(message)
    count = turns.row_ends.size
    # The type of an array's values is the array's own.
    shapes: dict[str, tuple[NDArray[Any], type, int]] = {
        "reference_times": (turns.reference_times, np.float64, count + 1),
        "fold_pulses": (turns.fold_pulses, np.int64, count + 1),
        "segments": (turns.segments, np.int32, count),
        "row_ends": (turns.row_ends, np.int64, count),
    }
    for name, (values, dtype, size) in shapes.items():
        if not count or values.shape != (size,) or values.dtype != dtype:
            raise ValueError(name)
        # Numbers are compared, not subtracted: far apart ones would come round again.
        if name != "row_ends" and not (values[:-1] <= values[1:]).all():
            raise ValueError(name)
    if not np.isfinite(turns.reference_times).all():
        message = "reference_times"
        raise ValueError(message)
    folds, ends = turns.fold_pulses, turns.row_ends
    if not ((folds[:-1] <= ends) & (ends <= folds[1:])).all():
        message = "row_ends"
        raise ValueError(message)
