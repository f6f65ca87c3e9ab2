"""A process that damages files of a drive and does with it what programs do.

``python -m tests.broken_files.damaged_drive PROJECT FILE SEED``: a kernel that leaves its arrays
ends it by a signal. It ends well where each thing is done, or refused in one sentence.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import numpy as np

from processing.core.errors import UserError
from processing.core.monitor import SilentMonitor
from processing.image.attributes.attributes import available, colours
from processing.image.edges.beam import beam_at
from processing.image.edges.edges import edge_beside
from processing.image.images_of_drives import image_of
from processing.image.neighbourhoods.points_around import neighbours
from processing.image.rows import image_rows
from processing.image.search.nearest import nearest_point
from processing.image.search.ray_hits import RayHits, RaySight
from processing.image.search.touched_tiles import TouchedTiles
from processing.project.project import Project
from processing.recording.columns.columns import COLUMN_TYPES
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.section.cut import Cut
from processing.section.points_in_cut import points_in_cut
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, columns_of, run

SILENT = SilentMonitor()
DAMAGES = 6
TOOLS_TRIED = ("normals", "segments", "noise")


def main(project: Path, name: str, seed: int) -> int:
    """Damage one file again and again, and use the drive each time."""
    # Rows are kept of short drives too, so that those that are kept are used.
    image_rows._FEW_POINTS = 0
    random, said = np.random.default_rng(seed), 0
    with closing(Project.open(project)) as opened:
        (folder,) = (drive.folder for drive in opened.drives)
        _use(opened.drives[0], random)
    whole = project.with_name("whole")
    shutil.copytree(folder, whole)
    for number in range(DAMAGES):
        shutil.rmtree(folder)
        shutil.copytree(whole, folder)
        path = folder / name
        # Half of the time as a disk forgets, so that nothing tells that the file was written.
        times = path.stat().st_mtime_ns if number % 2 else None
        _damage(path, random)
        if times is not None:
            os.utime(path, ns=(times, times))
        try:
            with closing(Project.open(project)) as opened:
                said += sum(_is_reported(one) for one in opened.damaged_drives.values())
                for drive in opened.drives:
                    said += _use(drive, random)
        except UserError as error:
            said += _is_reported(error)
    sys.stdout.write(f"{said}\n")
    return 0


def _damage(path: Path, random: np.random.Generator) -> None:
    if path.suffix == ".npz":
        with np.load(path) as kept:
            arrays = {one: kept[one] for one in kept.files}
        numbers = [one for one in arrays if arrays[one].dtype.kind in "if"]
        one = numbers[random.integers(len(numbers))]
        arrays[one] = _altered(np.array(arrays[one]), random)
        np.savez(path, allow_pickle=False, **arrays)
    elif path.suffix == ".npy":
        np.save(path, _altered(np.load(path), random))
    else:
        dtype, _ = COLUMN_TYPES[path.stem]
        values = np.fromfile(path, dtype)
        _altered(values, random).tofile(path)


def _altered(values: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Some values become others: any at all, near ones, or the ends of what there is."""
    flat = values.reshape(-1)
    positions = random.integers(0, flat.size, min(47, flat.size))
    way = random.integers(3)
    if way == 0:
        flat.view(np.uint8).reshape(flat.size, -1)[positions] = random.integers(
            0, 256, (positions.size, flat.itemsize)
        )
    elif way == 1:
        flat[positions] = flat[positions] + random.integers(-5000, 5000, positions.size).astype(
            flat.dtype
        )
    else:
        flat[positions] = -flat[positions]
    return values


def _use(drive: Drive, random: np.random.Generator) -> int:
    said = 0
    for act in (*_looks(drive, random), *_runs(drive)):
        try:
            with np.errstate(all="ignore"):
                act()
        except UserError as error:
            said += _is_reported(error)
    return said


def _is_reported(error: UserError) -> int:
    assert all(error.line(language) for language in ("en", "ja"))
    return 1


def _looks(drive: Drive, random: np.random.Generator) -> Iterator[Callable[[], object]]:
    """All kinds of images with their tiles, and what is asked of single points."""
    points = np.sort(random.integers(0, drive.count, 20))
    for kind in drive.image_kinds:
        yield lambda kind=kind: _image(drive, kind, points)
    for point in points[:4].tolist():
        yield lambda point=point: neighbours(drive, point, 0.5)
        yield lambda point=point: edge_beside(drive, point)
    middle = (np.array(drive.info.lowest) + np.array(drive.info.highest)) / 2
    position = (float(middle[0]), float(middle[1]), float(middle[2]))
    yield lambda: points_in_cut(drive, Cut(position, (1.0, 0.0)))
    yield lambda: nearest_point(drive, middle, 5.0)
    yield lambda: _rays(drive, middle)
    for attribute in available(drive):
        yield lambda attribute=attribute: colours(drive, points, attribute, 2.0, 98.0)


def _image(drive: Drive, kind: ImageKind, points: np.ndarray) -> None:
    image = image_of(drive, kind)
    rows, columns = range(image.rows), range(image.width)
    for step in (1, 3):
        image.raster(rows, columns, step)
    image.raster(range(image.rows // 3, image.rows // 2), range(5, image.width // 2))
    image.grid(rows)
    image.pixel_of(points)
    for row in range(0, image.rows, 7):
        image.points_at(row, image.width // 2)
        image.nearest_filled(row, image.width // 2, 30)
        beam_at(drive, image, row, image.width // 2)
    image.points_in(rows, range(3, image.width))
    image.fixed_raster(rows)
    image.pyramid.prepare()
    for level in range(image.pyramid.levels):
        for key in image.pyramid.keys(level):
            image.pyramid.points(key)
            image.pyramid.count(key)
            assert image.pyramid.spacing_m(key) >= 0
            TouchedTiles(image, np.arange(drive.count))


def _rays(drive: Drive, middle: np.ndarray) -> None:
    image = image_of(drive, drive.image_kinds[0])
    hits = RayHits(RaySight(np.eye(4), middle, -np.inf, (0.0, 0.0)))
    for key in image.pyramid.keys(0):
        hits.search_tile(drive, image, key, None)
    hits.best()


def _runs(drive: Drive) -> Iterator[Callable[[], object]]:
    for name in TOOLS_TRIED:

        def act(name: str = name) -> None:
            into = drive.folder.parent.parent.parent / f"run-{name}"
            shutil.rmtree(into, ignore_errors=True)
            request = RunRequest(name, drive, TOOLS[name].parameters())
            columns_of(run(request, SILENT, into=into, points_per_block=2000))

        yield act
    yield lambda: drive.sources(0, drive.count)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])))
