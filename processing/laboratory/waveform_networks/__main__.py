"""The published local–global network, learnt on simulated flights, with the thesis' ablations.

``python -m processing.laboratory.waveform_networks --keep FOLDER --networks FOLDER``

Needs the extra ``train``. It is a laboratory reference: trees classify in the program. First
returns of the flights of ``--seeds`` are learnt from, those of ``--merging`` by the learned merge
alone; those of ``--check`` and the flights with truths of ``--folders`` are only scored.
``--width`` and ``--points`` make all layers and patches smaller than published, for machines
without a GPU.
What is made once stays: flights in ``--keep``, networks in ``--networks``. ``--ship`` writes the
local block for the panel of waveforms. ``--tables`` chooses ablations: whole (table B.1), shares
(3.5), changes (3.7, 3.8), densities (3.9), radii (5.5); those of blocks and inputs (3.4, 3.6) are
always made. ``--markdown docs/accuracy.md`` makes the page's section.

References
----------
Shinohara 2022, chapter 3, appendix B, table 5.5.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.class_training.flights import flown
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.waveform_networks.merging import LearnedMerge
from processing.laboratory.waveform_networks.patches import (
    FirstReturns,
    Patch,
    first_returns_of,
    random_patch,
)
from processing.laboratory.waveform_networks.scoring import (
    CHANGES,
    Answers,
    ClassRates,
    answers,
    block_rows,
    f_row,
    recall_row,
    share_rows,
    table_head,
    table_row,
)
from processing.laboratory.waveform_networks.sizes import NetworkSizes
from processing.laboratory.waveform_networks.training import (
    GLOBAL,
    GLOBAL_POINTS,
    LOCAL,
    LOCAL_POINTS,
    WHOLE_PATCH,
    Lesson,
    as_local_network,
    read_trained,
    trained_network,
    write_trained,
)
from processing.methods.waveforms.local_network import write_local_network

_HEADING = "### The published local–global network of flights"
_TABLES = ("whole", "shares", "changes", "densities", "radii")
_DENSITIES = (1.0, 5.0, 10.0, 15.0)
_FACTORS = (Fraction(1, 5), Fraction(2, 5), Fraction(1), Fraction(5, 2), Fraction(5))
_BLOCKS = (LOCAL, GLOBAL_POINTS, GLOBAL, LOCAL_POINTS)
_ALONE = (LOCAL, LOCAL_POINTS, WHOLE_PATCH)
"""Learn as many epochs as `--epochs` says; the others as `--global-epochs`."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make what isn't there, and print the tables."""
    options = _parser().parse_args(arguments)
    options.networks.mkdir(parents=True, exist_ok=True)
    work = _Work(options, NetworkSizes().scaled(float(options.width), options.points))
    if options.ship is not None:
        write_local_network(as_local_network(work.network(LOCAL)), options.ship)
    lines = [_about(options), *work.lines()]
    write_sections(options.markdown, {_HEADING: "\n" + "\n".join(lines) + "\n"})
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.waveform_networks")
    parser.add_argument("--keep", type=Path, required=True, help="where flights are kept")
    parser.add_argument("--networks", type=Path, required=True, help="where networks are kept")
    parser.add_argument("--seeds", default="7200-7219", help="flights that are learnt from")
    parser.add_argument(
        "--merging", default="7220-7223", help="that the learned merge is fitted to"
    )
    parser.add_argument("--check", default="7240-7243", help="that are only scored")
    parser.add_argument("--folders", type=Path, nargs="*", default=[])
    parser.add_argument("--width", type=Fraction, default=Fraction(1), help="of all layers, 1/8")
    parser.add_argument("--points", type=int, default=NetworkSizes().points, help="of a patch")
    parser.add_argument("--patches", type=int, default=3, help="of each flight that is learnt from")
    parser.add_argument("--epochs", type=int, default=40, help="of what sees no neighbourhoods")
    parser.add_argument("--global-epochs", type=int, default=40)
    parser.add_argument("--waves", type=int, help="of a patch that a step of the local block sees")
    parser.add_argument(
        "--looked-at", type=int, help="patches of a simulated flight that are scored, all without"
    )
    parser.add_argument("--tables", nargs="*", default=_TABLES, choices=_TABLES)
    parser.add_argument("--ship", type=Path, help="file that the local block is written to")
    parser.add_argument("--markdown", type=Path)
    return parser


