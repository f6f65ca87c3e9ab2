"""The evaluation of runs as a table for spreadsheets: one row for each tool and run."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.safe_write import write_safely
from processing.project.evaluation.run_evaluation import RunEvaluation
from processing.scoring.points.reliability import ShareInterval

_DIGITS = 4


def write_evaluation(
    path: Path, evaluations: Sequence[RunEvaluation], *, never: Iterable[Path] = ()
) -> None:
    """Write evaluations as CSV: UTF-8 with its mark, columns named by ids with units.

    Of each tenth of confidence there are the number of candidates decided (``decided_0.1``: from
    0.1 up) and of those accepted.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    rows = [_row(one) for one in evaluations]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding="utf-8-sig", newline="") as file,
    ):
        table = csv.DictWriter(file, columns or ["tool"], restval="")
        table.writeheader()
        table.writerows(rows)


def _row(one: RunEvaluation) -> dict[str, str]:
    row = {
        "tool": one.tool,
        "version": str(one.version),
        "runs": " ".join(one.runs),
        "undecided": str(one.undecided),
        "accepted": str(one.accepted),
        "rejected": str(one.rejected),
        "corrected": str(one.corrected),
        "mean_shift_m": _number(one.shift_m),
        **_share("precision", one.precision),
        "drawn_by_hand": str(one.drawn),
        **_share("recall", one.recall),
        "accepted_m": _number(one.recall_by_length.hits),
        "drawn_by_hand_m": _number(one.recall_by_length.of - one.recall_by_length.hits),
        "recall_by_length": _number(one.recall_by_length.value),
        "calibration_error": _number(one.reliability.calibration_error),
    }
    for bin_ in one.reliability.bins:
        row[f"decided_{bin_.low:g}"] = f"{bin_.accepted.of:.0f}"
        row[f"accepted_{bin_.low:g}"] = f"{bin_.accepted.hits:.0f}"
    return row


def _share(name: str, share: ShareInterval) -> dict[str, str]:
    return {
        name: _number(share.value),
        f"{name}_low": _number(share.low),
        f"{name}_high": _number(share.high),
    }


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}f}" if math.isfinite(value) else ""
