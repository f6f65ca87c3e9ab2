"""What is said where the pulse numbers of a drive can't be what was written."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.recording.columns.columns import column_path


def damaged_pulses(folder: Path | None) -> BadFile:
    """The error for pulses that fall, or that lie outside of their rows.

    Parameters
    ----------
    folder : Path or None
        The drive's; None where the pulses are in memory only.
    """
    return BadFile(
        Text(
            "The pulse numbers of a drive don't fit its rows: the column is damaged.",
            "走行データのパルス番号が行と一致しません。列データが壊れています。",
        ),
        Text.same("pulse" if folder is None else str(column_path(folder, "pulse"))),
        Text(
            "Try once more, as the rows are then found anew; if it stays, remove the drive and "
            "import it again from the delivered files.",
            "もう一度実行してください（行を検出し直します）。解消しない場合は、"
            "走行データを除いてから、納品ファイルを再インポートしてください。",
        ),
    )
