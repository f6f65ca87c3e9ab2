"""The filters of noise and of ground that are compared: ours as they are run, and peers'."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags
from processing.core.monitor import SilentMonitor
from processing.formats.points.point_codes import read_result
from processing.laboratory.accuracy.filters.filter_scenes import FilterScene
from processing.laboratory.accuracy.filters.ground_peers import (
    ground_by_dense_triangles,
    ground_by_roller,
)
from processing.laboratory.accuracy.filters.peer_filters import (
    ground_by_cloth,
    ground_by_pcl,
    ground_by_smrf,
    kept_by_open3d_radius,
    kept_by_open3d_statistics,
    kept_by_pcl,
)
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.results.point_results import write_point_results
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.tools.ground import GROUND_TOOL, LOWEST, PUBLISHED, GroundParameters
from processing.tools.noise import NOISE, RADIUS, STATISTICAL, NoiseParameters
from processing.tools.running.run_shares import run_shares
from processing.tools.running.runner import run_together
from processing.tools.tool import FinishedColumns, Tool

Codes = NDArray[np.uint8]
MethodSettings = tuple[tuple[Any, ...], ...]  # a filter's own, of any types

_GROUND, _OBJECT, _KEPT, _NOISE = (np.uint8(code) for code in (2, 1, 0, 18))
_RADIUS_M, _NEIGHBOURS, _DEVIATIONS = 0.5, 113, 1.5
_PUBLISHED_GRIDS_M = (1.0, 3.0, 10.0)
_BAND_M = 0.3
_FARTHEST_M = 2.0
_PCL_RADIUS = ("-method", "radius", "-radius", f"{_RADIUS_M}", "-min_pts", f"{_NEIGHBOURS}")
_PCL_STATISTICS = ("-method", "statistical", "-mean_k", f"{_NEIGHBOURS}", "-std_dev_mul", "1.5")


@dataclass(frozen=True)
class FilterMethod:
    """A filter with its settings.

    Attributes
    ----------
    name, settings : str
    codes : callable
        (n,) uint8 of a scene, with a folder for files of its own; None where a peer isn't
        installed.
    ours : bool
    """

    name: str
    settings: str
    codes: Callable[[FilterScene, Path], Codes | None]
    ours: bool = True


def noise_methods() -> tuple[FilterMethod, ...]:
    """Filters of noise, at the road-surface study's values where they have any."""
    sor = f"{_NEIGHBOURS}, {_DEVIATIONS:g} σ"
    ror = f"{_RADIUS_M:g} m, {_NEIGHBOURS}"
    return (
        FilterMethod("nothing removed", "", _nothing, ours=False),
        FilterMethod("combined", "none to set", partial(_ours, NOISE, NoiseParameters())),
        FilterMethod("radius", ror, partial(_ours, NOISE, NoiseParameters(method=RADIUS))),
        FilterMethod(
            "statistical", sor, partial(_ours, NOISE, NoiseParameters(method=STATISTICAL))
        ),
        FilterMethod("Open3D radius", ror, _open3d_radius, ours=False),
        FilterMethod("Open3D statistical", sor, _open3d_statistics, ours=False),
        FilterMethod("PCL radius", ror, partial(_pcl_noise, _PCL_RADIUS), ours=False),
        FilterMethod("PCL statistical", sor, partial(_pcl_noise, _PCL_STATISTICS), ours=False),
    )


def site_methods() -> tuple[FilterMethod, ...]:
    """Filters of ground that are compared on sites: ours without a setting, the published, peers.

    A filter of a peer comes twice: as it is, and with the best of some settings.
    """
    lowest = [
        FilterMethod(f"lowest points{words}", f"g = {grid:g} m", _our_ground(LOWEST, grid, band))
        for words, band in ((", strict", 0.0), (f" and {_BAND_M:g} m above", _BAND_M))
        for grid in _PUBLISHED_GRIDS_M
    ]
    published = [_published_method(grid) for grid in _PUBLISHED_GRIDS_M]
    peers = _peers(_SITE_CLOTHS, _SITE_SMRFS, _SITE_MORPHOLOGIES)
    named = _named_by_the_study(_SITE_TRIANGLES, _SITE_ROLLERS)
    return (_ADAPTIVE, *published, *lowest, *named, *peers)


def study_methods(grids_m: tuple[float, ...], *, with_lowest: bool) -> tuple[FilterMethod, ...]:
    """The adaptive method, the published one at some grids, and its baseline where asked for."""
    lowest = [
        FilterMethod("lowest points, strict", f"g = {grid:g} m", _our_ground(LOWEST, grid))
        for grid in grids_m
    ]
    published = [_published_method(grid) for grid in grids_m]
    return (_ADAPTIVE, *published, *(lowest if with_lowest else ()))


