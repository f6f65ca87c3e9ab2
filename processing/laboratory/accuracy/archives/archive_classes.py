"""Archives of points classified as a city in five classes, or as surface and what stands on it.

``python -m processing.laboratory.accuracy.archives.archive_classes city FILE…`` makes the table of
a city for LAS, LAZ or PLY with true classes, ``… surface FILE…`` that of one flight. Both are
written to standard output, with ``--markdown docs/accuracy.md`` into the page. ``--codes`` says
which of the files' codes are which class, such as ``ground=2 vegetation=3,4,5``; those of no class
aren't scored and are counted.

References
----------
Shinohara 2022, tables 5.2, 5.4 and 5.6.
Varney and others 2020: the codes of DALES.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import OutOfRange, Unsuitable, UserError
from processing.core.output_streams import write_every_character
from processing.core.text import Text
from processing.laboratory.accuracy.archives.archive_points import (
    CLASS,
    ArchivePoints,
    ArchiveRequest,
    archive_points,
)
from processing.laboratory.accuracy.archives.three_inputs import codes_of_inputs
from processing.laboratory.accuracy.class_groups import groups_of
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.scoring.points.confusion_matrix import ConfusionMatrix

Groups = Mapping[str, tuple[int, ...]]

_REFUSED = 2


@dataclass(frozen=True)
class ArchiveTable:
    """One of the thesis' two uses.

    Attributes
    ----------
    heading : str
    found : mapping of str to tuple of int
        The program's codes that are each class, in the table's order.
    true : mapping of str to tuple of int
        A truth's, unless others are named.
    about : str
    """

    heading: str
    found: Groups
    true: Groups
    about: str


TABLES = {
    "city": ArchiveTable(
        "### A city of an archive in five classes",
        {
            "ground": (2, 11),
            "vegetation": (3, 4, 5),
            "building": (6,),
            "wire": (13, 14),
            "tower": (15,),
        },
        {"ground": (1,), "vegetation": (2,), "building": (8,), "wire": (5,), "tower": (7,)},
        "Roads count as ground, poles of the truth as towers (thesis, table 5.2).",
    ),
    "surface": ArchiveTable(
        "### A flight of an archive as surface or not",
        {"surface": (2, 11), "other": (3, 4, 5, 6, 13, 14, 15)},
        {"surface": (2, 11), "other": (3, 4, 5, 6, 13, 14, 15)},
        "Ground and roads are the surface, all else isn't (thesis, section 5.3).",
    ),
}


@dataclass(frozen=True, eq=False)
class ScoredInput:
    """What one input gave for one file.

    Attributes
    ----------
    file, given : str
        Its name, and what classes were told from.
    counts : (codes, classes + 1) int64
        By the truth's codes that were met, and the classes found; the last is none of them.
    codes : (codes,) uint8
    reason : str
        Why there is nothing, where that is so.
    """

    file: str
    given: str
    counts: Integers = field(default_factory=lambda: np.zeros((0, 0), np.int64))
    codes: NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))
    reason: str = ""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make a table; 2 where a file is refused, with the reason on standard error."""
    options = _parser().parse_args(arguments)
    table = TABLES[options.table]
    try:
        true = groups_named(options.codes, table) if options.codes else table.true
        scored = [one for path in options.files for one in _scored(path, options, (table, true))]
    except UserError as error:
        sys.stderr.write(f"{error.line('en')}\n")
        return _REFUSED
    words = "\n".join([_about(options, table, true), *_tables(scored, table, true)])
    write_sections(options.markdown, {table.heading: f"{words}\n"})
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.accuracy.archives.archive_classes"
    )
    parser.add_argument("table", choices=list(TABLES))
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--codes", nargs="+", default=[], metavar="CLASS=CODE,…")
    parser.add_argument("--column", default=CLASS, help="where the truth is")
    parser.add_argument("--density", type=float, default=15.0, help="points/m²; 0: all")
    parser.add_argument("--returns", choices=("first", "all"), default="first")
    parser.add_argument("--pulse", type=Path, help="the scanner's, as waveform-estimate takes it")
    parser.add_argument("--crs", default="", help="EPSG:n of the files")
    parser.add_argument("--columns", default="", help="of text files, such as x,y,z,classification")
    parser.add_argument(
        "--every-point",
        action="store_true",
        help="score all delivered points; those that were left out take their neighbour's class",
    )
    parser.add_argument("--markdown", type=Path)
    return parser


def groups_named(words: Sequence[str], table: ArchiveTable) -> Groups:
    """The codes of a truth, as ``--codes`` names them.

    Raises
    ------
    OutOfRange
        A class that the table hasn't, or what is no code.
    """
    found: dict[str, tuple[int, ...]] = {}
    for word in words:
        name, _, codes = word.partition("=")
        numbers = [one.strip() for one in codes.split(",")]
        if name not in table.found or not all(one.isascii() and one.isdigit() for one in numbers):
            raise OutOfRange(
                Text("This names no class and its codes.", "クラスとコードの指定ではありません。"),
                Text.same(word),
                Text(
                    f"Write for instance {next(iter(table.found))}=2,11; classes are "
                    f"{', '.join(table.found)}.",
                    f"例：{next(iter(table.found))}=2,11（クラス：{', '.join(table.found)}）",
                ),
            )
        found[name] = tuple(map(int, numbers))
    return found


