"""Every door by which the program reads a file that somebody else made: a small file, a reader."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from processing.core.block_sums import SUFFIX
from processing.core.monitor import SilentMonitor
from processing.formats.format import Content
from processing.formats.points.point_codes import read_truth
from processing.formats.points.point_files import read_chunks, read_info
from processing.formats.registry import FORMATS
from processing.formats.reports.number_file import read_numbers
from processing.formats.reports.quality.check_point_file import read_check_points
from processing.formats.surfaces.design import read_design
from processing.formats.survey.control_points import read_control_points
from processing.formats.trajectories.image_list import read_image_list
from processing.formats.trajectories.trajectory_files import read_trajectory
from processing.formats.vectors.boundary_files import read_boundary
from processing.formats.vectors.line_files import read_lines
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.image.images_of_drives import image_of
from processing.labels.label_column import labels_of
from processing.map.catalogue import Catalogue
from processing.map.catalogue_file import read_catalogue
from processing.methods.earthwork.as_built.limits_file import read_limits
from processing.methods.road.signs.initial_positions import read_positions
from processing.methods.templates.template_text import read_template, template_text
from processing.methods.waveforms.pulse_file import read_pulse
from processing.operations.batch.job import read_job
from processing.operations.inputs import OperationInputs
from processing.operations.operation_files import operation_text, read_operation
from processing.operations.run import RunOperation
from processing.project.project import Project
from processing.project.volumes.volume_store import VolumeStore
from processing.project.work_details import read_work_details
from resources import path_of
from tests.broken_files.every_format import SMALL_FILES, Writer
from tests.broken_files.mutations import files_of
from tests.older_project import forget_all_sums
from tests.processing.methods.templates.curb_street import CURB
from tests.processing.operations.batch.job_files import HEAD, IMPORT, NOISE

_CRS = "EPSG:6677"
Reader = Callable[[Path], object]


@dataclass(frozen=True)
class Door:
    """One kind of file, and what reads it.

    Attributes
    ----------
    name : str
        Of the door, good as the name of a folder.
    file : str
        What the file is called.
    write : callable
        Makes a small good one.
    read : callable
        Reads the file, whole.
    """

    name: str
    file: str
    write: Writer
    read: Reader


def _points(path: Path) -> None:
    read_info(path)
    for _ in read_chunks(path):
        pass


def _classes(path: Path) -> None:
    for _ in read_truth(path, if_false=0, if_true=1, flags={}).blocks():
        pass


_READERS: Mapping[Content, Reader] = {
    Content.POINTS: _points,
    Content.CLASSES: _classes,
    Content.TRAJECTORY: lambda path: read_trajectory(path, _CRS),
    Content.IMAGES: read_image_list,
    Content.FEATURES: read_mapped,
    Content.AREAS: read_boundary,
    Content.LINES: read_lines,
    Content.SURFACE: lambda path: read_design(path, "", SilentMonitor()),
}


def _text(text: str) -> Writer:
    return lambda path: path.write_text(text, encoding="utf-8")


def _copy_of(name: str) -> Writer:
    return lambda path: shutil.copyfile(path_of(name), path)


_PLACES = "id,easting_m,northing_m,height_m,role\nT1,1.0,2.0,3.0,check\nT2,4.0,5.0,6.0,check\n"
_OPERATION = RunOperation("ground", OperationInputs(points=(Path("a.las"),)), output=Path("b.las"))


@cache
def _catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


_TABLES: tuple[tuple[str, str, Writer, Reader], ...] = (
    ("catalogue", "c.toml", _copy_of("catalogue/level500.toml"), read_catalogue),
    ("limits", "l.toml", _copy_of("catalogue/as_built_limits.toml"), read_limits),
    ("template", "t.json", _text(template_text(CURB)), read_template),
    ("control-points", "k.csv", _text(_PLACES), read_control_points),
    ("check-points", "k.csv", _text(_PLACES),
     lambda path: read_check_points(path, _catalogue())),
    ("numbers", "n.json", _text('{"cut_m3": 1.5, "fill_m3": 2}'),
     lambda path: read_numbers(path, ("cut_m3",))),
    ("positions", "p.csv", _text(_PLACES), read_positions),
    ("pulse", "w.csv", _text("time_ns,amplitude\n0,1\n1,5\n2,1\n"), read_pulse),
    ("operation", "o.json", _text(operation_text(_OPERATION, is_json=True)), read_operation),
    ("job", "j.toml", _text(HEAD + IMPORT + NOISE), read_job),
    ("work", "w.toml", _text('work = "道路台帳"\nclient = "市"\n'), read_work_details),
)  # fmt: skip


def delivered_doors() -> dict[str, Door]:
    """The doors of files that are delivered, drawn by others or written by hand, by name."""
    doors = []
    for (content, id_), write in SMALL_FILES.items():
        if id_ == "pulses":
            continue  # a folder of plain numbers
        ending = FORMATS[id_].endings[0] if FORMATS[id_].endings else ".txt"
        name = f"{content.name.lower()}-{id_}"
        doors.append(Door(name, f"測量{ending}", write, _READERS[content]))
    doors += [Door(*one) for one in _TABLES]
    return {door.name: door for door in doors}


def project_doors(whole: Path, work: Path) -> dict[str, Door]:
    """A door for each file of a project: what opens the project with that file in its place.

    A file of a drive is read without checksums, as one of an older version of the program, so
    that what is in it counts.

    Parameters
    ----------
    whole : Path
        A project that stays as it is.
    work : Path
        An empty folder; the project is copied into it, and opened there.
    """
    doors = {}
    for name in files_of(whole):
        label = f"project-{_without_ids(name)}"
        doors[label] = Door(
            label,
            Path(name).name,
            lambda path, name=name: shutil.copyfile(whole / name, path),
            _opened_with(whole, work / label / "p.zuka", name),
        )
    return doors


def _without_ids(name: str) -> str:
    """The name of a file in a project without what differs from one project to the next."""
    parts = Path(re.sub("[0-9a-f]{32}", "one", name)).parts
    return "-".join(part for part in parts if not re.search("[0-9a-f]{8}", part))


def _opened_with(whole: Path, copied: Path, name: str) -> Reader:
    def read(path: Path) -> None:
        if not copied.is_dir():
            shutil.copytree(whole, copied)
            if not name.endswith(SUFFIX):
                forget_all_sums(copied)
        shutil.copyfile(path, copied / name)
        _look_through(copied)

    return read


def _look_through(folder: Path) -> None:
    """Open a project and look at what every part of it holds."""
    with closing(Project.open(folder, writing=False)) as project:
        for _ in project.features.all():
            pass
        project.runs.all()
        project.history.last()
        for one in (store := VolumeStore(folder)).all():
            store.read_result(one)
        some = np.arange(10)
        for drive in project.drives:
            drive.xyz(some)
            labels_of(drive, some)
            assert drive.images is None or len(drive.images) >= 0
            assert drive.trajectory is None or drive.trajectory is drive.trajectory
            for kind in drive.image_kinds:
                image_of(drive, kind).raster(range(2), range(2))
