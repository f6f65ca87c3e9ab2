"""Tables of noise and ground filters on clouds whose truth is known, ours beside peers'.

``python -m processing.laboratory.accuracy.filters.filters DATA_FOLDER --markdown docs/accuracy.md``
makes the sections on noise and ground of the page; without ``--markdown`` they are written to
standard output. ``--pictures FOLDER`` paints where our filters err; ``--only
noise|streets|unseen|sites|airborne`` leaves the other sections as they are, ``--ours`` leaves out
peers. Scenes are found as :mod:`processing.laboratory.accuracy.filters.filter_scenes` says.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from processing.core.output_streams import write_every_character
from processing.core.safe_write import write_safely
from processing.laboratory.accuracy.filters.filter_methods import (
    FilterMethod,
    airborne_methods,
    noise_methods,
    site_methods,
)
from processing.laboratory.accuracy.filters.filter_pictures import paint_errors
from processing.laboratory.accuracy.filters.filter_scenes import (
    FilterScene,
    airborne_samples,
    noise_scenes,
    sites,
)
from processing.laboratory.accuracy.filters.filter_tables import (
    FilterResult,
    airborne_table,
    kinds_table,
    markdown_table,
    noise_table,
    sites_table,
)
from processing.laboratory.accuracy.filters.held_out_scenes import unseen_rows
from processing.laboratory.accuracy.filters.street_noise import street_rows
from processing.scoring.points.coded_points import CodedPoints, CodePairs
from processing.scoring.points.point_scores import PointScorer
from processing.scoring.scorers import GROUND_SCORER, NOISE_SCORER

_NEXT_HEADING = re.compile(r"\n#{2,3} ")

HEADINGS = {
    "noise": "## Noise",
    "streets": "## Noise of streets by pulses",
    "unseen": "## Noise of scenes that nobody looked at",
    "sites": "## Ground of sites with machines",
    "airborne": "## Ground from the air",
}
"""Each part's section of the page."""


