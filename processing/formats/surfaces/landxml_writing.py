"""Surfaces and sections as J-LandXML, or as plain LandXML 1.2 with break lines.

J-LandXML narrows LandXML 1.2 to what Japanese offices exchange: break lines are not among it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path
from typing import Literal
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.surfaces.landxml_systems import names_of_system
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.sections.drawing_parts import (
    DrawnSection,
    SectionedLine,
    parts_with_ground,
)

LandXmlForm = Literal["J-LandXML", "LandXML"]

GROUND = "ExistingGround"
"""What J-LandXML calls terrain: a surface's description, a section's first line."""

_CRITERION = "MlitLandXmlVer.1.7"
_TOKYO_PEIL = ("JGD2000", "JGD2011", "JGD2024", "T.P", "T.P.")
"""Height systems that count from Tokyo Peil."""

_NO_CHARACTER = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ROWS = 2048
_LEAST_M = 1e-3


@dataclass(frozen=True)
class WrittenSurface:
    """A surface and what is said of it.

    Attributes
    ----------
    breaklines : tuple of (k, 3) float64
        Easting, northing, height, m; J-LandXML has none.
    """

    surface: TriangleSurface
    description: str = GROUND
    breaklines: tuple[NDArray[np.float64], ...] = ()


@dataclass(frozen=True)
class LandXmlFacts:
    """What is said of the whole file.

    Attributes
    ----------
    project : str
        Name of the work.
    crs : str
        ``EPSG:n``, or empty when unknown.
    height_datum : str
        ``JGD2011``, ``JGD2024``, ``T.P.``, or another as it is named; empty when unknown.
    phase : str
        Stage of the work (projectPhase).
    decimals : int
        Of coordinates, in metres: 3 is whole millimetres.
    section_names : (str, str)
        Of a section's earlier and later ground.
    written_at : datetime
        With its time zone.
    """

    project: str
    crs: str
    height_datum: str
    phase: str = "測量"
    decimals: int = 3
    section_names: tuple[str, str] = (GROUND, "MeasuredGround")
    written_at: datetime = field(default_factory=lambda: datetime.now(UTC).astimezone())


def write_landxml(
    path: Path,
    surfaces: Sequence[WrittenSurface],
    facts: LandXmlFacts,
    *,
    lines: Sequence[SectionedLine] = (),
    form: LandXmlForm = "J-LandXML",
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write surfaces, and sections along a line.

    Parameters
    ----------
    surfaces : sequence of WrittenSurface
        Names that are missing or there twice are completed by a number.
    lines : sequence of SectionedLine
        Each becomes an alignment with its ground along it, and both grounds at each section;
        stations of one differ by a millimetre.
    form : {"J-LandXML", "LandXML"}
        J-LandXML leaves break lines out and needs a plane system of Japan.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    Unsuitable
        There is nothing to write, a corner is no place, or J-LandXML has no name for the
        reference system.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    LandXML 1.2; MLIT, J-LandXML 1.7: points are north, east, height; left offsets are negative.
    """
    _check(path, surfaces, facts, lines=lines, form=form)
    monitor = monitor or SilentMonitor()
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as file,
    ):
        for words in _head(facts, form):
            file.write(words + "\n")
        for words in _alignments(lines, facts):
            monitor.check()
            file.write(words + "\n")
        if surfaces:
            file.write(f"<Surfaces name={_quote_words(facts.project)}>\n")
            names = _names([one.surface.name for one in surfaces])
            for number, (name, one) in enumerate(zip(names, surfaces, strict=True)):
                monitor.report(number / len(surfaces))
                for words in _surface(name, one, facts.decimals, form):
                    monitor.check()
                    file.write(words + "\n")
            file.write("</Surfaces>\n")
        file.write("</LandXML>\n")