def airborne_methods() -> tuple[FilterMethod, ...]:
    """The same for clouds with metres between points, where small cells hold no ground."""
    widest = _published_method(_PUBLISHED_GRIDS_M[-1])
    peers = _peers(_AIRBORNE_CLOTHS, _AIRBORNE_SMRFS, _AIRBORNE_MORPHOLOGIES)
    named = _named_by_the_study(_AIRBORNE_TRIANGLES, _AIRBORNE_ROLLERS)
    return (_ADAPTIVE, widest, *named, *peers)


def _named_by_the_study(
    triangles: MethodSettings, rollers: MethodSettings
) -> Iterator[FilterMethod]:
    """The densified TIN and the roller, each with its first settings and with the best."""
    for name, codes_of, settings in (
        ("PTD (Axelsson)", _dense_triangles, triangles),
        ("roller", _roller, rollers),
    ):
        words = ", ".join(f"{value:g}" for value in settings[0])
        yield FilterMethod(name, words, partial(codes_of, settings[0]), ours=False)
        chosen = f"best of {len(settings)} by this truth"
        yield FilterMethod(name, chosen, partial(_best, codes_of, settings), ours=False)


def _peers(
    cloths: MethodSettings, smrfs: MethodSettings, morphologies: MethodSettings
) -> Iterator[FilterMethod]:
    """Each as it is, and with the best of some settings."""
    known: tuple[tuple[str, Callable[..., Codes | None], tuple[Any, ...], MethodSettings], ...] = (
        ("CSF", _cloth, (1.0, 3, 0.5), cloths),
        ("SMRF", _smrf, (1.0, 5.0, 0.15), smrfs),
        ("PCL morphological", _pcl_ground, (), morphologies),
    )
    for name, codes_of, usual, settings in known:
        chosen = f"best of {len(settings)} by this truth"
        yield FilterMethod(name, "its defaults", partial(codes_of, usual), ours=False)
        yield FilterMethod(name, chosen, partial(_best, codes_of, settings), ours=False)


def _morphology(cell_m: float, slope: float, distance_m: float) -> tuple[str, ...]:
    """Options as typed; the name of one is misspelled in some versions of the program."""
    said = {"-cell_size": cell_m, "-slope": slope, "-initial_distance": distance_m}
    said |= {"-max_distance": _FARTHEST_M, "-max_distnace": _FARTHEST_M}
    return tuple(word for name, value in said.items() for word in (name, f"{value:g}"))


def _our_ground(
    method: str, grid_m: float, tolerance_m: float = 0.0
) -> Callable[[FilterScene, Path], Codes]:
    parameters = GroundParameters(method=method, grid_m=grid_m, tolerance_m=tolerance_m)
    return partial(_ours, GROUND_TOOL, parameters)


def _published_method(grid_m: float) -> FilterMethod:
    return FilterMethod("published", f"g = {grid_m:g} m", _our_ground(PUBLISHED, grid_m))


_SITE_CLOTHS = tuple((cloth, rigid, _BAND_M) for cloth in (0.5, 1.0) for rigid in (1, 2, 3))
_AIRBORNE_CLOTHS = tuple((cloth, rigid, 0.5) for cloth in (1.0, 2.0) for rigid in (1, 3))
"""Mesh in m, rigidness, distance in m: what its authors tell to choose by the scene."""
_SLOPES = (0.15, 0.3, 0.5)
_SITE_SMRFS = tuple((cell, 5.0, slope) for cell in (0.25, 0.5) for slope in _SLOPES)
_AIRBORNE_SMRFS = tuple((cell, 18.0, slope) for cell in (1.0, 2.0) for slope in _SLOPES)
"""Cell and widest radius in m, slope."""
_SITE_MORPHOLOGIES = tuple(
    _morphology(cell, slope, 0.3) for cell in (0.1, 0.25, 0.5) for slope in (1.0, 2.0)
)
_AIRBORNE_MORPHOLOGIES = tuple(
    _morphology(cell, slope, 0.5) for cell in (1.0, 2.0) for slope in (0.3, 0.7, 1.0)
)


_SITE_TRIANGLES = tuple(
    (cell, angle, distance, _BAND_M)
    for cell in (10.0, 5.0)
    for angle, distance in ((6.0, 1.4), (20.0, 0.5))
)
_AIRBORNE_TRIANGLES = tuple(
    (cell, angle, distance, 0.3)
    for cell in (60.0, 30.0)
    for angle, distance in ((6.0, 1.4), (15.0, 2.0))
)
"""Cell in m, angle in degrees, distance and band in m; first those that TerraScan proposes."""
_SITE_ROLLERS = tuple((radius, 0.2, _BAND_M) for radius in (5.0, 2.0, 10.0))
_AIRBORNE_ROLLERS = tuple((radius, 1.0, 0.5) for radius in (20.0, 10.0, 50.0))
"""Radius, cell and band in m."""