def main(arguments: list[str]) -> int:
    """Score all filters on the scenes of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--only", choices=list(HEADINGS), action="append")
    parser.add_argument("--ours", action="store_true", help="without peers")
    parser.add_argument("--folder", type=Path, help="where simulated recordings are kept")
    chosen = parser.parse_args(arguments)
    for part in chosen.only or HEADINGS:
        section = "\n".join((f"{HEADINGS[part]}\n", *_PARTS[part](chosen)))
        if chosen.markdown is None:
            sys.stdout.write(section)
            continue
        page = replace_section(chosen.markdown.read_text("utf-8"), HEADINGS[part], section)
        with write_safely(chosen.markdown) as path:
            path.write_text(page, "utf-8")
    return 0


def replace_section(page: str, heading: str, section: str) -> str:
    """A page with one of its sections replaced, or added at its end.

    Parameters
    ----------
    heading : str
        The section's first line, with its marks.
    section : str
        The heading and what follows.
    """
    before, found, after = page.partition(f"{heading}\n")
    if not found:
        return f"{page.rstrip()}\n\n{section.rstrip()}\n"
    # Sections below it are made under headings of their own.
    following = _NEXT_HEADING.search(after)
    rest = after[following.start() :] if following else ""
    return f"{before}{section.rstrip()}\n{rest}"


def write_sections(page: Path | None, sections: Mapping[str, str]) -> None:
    """Put sections into a page, by their headings, or on standard output without one."""
    for heading, content in sections.items():
        section = f"{heading}\n{content}"
        if page is None:
            sys.stdout.write(f"{section}\n")
            continue
        whole = replace_section(page.read_text("utf-8"), heading, section)
        with write_safely(page) as path:
            path.write_text(whole, "utf-8")


def _of_noise(chosen: argparse.Namespace) -> Iterator[str]:
    found = list(_find_results(noise_scenes(chosen.data), NOISE_SCORER, noise_methods(), chosen))
    yield f"{_ABOUT}{_ABOUT_NOISE}"
    yield noise_table(found)


def _of_streets(chosen: argparse.Namespace) -> Iterator[str]:
    yield _ABOUT_STREETS
    yield markdown_table(list(street_rows(chosen.data)))


def _of_unseen(chosen: argparse.Namespace) -> Iterator[str]:
    yield _ABOUT_UNSEEN
    yield markdown_table(list(unseen_rows(folder=chosen.folder)))


def _of_sites(chosen: argparse.Namespace) -> Iterator[str]:
    found = list(_find_results(sites(chosen.data), GROUND_SCORER, site_methods(), chosen))
    yield f"{_ABOUT}{_ABOUT_SITES}"
    yield sites_table(found)
    yield "Points of each kind that got the right class:\n"
    yield kinds_table(one for one in found if one.method == "adaptive")


def _of_airborne(chosen: argparse.Namespace) -> Iterator[str]:
    scenes = airborne_samples(chosen.data)
    yield f"{_ABOUT}{_ABOUT_AIRBORNE}"
    yield airborne_table(list(_find_results(scenes, GROUND_SCORER, airborne_methods(), chosen)))


def _find_results(
    scenes: Iterable[FilterScene],
    scorer: PointScorer,
    methods: Sequence[FilterMethod],
    chosen: argparse.Namespace,
) -> Iterator[FilterResult]:
    for scene in scenes:
        with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
            for method in methods:
                if method.ours or not chosen.ours:
                    yield _score_method(scene, method, scorer, Path(folder), chosen.pictures)


def _score_method(
    scene: FilterScene,
    method: FilterMethod,
    scorer: PointScorer,
    folder: Path,
    pictures: Path | None,
) -> FilterResult:
    sys.stderr.write(f"{scene.name}: {method.name} {method.settings}\n")
    codes = method.codes(scene, folder)
    score = None
    if codes is not None:
        truth = CodedPoints(scene.truth, kinds=scene.kinds)
        score = scorer.score([CodePairs(truth, CodedPoints(codes))])
        if pictures is not None and method.ours:
            kept = scorer.codes if scorer is GROUND_SCORER else frozenset(range(256)) - scorer.codes
            name = f"{method.name} {method.settings}".strip()
            paint_errors(scene, codes, kept, pictures, name)
    return FilterResult(scene.name, method.name, method.settings, method.ours, score)


_ABOUT = """\
`python -m processing.laboratory.accuracy.filters.filters DATA_FOLDER \
--markdown docs/accuracy.md` makes this section; \
`zuka score` says the same of one result, and `--pictures FOLDER` paints every error. """
_ABOUT_NOISE = """\
Positive is the kept point in the first three figures, as in the road-surface study, and the \
noise point in the next three. Doing nothing scores the first F of its row, so the study's measure \
says little; a filter earns its keep by the second F, and by what it keeps of thin things.
"""
_ABOUT_STREETS = """\
`python -m processing.laboratory.accuracy.filters.filters DATA_FOLDER --only streets \
--markdown docs/accuracy.md` makes this section. Noise (0.1 to 0.5 % of such recordings) is told \
by how far it lies from anything true: nearer than 20 cm it is a share of an edge that nobody \
asks for. What is lost is a share of the true points of each kind.
"""
_ABOUT_UNSEEN = """\
`python -m processing.laboratory.accuracy.filters.filters DATA_FOLDER --only unseen \
--markdown docs/accuracy.md` makes \
this section from recordings of the project's own simulator, which the models did not learn from: \
streets from vehicles and tripods, sites and flights, with one to some hundred times the usual \
noise, by scanners that measure by phase or by pulses. The upper rows know the scanner's beams (a \
drive with its trajectory, a tripod's sweeps), the lower ones places alone, most of them thinned. \
Noise counts however near it lies to something true. Shares are 0 to 1; the last two columns are \
the study's methods. `--folder` keeps the recordings.
"""
_BY_TRUTH = """\
Peers run as they are installed, CSF and SMRF from PyPI (`cloth-simulation-filter`, `pysmrf`). \
“By this truth”: the settings that agree best with the scene's truth, which nobody has in the \
field; ours are told nothing. """
_ABOUT_SITES = f"""{_BY_TRUTH}\
Positive is the removed point (everything that is not ground: machines, people, material, ghosts) \
in the first three figures, as in the ground study, and the ground point in the next three. The \
study's own rows are of another cloud, with 5,293 machine points among 19,971; its ground \
figures follow from its counts.
"""
_ABOUT_AIRBORNE = f"""{_BY_TRUTH}\
Total error on samples of the ISPRS filter test (Sithole and Vosselman 2004), which have 1 to \
3.5 m between points. Published figures are from the papers, whose settings were chosen for each \
sample or kind of terrain; their last column is the mean of all 15 samples, of which five are \
here.
"""
_PARTS: Mapping[str, Callable[[argparse.Namespace], Iterator[str]]] = {
    "noise": _of_noise,
    "streets": _of_streets,
    "unseen": _of_unseen,
    "sites": _of_sites,
    "airborne": _of_airborne,
}


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