@dataclass
class _Work:
    """Flights, and networks that are made when they are asked for."""

    options: argparse.Namespace
    sizes: NetworkSizes
    _patches: list[Patch] | None = None

    def lines(self) -> Iterator[str]:
        """All tables, one after another."""
        options, chosen = self.options, set(self.options.tables)
        kinds = (*_BLOCKS, *([WHOLE_PATCH] if "whole" in chosen else []))
        networks = {kind: self.network(kind) for kind in kinds}
        most = self.options.looked_at
        both = {kind: networks[kind] for kind in (LOCAL, GLOBAL)}
        fitted = answers(both, *self._seen("merging"), None, most)
        learned = LearnedMerge.of(fitted.shares[LOCAL], fitted.shares[GLOBAL], fitted.classes)
        _, checked = self._seen("check")
        said = answers(networks, self.sizes, checked, None, most)
        yield from _block_table("Simulated flights of unseen seeds", said, learned)
        for folder in options.folders:
            other = answers(networks, self.sizes, [first_returns_of(folder)])
            yield from _block_table(f"Another simulator’s flight, `{folder.name}`", other, learned)
        if "shares" in chosen:
            head = table_head(("merge", "input"), with_mean=False)
            yield from _titled("Points of a class that the local block decided:", head)
            yield from share_rows(said)
        if "changes" in chosen:
            yield from self._change_table(both, checked)
        if "densities" in chosen:
            yield from self._density_table(both, checked)
        if "radii" in chosen:
            yield from self._radius_table(checked)

    # Any: torch is an extra; what it gives has no types where it is missing.
    def network(self, kind: str, factor: Fraction = Fraction(1)) -> Any:
        """A network of a kind, with balls so many times the published ones."""
        sizes = self.sizes.with_radii(float(factor))
        name = re.sub(r"\W+", "_", kind if factor == 1 else f"{kind} {factor}")
        path = self.options.networks / f"{name}.pt"
        if path.exists():
            return read_trained(kind, sizes, path)
        alone = kind in _ALONE
        epochs = self.options.epochs if alone else self.options.global_epochs
        network = trained_network(
            kind, sizes, self._learnt(), Lesson(epochs, say, self.options.waves)
        )
        write_trained(network, path)
        return network

    def _learnt(self) -> list[Patch]:
        if self._patches is None:
            rng = np.random.default_rng(0)
            self._patches = []
            for seed in seeds_of(self.options.seeds):
                flight = first_returns_of(flown(seed, self.options.keep))
                drawn = (random_patch(flight, self.sizes.points, rng) for _ in range(self._each))
                self._patches += drawn
        return self._patches

    @property
    def _each(self) -> int:
        return int(self.options.patches)

    def _seen(self, name: str) -> tuple[NetworkSizes, list[FirstReturns]]:
        seeds = seeds_of(getattr(self.options, name))
        return self.sizes, [first_returns_of(flown(one, self.options.keep)) for one in seeds]

    def _change_table(
        self, networks: dict[str, Any], flights: Sequence[FirstReturns]
    ) -> Iterator[str]:
        title = "Recall with points or waveforms disturbed, local–global by the published rule:"
        yield from _titled(title, table_head(("points", "waveforms")))
        most = self.options.looked_at
        yield recall_row("real | real", answers(networks, self.sizes, flights, None, most))
        for words, change in CHANGES.items():
            yield recall_row(words, answers(networks, self.sizes, flights, change, most))

    def _density_table(
        self, networks: dict[str, Any], flights: Sequence[FirstReturns]
    ) -> Iterator[str]:
        title = "F of flights thinned to so many first returns/m² at most, local–global:"
        yield from _titled(title, table_head(("density",)))
        for density in _DENSITIES:
            rng = np.random.default_rng(0)
            thin = [one.thinned(density, rng) for one in flights]
            said = answers(networks, self.sizes, thin, None, self.options.looked_at)
            yield f_row(f"{density:g}", said)

    def _radius_table(self, flights: Sequence[FirstReturns]) -> Iterator[str]:
        title = "F of the global block of points alone with other radii:"
        yield from _titled(title, table_head(("radii",)))
        for factor in _FACTORS:
            network = {GLOBAL_POINTS: self.network(GLOBAL_POINTS, factor)}
            sizes = self.sizes.with_radii(float(factor))
            said = answers(network, sizes, flights, None, self.options.looked_at)
            rates = ClassRates.of(said.classes, said.shares[GLOBAL_POINTS].argmax(axis=1))
            yield table_row(f"× {float(factor):g}", rates.f_measure)


def _block_table(title: str, said: Answers, learned: LearnedMerge) -> Iterator[str]:
    counts = np.bincount(said.classes, minlength=6)
    yield from _titled(f"{title}, {counts.sum():,} first returns:", table_head(_COLUMNS))
    yield from block_rows(said, learned)


_COLUMNS = ("blocks", "input", "")


def _titled(title: str, head: Sequence[str]) -> list[str]:
    return ["", title, "", *head]


def _about(options: argparse.Namespace) -> str:
    waves = "" if options.waves is None else f"--waves {options.waves} "
    looked_at = "" if options.looked_at is None else f"--looked-at {options.looked_at} "
    learnt = options.waves or options.points
    scored = "all patches" if options.looked_at is None else f"{options.looked_at} patches"
    return (
        "`python -m processing.laboratory.waveform_networks --keep FOLDER --networks FOLDER "
        f"--seeds {options.seeds} --merging {options.merging} --check {options.check} "
        f"--width {options.width} --points {options.points} --patches {options.patches} {waves}"
        f"--epochs {options.epochs} --global-epochs {options.global_epochs} {looked_at}"
        f"--tables {' '.join(options.tables)} --markdown docs/accuracy.md` makes this section: the "
        "thesis’ network as a reference; trees classify in the program. Published are a width of 1 "
        f"and patches of 50,000 points. These networks have {options.width} of the maps and "
        f"patches of {options.points:,} points with as many fewer representatives; they saw "
        f"{options.patches} patches of each of {len(seeds_of(options.seeds))} flights, the local "
        f"block {options.epochs} times with {learnt:,} waveforms a step, the global one "
        f"{options.global_epochs} times. Published are nine million first returns of one place by "
        "one scanner; here landscapes, scanners and densities differ from flight to flight. "
        f"Scored are {scored} of each simulated flight. The learned merge is fitted to flights "
        "that no block learnt from. Precision (P), recall (R) and F are of first returns with "
        "cleaned waveforms; means are plain ones."
    )


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
