"""Tools that find lines along a road on known streets: what each found, as a table of the page."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    found_by,
    given_scenes,
    options_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.scoring.features.file_scores import FileScore
from processing.scoring.features.mapped_features import MappedFile


class LinesOfStreet(NamedTuple):
    """What was found on one street."""

    street: str
    score: FileScore


@dataclass(frozen=True)
class LineTable:
    """A tool's table.

    Attributes
    ----------
    tool : str
        Its id, which is the truth's name too.
    score : callable
        Holds a result against a truth.
    heading : str
    section_of : callable
        The section below the heading.
    seeds : str
        Of the streets, if nothing else is asked.
    styles : tuple of str
        That take turns.
    length_m : float
    """

    tool: str
    score: Callable[[MappedFile, MappedFile], FileScore]
    heading: str
    section_of: Callable[[Sequence[LinesOfStreet]], str]
    seeds: str
    styles: tuple[str, ...]
    length_m: float = 60.0

    def request_of(self, number: int, seed: int, length_m: float) -> StreetRequest:
        """The street of a seed: styles and scanners take turns, every other one is worn."""
        make = worn_options_of if number % 2 else options_of
        style = self.styles[number % len(self.styles)]
        return replace(make(number, seed, length_m), style=style, passes=1, stops=False)

    def rows_of(self, scenes: Iterator[RoadScene]) -> Iterator[LinesOfStreet]:
        """What the tool finds with its own parameters on each."""
        for scene in scenes:
            result = found_by(self.tool, scene.drives).result
            yield LinesOfStreet(scene.name, self.score(result, read_mapped(scene.truth(self.tool))))

    def write(self, description: str | None, arguments: Sequence[str] | None) -> None:
        """Write the table to a page, or to standard output, as a command's words ask."""
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--markdown", type=Path)
        parser.add_argument("--seeds", default=self.seeds)
        parser.add_argument("--length", type=float, default=self.length_m)
        parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
        asked = parser.parse_args(arguments)
        own = simulated_scenes(seeds_of(asked.seeds), asked.length, self.request_of)
        rows = [*self.rows_of(own), *self.rows_of(given_scenes(asked.deliveries))]
        write_sections(asked.markdown, {self.heading: self.section_of(rows)})
