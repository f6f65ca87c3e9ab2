"""Case: one thing that is measured, and what came out."""

from __future__ import annotations

from dataclasses import dataclass

from processing.text import Text


@dataclass(frozen=True)
class Measurement:
    """What one benchmark found.

    Attributes
    ----------
    name : str
        As it is named on the command line.
    what : Text
        What was done.
    value, unit
        The figure that is judged: a ratio where there is a peer.
    target : float
    is_at_most : bool
        Whether the target is an upper limit.
    detail : str
        The figures behind it.
    """

    name: str
    what: Text
    value: float
    unit: str
    target: float
    is_at_most: bool
    detail: str

    @property
    def is_met(self) -> bool:
        """Whether the target is reached."""
        return self.value <= self.target if self.is_at_most else self.value >= self.target
