"""``zuka info``: what a cloud or a project holds."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from app.cli.import_drives import describe_drive
from app.cli.opened import columns_of
from app.cli.output import print_json, print_lines
from app.settings.language import system_language
from processing.formats.points.packet_counts import count_packets
from processing.formats.points.point_files import PointFileInfo, read_info, read_sample
from processing.project.project import Project, is_project
from processing.recording.drive import Drive
from processing.recording.waveform_facts import (
    WaveformFacts,
    remarks_on_lacking,
    waveform_facts,
)
from processing.recording.waveform_packets.descriptors import WaveformDescriptor

_SAMPLE_POINTS = 2_000


def command(arguments: argparse.Namespace) -> int:
    """Tell about a project or a point file."""
    reported = (
        _of_project(arguments.input)
        if is_project(arguments.input)
        else _of_file(arguments.input, columns_of(arguments))
    )
    if arguments.json:
        print_json(reported)
    else:
        print_lines(*_lines(reported, ""))
    return 0


def _of_project(folder: Path) -> dict[str, object]:
    project = Project.open(folder, writing=False)
    try:
        return {
            "project": project.name,
            "crs": project.crs,
            "points": sum(drive.count for drive in project.drives),
            "features": len(project.features),
            "drives": [_of_drive(drive) for drive in project.drives],
            **_of_damage(project),
        }
    finally:
        project.close()


def _of_damage(project: Project) -> dict[str, object]:
    """Drives that can't be opened, where there are any."""
    errors, language = project.damaged_drives.values(), system_language()
    return {"damaged": [error.line(language) for error in errors]} if errors else {}


def _of_drive(drive: Drive) -> dict[str, object]:
    info, revolutions = drive.info, drive.revolutions
    timed = revolutions if info.has_measured_times else None
    return {
        "id": info.id,
        "name": info.name,
        "scanner": info.scanner,
        "points": info.count,
        "crs": info.crs,
        "extent": _extent(info.lowest, info.highest),
        "rows_by": info.rows_by,
        "rows_reason": info.rows_reason.in_language(system_language()),
        "revolutions": None if revolutions is None else int(revolutions.segments.size),
        "turns_per_s": None if timed is None else timed.revolution_rate_hz,
        "pulses_per_s": None if timed is None else timed.pulse_rate_hz,
        "pulses_per_turn": None if revolutions is None else revolutions.pulses_per_revolution,
        "has_trajectory": drive.trajectory is not None,
        "sources": [source.path for source in info.sources if source.points],
        "waveforms": _of_waveforms(waveform_facts(drive)),
        "summary": describe_drive(drive),
    }


def _of_file(path: Path, columns: tuple[str, ...]) -> dict[str, object]:
    info = read_info(path, columns=columns)
    sample = read_sample(path, _SAMPLE_POINTS, columns=columns)
    times = sample.get("time", np.empty(0))
    times = times[np.isfinite(times)]
    scanners = sorted(int(number) for number in np.unique(sample.get("scanner", np.empty(0, int))))
    return {
        "file": str(path),
        "format": info.format,
        "version": info.version,
        "point_format": info.point_format,
        "points": info.count,
        "crs": info.crs,
        "extent": _extent(info.lowest, info.highest),
        "scale": list(info.scale),
        "attributes": list(info.attributes),
        "columns_taken": list(info.columns_taken),
        "scanners": scanners,
        "times": [float(times.min()), float(times.max())] if times.size else None,
        "waveforms": _of_delivered(info),
    }


def _of_waveforms(facts: WaveformFacts | None) -> dict[str, object] | bool:
    """What a drive has of them; False where its files name none."""
    if facts is None:
        return False
    language = system_language()
    return {
        "pulses": facts.pulses,
        "points_with": facts.points,
        "points_without": {why.name.lower(): points for why, points in facts.lacking.items()},
        **_of_descriptors(facts.descriptors),
        "packets": [file.delivered for file in facts.files],
        "directions_by": [file.sign_by for file in facts.files if not file.reason.en],
        "remarks": [remark.in_language(language) for remark in facts.remarks],
    }


def _of_delivered(info: PointFileInfo) -> dict[str, object] | bool:
    """What a point file says of its waveforms; False where its points have no place for them."""
    waveforms = info.waveforms
    if waveforms is None:
        return False
    readable = {number: one for number, one in waveforms.descriptors.items() if one.is_readable}
    counted = count_packets(info) if waveforms.is_readable else None
    if counted is not None:
        readable = {number: one for number, one in readable.items() if number in counted.used}
    lacking = {} if counted is None else counted.lacking
    language = system_language()
    told = (waveforms.remark,) if waveforms.remark.en else ()
    remarks = (*told, *remarks_on_lacking(lacking))
    return {
        "pulses": 0 if counted is None else counted.packets,
        "points_with": 0 if counted is None else counted.points,
        "points_without": {why.name.lower(): points for why, points in lacking.items()},
        **_of_descriptors(tuple(readable.values())),
        "descriptors_delivered": len(waveforms.descriptors),
        "packets": str(waveforms.path),
        "packets_inside": waveforms.path == info.path,
        "reason": waveforms.reason.in_language(language),
        "remarks": [remark.in_language(language) for remark in remarks],
    }


def _of_descriptors(descriptors: tuple[WaveformDescriptor, ...]) -> dict[str, object]:
    """How samples are coded, each descriptor in the same place of the lists."""
    return {
        "samples": [one.samples for one in descriptors],
        "interval_ns": [one.interval_ns for one in descriptors],
        "bits": [one.bits for one in descriptors],
        "gain": [one.gain for one in descriptors],
        "offset": [one.offset for one in descriptors],
    }


def _extent(
    lowest: tuple[float, float, float], highest: tuple[float, float, float]
) -> dict[str, list[float]]:
    return {"lowest": list(lowest), "highest": list(highest)}


def _lines(reported: dict[str, object], indent: str) -> list[str]:
    lines: list[str] = []
    for name, value in reported.items():
        if isinstance(value, dict):
            lines += [f"{indent}{name}:", *_lines(value, indent + "  ")]
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for item in value:
                lines += [f"{indent}{name}:", *_lines(item, indent + "  ")]
        else:
            lines.append(f"{indent}{name}: {_plain(value)}")
    return lines


def _plain(value: object) -> str:
    if isinstance(value, list):
        return ", ".join(_plain(item) for item in value)
    if isinstance(value, float):
        return f"{value:.3f}"
    return "-" if value is None or value == "" else str(value)
