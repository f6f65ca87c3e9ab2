"""Measurement: one thing that is measured, and what came out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.text import Text


@dataclass(frozen=True)
class BenchmarkOptions:
    """How benchmarks are wanted.

    Attributes
    ----------
    points : int or None
        Points of the large recording, and of the rows that compare with a peer on it; None: as
        many as each is meant for.
    most_points : int or None
        No benchmark takes more points than that.
    project : Path or None
        A project to use in place of one that is made; it is only read.
    share : float
        Of the repetitions and frames that are measured; less only shows that all goes well.
    """

    points: int | None = None
    most_points: int | None = None
    project: Path | None = None
    share: float = 1.0

    def limited(self, points: int) -> int:
        """So many points, or the most that are wanted."""
        return points if self.most_points is None else min(points, self.most_points)

    def repeats(self, count: int) -> int:
        """The wanted share of a number of repetitions, at least one."""
        return max(1, round(self.share * count))


@dataclass(frozen=True)
class Measurement:
    """What one benchmark found.

    Attributes
    ----------
    name : str
        As it is named on the command line; further rows of one benchmark have a word behind it.
    what : Text
        What was done.
    value, unit
        The figure that is judged: a ratio where there is a peer. None where nothing could be
        measured here; ``detail`` says why.
    target : float or None
        None where no target is set.
    is_at_most : bool
        Whether the target is an upper limit.
    detail : str
        The figures behind it.
    figures : mapping of str to float
        Those figures by name, for machines.
    """

    name: str
    what: Text
    value: float | None
    unit: str
    target: float | None
    is_at_most: bool
    detail: str
    figures: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_met(self) -> bool | None:
        """Whether the target is reached; None without a target or without a figure."""
        if self.target is None or self.value is None:
            return None
        return self.value <= self.target if self.is_at_most else self.value >= self.target


BenchmarkCase = Callable[[BenchmarkOptions], tuple[Measurement, ...]]
"""Measures, and gives the rows of its benchmark."""
