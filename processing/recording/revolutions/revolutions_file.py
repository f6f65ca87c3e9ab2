"""The revolutions of a drive as they are kept in its folder."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.recording.columns.array_files import read_arrays
from processing.recording.revolutions.revolutions import Revolutions

_FILE_NAME = "revolutions.npz"


def write_revolutions(folder: Path, revolutions: Revolutions) -> None:
    """Write a drive's revolutions into its folder."""
    path = folder / _FILE_NAME
    with report_as_user_error(path):
        np.savez(
            path,
            allow_pickle=False,
            method=np.array(revolutions.method),
            revolution_rate_hz=np.array(revolutions.revolution_rate_hz),
            pulse_rate_hz=np.array(revolutions.pulse_rate_hz),
            pulses_per_revolution=np.array(revolutions.pulses_per_revolution),
            reference_times=revolutions.reference_times,
            fold_pulses=revolutions.fold_pulses,
            segments=revolutions.segments,
            row_ends=revolutions.row_ends,
            coherence=np.array(revolutions.coherence),
        )


def read_revolutions(folder: Path) -> Revolutions | None:
    """A drive's revolutions; None when it has none.

    Raises
    ------
    BadFile
        The file is damaged.
    """
    path = folder / _FILE_NAME
    if not path.is_file():
        return None
    with report_as_user_error(path):
        try:
            stored = read_arrays(path)
            revolutions = Revolutions(
                method=str(stored["method"]),
                revolution_rate_hz=float(stored["revolution_rate_hz"]),
                pulse_rate_hz=float(stored["pulse_rate_hz"]),
                pulses_per_revolution=float(stored["pulses_per_revolution"]),
                reference_times=stored["reference_times"],
                fold_pulses=stored["fold_pulses"],
                segments=stored["segments"],
                row_ends=stored["row_ends"],
                coherence=float(stored["coherence"]),
            )
            _check(revolutions)
        except (ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise BadFile(
                Text("The rows of a drive are damaged.", "走行データの行データが壊れています。"),
                Text.same(f"{path}: {error}"),
                Text(
                    "Import the drive again from the delivered files.",
                    "納品ファイルから走行データを再インポートしてください。",
                ),
            ) from error
    return revolutions


def _check(revolutions: Revolutions) -> None:
    """Refuse by a ValueError what rows and kernels can't go by."""
    rates = (
        revolutions.revolution_rate_hz,
        revolutions.pulse_rate_hz,
        revolutions.pulses_per_revolution,
    )
    if not all(0 < rate < math.inf for rate in rates):
        message = f"rates {rates}"
        raise ValueError(message)
    count = revolutions.row_ends.size
    # The type of an array's values is the array's own.
    shapes: dict[str, tuple[NDArray[Any], type, int]] = {
        "reference_times": (revolutions.reference_times, np.float64, count + 1),
        "fold_pulses": (revolutions.fold_pulses, np.int64, count + 1),
        "segments": (revolutions.segments, np.int32, count),
        "row_ends": (revolutions.row_ends, np.int64, count),
    }
    for name, (values, dtype, size) in shapes.items():
        if not count or values.shape != (size,) or values.dtype != dtype:
            raise ValueError(name)
        # Numbers are compared, not subtracted: far apart ones would come round again.
        if name != "row_ends" and not (values[:-1] <= values[1:]).all():
            raise ValueError(name)
    if not np.isfinite(revolutions.reference_times).all():
        message = "reference_times"
        raise ValueError(message)
    folds, ends = revolutions.fold_pulses, revolutions.row_ends
    if not ((folds[:-1] <= ends) & (ends <= folds[1:])).all():
        message = "row_ends"
        raise ValueError(message)