def our_noise(scene: FilterScene, folder: Path) -> Codes:
    """What ``zuka run noise`` gives without a setting; ``folder`` is for files meanwhile."""
    return _ours(NOISE, NoiseParameters(), scene, folder)


def as_delivered(scene: FilterScene, folder: Path) -> Path:
    """The scene's cloud as a LAS file without its truth: its own, or one made of text."""
    if scene.cloud is not None:
        return scene.cloud
    import laspy

    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.floor(scene.xyz.min(axis=0))
    las = laspy.LasData(header)
    las.xyz = scene.xyz
    path = folder / f"{scene.name}.las"
    las.write(path)
    return path


def _ours(tool: Tool, parameters: object, scene: FilterScene, folder: Path) -> Codes:
    """What ``zuka run`` writes; the import is kept in the folder for the next method."""
    drives, results = _drives(scene, folder), folder / uuid4().hex
    results.mkdir()
    columns: dict[str, FinishedColumns] = {}
    for share in run_shares(tool.id, drives, parameters, SilentMonitor()):
        into = results / share.drives[0].id
        found = run_together(share.request, share.monitor, into=into).columns
        columns |= {one.id: own for one, own in zip(share.drives, found, strict=True)}
    pairs = [(drive, columns[drive.id]) for drive in drives]
    (path,) = write_point_results(pairs, results / "result.las", SilentMonitor())
    return np.concatenate([block.codes for block in read_result(path).blocks()])


def _drives(scene: FilterScene, folder: Path) -> list[Drive]:
    kept = folder / "drives"
    if not kept.exists():
        trajectories = () if scene.trajectory is None else (scene.trajectory,)
        request = ImportRequest((as_delivered(scene, folder),), trajectories)
        import_drives(request, kept, SilentMonitor())
    return [Drive(path.parent) for path in sorted(kept.glob("*/drive.json"))]


def _open3d_radius(scene: FilterScene, _: Path) -> Codes | None:
    return _noise(kept_by_open3d_radius(scene.local_xyz, _RADIUS_M, _NEIGHBOURS))


def _open3d_statistics(scene: FilterScene, _: Path) -> Codes | None:
    return _noise(kept_by_open3d_statistics(scene.local_xyz, _NEIGHBOURS, _DEVIATIONS))


def _pcl_noise(settings: tuple[str, ...], scene: FilterScene, folder: Path) -> Codes | None:
    return _noise(kept_by_pcl(scene.local_xyz, settings, folder))


def _cloth(settings: tuple[float, int, float], scene: FilterScene, _: Path) -> Codes | None:
    found = ground_by_cloth(scene.local_xyz, *settings)
    return None if found is None else _ground(found)


def _smrf(settings: tuple[float, float, float], scene: FilterScene, _: Path) -> Codes | None:
    found = ground_by_smrf(scene.local_xyz, *settings)
    return None if found is None else _ground(found)


def _dense_triangles(
    settings: tuple[float, float, float, float], scene: FilterScene, _: Path
) -> Codes | None:
    return _ground(ground_by_dense_triangles(scene.local_xyz, *settings))


def _roller(settings: tuple[float, float, float], scene: FilterScene, _: Path) -> Codes | None:
    return _ground(ground_by_roller(scene.local_xyz, *settings))


def _pcl_ground(settings: tuple[str, ...], scene: FilterScene, folder: Path) -> Codes | None:
    found = ground_by_pcl(scene.local_xyz, ("-approximate", "1", *settings), folder)
    return None if found is None else _ground(found)


def _best(
    codes_of: Callable[..., Codes | None],
    settings: MethodSettings,
    scene: FilterScene,
    folder: Path,
) -> Codes | None:
    """The codes that agree best with the truth, by kappa."""

    def found() -> Iterator[tuple[float, Codes]]:
        for one in settings:
            codes = codes_of(one, scene, folder)
            if codes is not None:
                counts = ConfusionMatrix.of(scene.truth, codes).against_rest((int(_GROUND),))
                yield np.nan_to_num(counts.kappa), codes

    return max(found(), key=lambda pair: pair[0], default=(0.0, None))[1]


def _nothing(scene: FilterScene, _: Path) -> Codes:
    return np.full(len(scene.xyz), _KEPT)


def _ground(is_ground: Flags) -> Codes:
    return np.where(is_ground, _GROUND, _OBJECT)


def _noise(is_kept: Flags | None) -> Codes | None:
    return None if is_kept is None else np.where(is_kept, _KEPT, _NOISE)


_ADAPTIVE = FilterMethod("adaptive", "none to set", partial(_ours, GROUND_TOOL, GroundParameters()))
