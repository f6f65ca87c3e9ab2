"""Why there are few curbs or none, in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

from processing.core.text import Text
from processing.methods.road.curbs.steps.curb_profile import StepSettings
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.recording.drive import Drive
from processing.recording.passes import passes_of

NOTHING_TO_SAY = Text("", "")


def note_on(
    drives: Sequence[Drive], runs: Sequence[StepRun], settings: StepSettings, found: int
) -> Text:
    """What a person should know of a result; empty where there is nothing to explain.

    Parameters
    ----------
    runs : sequence of StepRun
        Of all drives.
    found : int
        How many curbs they came to.
    """
    if not any(passes_of(drive) for drive in drives):
        return Text(
            "The vehicle hardly moved, so there is no road to look along.",
            "車両がほとんど移動していないため、道路に沿った抽出ができません。",
        )
    if not runs:
        return Text(
            "No step of {low:.0f} to {high:.0f} cm was found beside the way: there are no curbs, "
            "or too few points show them.",
            "走行経路の両側に高さ{low:.0f}～{high:.0f}cmの段差が見つかりません。"
            "縁石がないか、点が不足しています。",
        ).filled(low=100 * settings.least_step_m, high=100 * settings.most_step_m)
    if not found:
        return Text(
            "Steps were seen, but nowhere along a metre do enough points show carriageway, face "
            "and top.",
            "段差は見つかりましたが、車道面・側面・天端面を示す点が1m以上続いて得られません。",
        )
    silent = [drive.info.name for n, drive in enumerate(drives) if all(r.drive != n for r in runs)]
    if silent:
        return Text(
            "Not every scanner shows curbs; none are seen by: {names}.",
            "縁石が見つからないスキャナーがあります: {names}",
        ).filled(names=", ".join(silent))
    return NOTHING_TO_SAY