def _check(
    path: Path,
    surfaces: Sequence[WrittenSurface],
    facts: LandXmlFacts,
    *,
    lines: Sequence[SectionedLine],
    form: LandXmlForm,
) -> None:
    where = Text.same(str(path))
    if not surfaces and not any(line.sections for line in lines):
        raise Unsuitable(
            Text("There is neither a surface nor a section.", "サーフェスも断面もありません。"),
            where,
            Text("Choose what is to be exported.", "出力するものを選んでください。"),
        )
    for one in surfaces:
        used = one.surface.xyz[one.surface.corners]
        if not (len(used) and np.isfinite(used).all()):
            raise Unsuitable(
                Text(
                    "The surface has no triangles, or a corner of one is no place.",
                    "サーフェスに三角形がないか、座標のない頂点があります。",
                ),
                Text.same(one.surface.name or str(path)),
                Text("Make the surface again.", "サーフェスを作り直してください。"),
            )
    if form == "J-LandXML" and not names_of_system(facts.crs):
        raise Unsuitable(
            Text(
                "J-LandXML needs one of the 19 plane rectangular systems of Japan.",
                "J-LandXMLには平面直角座標系（1～19系）が必要です。",
            ),
            Text.same(facts.crs or "-"),
            Text(
                "Set the reference system, or export as plain LandXML 1.2.",
                "座標参照系を設定するか、LandXML 1.2で出力してください。",
            ),
        )


def _head(facts: LandXmlFacts, form: LandXmlForm) -> Iterator[str]:
    written = facts.written_at
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield (
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" '
        f'date="{written:%Y-%m-%d}" time="{written:%H:%M:%S}" version="1.2">'
    )
    criterion = f'<Property label="applicationCriterion" value="{_CRITERION}"/>'
    yield f"<Project name={_quote_words(facts.project)}><Feature>"
    yield f'<Property label="projectPhase" value={_quote_words(facts.phase)}/>'
    yield f"{criterion if form == 'J-LandXML' else ''}</Feature></Project>"
    yield f'<Application name="Zuka" version="{version("zuka")}"/>'
    names = {"name": "CRS1", **names_of_system(facts.crs)}
    if form == "LandXML" and facts.crs.startswith("EPSG:"):
        names["epsgCode"] = facts.crs.removeprefix("EPSG:")
    if facts.height_datum:
        is_tokyo = facts.height_datum in _TOKYO_PEIL
        names["verticalDatum"] = "T.P" if is_tokyo else facts.height_datum
        # Heights of 2011 and of 2024 both count from Tokyo Peil, and differ.
        names["desc"] = facts.height_datum
    reported = " ".join(f"{name}={_quote_words(value)}" for name, value in names.items())
    yield f"<CoordinateSystem {reported}/>"
    yield (
        '<Units><Metric areaUnit="squareMeter" linearUnit="meter" volumeUnit="cubicMeter" '
        'temperatureUnit="celsius" pressureUnit="HPA" angularUnit="decimal dd.mm.ss" '
        'directionUnit="decimal dd.mm.ss"/></Units>'
    )


def _surface(name: str, one: WrittenSurface, decimals: int, form: LandXmlForm) -> Iterator[str]:
    """Lines of the file, some thousand points at a time."""
    yield f"<Surface name={_quote_words(name)} desc={_quote_words(one.description)}>"
    if form == "LandXML" and one.breaklines:
        yield "<SourceData><Breaklines>"
        for line in one.breaklines:
            positions = _round_values(line[:, [1, 0, 2]], decimals)
            numbers = " ".join(f"{value:.{decimals}f}" for value in positions.ravel().tolist())
            yield (f'<Breakline brkType="standard"><PntList3D>{numbers}</PntList3D></Breakline>')
        yield "</Breaklines></SourceData>"
    yield '<Definition surfType="TIN"><Pnts>'
    used, corners = np.unique(one.surface.corners, return_inverse=True)
    positions = _round_values(one.surface.xyz[used][:, [1, 0, 2]], decimals)
    for start in range(0, len(positions), _ROWS):
        rows = enumerate(positions[start : start + _ROWS].tolist(), start + 1)
        yield "\n".join(
            f'<P id="{id_}">{north:.{decimals}f} {east:.{decimals}f} {height:.{decimals}f}</P>'
            for id_, (north, east, height) in rows
        )
    yield "</Pnts><Faces>"
    faces = corners.reshape(-1, 3) + 1
    for start in range(0, len(faces), _ROWS):
        rows = faces[start : start + _ROWS].tolist()
        yield "\n".join(f"<F>{first} {second} {third}</F>" for first, second, third in rows)
    yield "</Faces></Definition></Surface>"


