"""JobView: a job as panels and the status line show it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JobView:
    """A job as it is shown.

    Attributes
    ----------
    fraction : float
        0 to 1.
    text : str
        What it is doing.
    seconds_left : float or None
        None while it isn't known.
    state : {"waiting", "running", "finished", "failed", "cancelled"}
    error : str
        What, where, what to do, divided by bars; empty unless it failed.
    started : str
        The time of day when it began; empty while it waits.
    seconds : float
        How long it took; 0 until it is over.
    result : str
        What it made; empty while that isn't known.
    """

    id: str
    title: str
    fraction: float
    text: str
    seconds_left: float | None
    state: str
    error: str = ""
    started: str = ""
    seconds: float = 0.0
    result: str = ""

    @property
    def is_over(self) -> bool:
        """Whether it has ended in one way or another."""
        return self.state not in ("waiting", "running")


def time_left(seconds: float | None) -> str:
    """``0:04``, ``1:02:03``; empty while it isn't known."""
    if seconds is None:
        return ""
    whole = max(0, round(seconds))
    hours, rest = divmod(whole, 3600)
    minutes, seconds_ = divmod(rest, 60)
    return f"{hours}:{minutes:02}:{seconds_:02}" if hours else f"{minutes}:{seconds_:02}"