def _scored(
    path: Path, options: argparse.Namespace, how: tuple[ArchiveTable, Groups]
) -> Iterator[ScoredInput]:
    request = ArchiveRequest(
        path,
        options.column,
        options.density,
        options.returns == "first",
        options.crs,
        tuple(options.columns.split(",")) if options.columns else (),
    )
    with tempfile.TemporaryDirectory(prefix="zuka-") as position:
        scratch = Path(position)
        archive = archive_points(request, scratch / "archive")
        _refuse_unknown(path, archive, how[1])
        for given, found in codes_of_inputs(archive, scratch / "work", options.pulse).items():
            if found.codes is None:
                yield ScoredInput(path.name, given, reason=found.reason)
                continue
            codes, truth = found.codes, archive.truth
            if options.every_point:
                codes, truth = codes[nearest(archive.all_xyz, archive.xyz)], archive.all_truth
            yield _counted(ScoredInput(path.name, given), truth, codes, how[0])


def nearest(xyz: Floats, known: Floats) -> Integers:
    """(n,) which of the known places lies nearest to each.

    References
    ----------
    Shinohara 2022, algorithm 5: labels pass on to the returns and points that were left out.
    """
    from scipy.spatial import cKDTree

    centre = known.mean(axis=0)
    return np.asarray(cKDTree(known - centre).query(xyz - centre)[1], np.int64)


def _refuse_unknown(path: Path, archive: ArchivePoints, true: Groups) -> None:
    known = [code for codes in true.values() for code in codes]
    if not np.isin(archive.truth, known).any():
        met = ", ".join(map(str, np.unique(archive.truth)))
        raise Unsuitable(
            Text("No point has a class that is scored.", "評価するクラスの点がありません。"),
            Text.same(f"{path}: {met}"),
            Text("Name the file's codes with --codes.", "--codes でコードを指定してください。"),
        )


def _counted(
    one: ScoredInput, truth: NDArray[np.uint8], found: NDArray[np.uint8], table: ArchiveTable
) -> ScoredInput:
    codes, row = np.unique(truth, return_inverse=True)
    counts = np.zeros((codes.size, len(table.found) + 1), np.int64)
    np.add.at(counts, (row.ravel(), groups_of(found, table.found, table.found)), 1)
    return ScoredInput(one.file, one.given, counts, codes)


def _about(options: argparse.Namespace, table: ArchiveTable, true: Groups) -> str:
    named = " ".join(f"{name}={','.join(map(str, codes))}" for name, codes in true.items())
    points = "first returns" if options.returns == "first" else "all returns"
    thinned = f"thinned to {options.density:g} points/m²" if options.density > 0 else "not thinned"
    scored = "every delivered point" if options.every_point else "those"
    more = f" --columns {options.columns}" if options.columns else ""
    more += " --every-point" if options.every_point else ""
    return (
        f"`python -m processing.laboratory.accuracy.archives.archive_classes {options.table} FILE… "
        f"--codes {named} --density {options.density:g} --returns {options.returns}"
        f"{more} --markdown docs/accuracy.md` makes "
        f"this section: {points}, {thinned}, are classified; {scored} are scored. {table.about} "
        "Other true classes aren't scored.\n"
    )


def _tables(scored: Sequence[ScoredInput], table: ArchiveTable, true: Groups) -> Iterator[str]:
    names = list(table.found)
    rows = [["file", "from", "points", "not scored", "", *names, "mean"]]
    each = [["file", "from", "true code", "class", "points", "F", *names, "none"]]
    for one in scored:
        if one.reason:
            rows.append([one.file, one.given, one.reason, *[""] * (len(names) + 3)])
            continue
        rows += _score_rows(one, names, true)
        each += _code_rows(one, names, true)
    yield markdown_table(rows)
    yield "By the truth's own codes, with the share of each that was called a class:\n"
    yield markdown_table(each)


def _score_rows(one: ScoredInput, names: Sequence[str], true: Groups) -> Iterator[list[str]]:
    group = groups_of(one.codes, true, names)
    merged = np.zeros((len(names) + 1, len(names) + 1), np.int64)
    np.add.at(merged, group, one.counts)
    ignored = int(merged[-1].sum())
    merged[-1] = 0
    matrix = ConfusionMatrix(tuple(range(len(names) + 1)), merged)
    there = matrix.true_counts[:-1] > 0
    # A class that is nowhere found has no precision: it counts as 0 in the mean.
    measures = {"P": np.nan_to_num(matrix.precision), "R": matrix.recall, "F": matrix.f_measure}
    head = [one.file, one.given, f"{merged.sum():,}", f"{ignored:,}"]
    for name, values in measures.items():
        shown = _shown(values[:-1], there)
        yield [*head, name, *shown, f"{values[:-1][there].mean():.3f}"]
        head = [""] * 4


def _code_rows(one: ScoredInput, names: Sequence[str], true: Groups) -> Iterator[list[str]]:
    """Each true code by itself: others of its class are left aside."""
    group = groups_of(one.codes, true, names)
    known = group < len(names)
    for code, own, at in zip(one.codes, one.counts, group, strict=True):
        shares = [f"{share:.3f}" for share in own / own.sum()]
        cells = [one.file, one.given, str(code)]
        if at == len(names):
            yield [*cells, "not scored", f"{own.sum():,}", "–", *shares]
            continue
        false = int(one.counts[known & (group != at), at].sum())
        f = 2 * own[at] / (own.sum() + own[at] + false)
        yield [*cells, names[at], f"{own.sum():,}", f"{f:.3f}", *shares]


def _shown(values: Floats, there: NDArray[np.bool_]) -> list[str]:
    return [f"{one:.3f}" if own else "–" for one, own in zip(values, there, strict=True)]


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
