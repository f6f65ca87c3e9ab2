"""How a reading of the map of change is said, the same words in every view."""

from __future__ import annotations

from processing.core.text import Text
from processing.methods.earthwork.maps.change_reading import ChangeReading
from widgets.parts.number_field import coordinate

_WORDS = Text(
    "{change} m (before {before}, after {after})", "{change} m（前 {before}、後 {after}）"
)
_FILLED = Text(
    "{change} m (before {before}, after {after}; filled in)",
    "{change} m（前 {before}、後 {after}、補間）",
)


def format_difference(value: float, digits: int = 3) -> str:
    """A difference with its sign, as surveyors read it: ``+0.234``, ``−1.050``, ``0.000``."""
    words = f"{abs(value):,.{digits}f}"
    if not words.strip("0.,"):
        return words
    return f"−{words}" if value < 0 else f"+{words}"


def change_words(reading: ChangeReading) -> Text:
    """By how much the later ground is higher, and both heights."""
    return (_WORDS if reading.is_measured else _FILLED).filled(
        change=format_difference(reading.change_m),
        before=coordinate(reading.before_m),
        after=coordinate(reading.after_m),
    )
