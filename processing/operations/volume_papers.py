"""The papers of a volume, whoever asks for them: its report, and the form of as-built control."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from shapely.geometry.base import BaseGeometry

from processing.core.monitor import Monitor
from processing.core.text import Language
from processing.formats.reports.as_built_form import write_as_built_form
from processing.formats.reports.as_built_rows import AsBuiltFacts
from processing.formats.reports.as_built_tables import write_as_built_csv, write_as_built_xlsx
from processing.formats.reports.volume_report import write_volume_report
from processing.formats.reports.volume_rows import VolumeFacts
from processing.formats.reports.volume_tables import write_volume_csv, write_volume_xlsx
from processing.formats.work_facts import SideFacts, WorkFacts
from processing.methods.earthwork.as_built.as_built import AsBuiltResult, evaluate_as_built
from processing.methods.earthwork.as_built.limits import AsBuiltLimits
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.comparison_checks import ground_and_design
from processing.methods.earthwork.volumes.other_methods import shown_sections
from processing.methods.earthwork.volumes.volume_result import VolumeResult

TABLE, WORKBOOK, PAPER = ".csv", ".xlsx", ".pdf"
PAPERS = (PAPER, WORKBOOK, TABLE)
"""The endings of papers."""


@dataclass(frozen=True)
class VolumePapers:
    """What stands on the papers beside figures.

    Attributes
    ----------
    work : WorkFacts
    before, after : SideFacts
    language : "en" or "ja"
    never : sequence of Path
        Files that were read, which must not be overwritten.
    boundary : str
        What the area is called that was counted; empty where all was.
    area : shapely geometry or None
        That area, m, project CRS.
    is_design_before : bool
        Which of the two sides the form judges by.
    """

    work: WorkFacts
    before: SideFacts
    after: SideFacts
    language: Language
    never: Sequence[Path]
    boundary: str = ""
    area: BaseGeometry | None = None
    is_design_before: bool = False

    def write_report(
        self, path: Path, result: VolumeResult, monitor: Monitor, *, ending: str
    ) -> None:
        """Write the volume report as one of :data:`PAPERS`.

        Raises
        ------
        InUse, NoSpace, Cancelled
        """
        facts = VolumeFacts(
            self.work,
            self.before,
            self.after,
            self.boundary,
            result.line,
            result.between,
            self.area,
        )
        language, never = self.language, self.never
        if ending == TABLE:
            write_volume_csv(path, result, facts, language, never=never)
        elif ending == WORKBOOK:
            write_volume_xlsx(path, result, facts, language, never=never)
        else:
            if result.line is None:
                shown = shown_sections(result.change, self.area, monitor)
                facts = replace(facts, figures=shown)
            write_volume_report(path, result, facts, language, monitor=monitor, never=never)

    def write_form(
        self, path: Path, judged: AsBuiltResult, monitor: Monitor, *, ending: str
    ) -> None:
        """Write the form of as-built control as one of :data:`PAPERS`.

        Raises
        ------
        InUse, NoSpace, Cancelled
        """
        design, ground = self.before, self.after
        if not self.is_design_before:
            design, ground = ground, design
        facts = AsBuiltFacts(self.work, design, ground)
        language, never = self.language, self.never
        if ending == TABLE:
            write_as_built_csv(path, judged, facts, language, never=never)
        elif ending == WORKBOOK:
            write_as_built_xlsx(path, judged, facts, language, never=never)
        else:
            write_as_built_form(path, judged, facts, language, monitor=monitor, never=never)


def judged_ground(
    sides: tuple[Side, Side],
    limits: tuple[AsBuiltLimits, str],
    boundary: BaseGeometry | None,
    monitor: Monitor,
) -> AsBuiltResult:
    """A measured ground judged by a design.

    Parameters
    ----------
    limits : (AsBuiltLimits, str)
        The table and the work type that count.
    boundary : shapely geometry or None
        Within which it is judged.

    Raises
    ------
    Unsuitable, OutOfRange
        The design can't be judged by.
    """
    ground, design = ground_and_design(*sides)
    return evaluate_as_built(ground, design, limits, monitor, boundary=boundary)
