"""Why the document refuses what somebody wanted, in sentences."""

from __future__ import annotations

from processing.core.errors import OutOfRange, UserError
from processing.core.text import Text


def refuse_changed() -> UserError:
    """What a change is about has become something else."""
    return OutOfRange(
        Text(
            "The feature was changed while you edited it; it stays as it is now.",
            "編集中に地物が変更されたため、現在の状態のままにしました。",
        ),
        Text("the map", "地図"),
        Text("Do your edit again.", "もう一度編集してください。"),
    )