def _alignments(lines: Sequence[SectionedLine], facts: LandXmlFacts) -> Iterator[str]:
    """Lines of the file: an alignment each."""
    if lines:
        yield "<Alignments>"
        for name, line in zip(_names(one.name or "1" for one in lines), lines, strict=True):
            yield from _alignment(name, line, facts)
        yield "</Alignments>"


def _alignment(name: str, line: SectionedLine, facts: LandXmlFacts) -> Iterator[str]:
    """Lines of the file: the line's corners, the ground along it, then a section each."""
    decimals = facts.decimals
    moved = np.hypot(*np.diff(line.xy, axis=0).T) >= _LEAST_M
    corners = _round_values(line.xy[np.append(True, moved)][:, ::-1], decimals)
    lengths = [float(np.hypot(*(end - start))) for start, end in pairwise(corners)]
    names = ["BP", *(f"IP.{number}" for number in range(1, len(corners) - 1)), "EP"]
    reported = f'length="{sum(lengths):.{decimals}f}" staStart="{line.start_m:.{decimals}f}"'
    yield f"<Alignment name={_quote_words(name)} {reported}><CoordGeom>"
    ends = list(zip(names, corners.tolist(), strict=True))
    for length, (start, end) in zip(lengths, pairwise(ends), strict=True):
        positions = [
            f'<{tag} name="{name}">{north:.{decimals}f} {east:.{decimals}f}</{tag}>'
            for tag, (name, (north, east)) in (("Start", start), ("End", end))
        ]
        yield f'<Line length="{length:.{decimals}f}">{"".join(positions)}</Line>'
    yield "</CoordGeom>"
    if line.ground:
        drawn = "".join(_point_list(part, decimals) for part in line.ground)
        yield f'<Profile><ProfSurf name="{facts.section_names[0]}">{drawn}</ProfSurf></Profile>'
    if line.sections:
        yield "<CrossSects>"
        yield from (_section(section, facts) for section in line.sections)
        yield "</CrossSects>"
    yield "</Alignment>"


def _point_list(part: NDArray[np.float64], decimals: int) -> str:
    """Stations or offsets, each with its height."""
    values = _round_values(part, decimals).ravel().tolist()
    numbers = " ".join(f"{value:.{decimals}f}" for value in values)
    return f"<PntList2D>{numbers}</PntList2D>"


def _section(section: DrawnSection, facts: LandXmlFacts) -> str:
    station = f"{section.station_m:.{facts.decimals}f}"
    words = [f'<CrossSect name={_quote_words(section.name)} sta="{station}">']
    grounds = (section.before, section.after)
    for name, heights in zip(facts.section_names, grounds, strict=True):
        parts = parts_with_ground(section.offsets, heights)
        drawn = "".join(_point_list(part, facts.decimals) for part in parts)
        if drawn:
            words.append(f"<CrossSectSurf name={_quote_words(name)}>{drawn}</CrossSectSurf>")
    return "\n".join([*words, "</CrossSect>"])


def _round_values(values: NDArray[np.float64], decimals: int) -> NDArray[np.float64]:
    """As they are written, without a minus before zero."""
    rounded: NDArray[np.float64] = np.round(values, decimals) + 0.0
    return rounded


def _names(names: Iterable[str]) -> list[str]:
    """Names that differ: the schema wants them so."""
    found: list[str] = []
    for number, name in enumerate(names, 1):
        own = name or f"TIN {number}"
        count = 2
        while own in found:
            own = f"{name or 'TIN'} ({count})"
            count += 1
        found.append(own)
    return found


def _quote_words(words: str) -> str:
    """An attribute's value with its marks; what XML can't hold becomes U+FFFD."""
    return quoteattr(_NO_CHARACTER.sub("\ufffd", words))
