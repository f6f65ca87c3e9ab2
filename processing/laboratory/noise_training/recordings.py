"""Recordings with known noise, made by the simulator: streets, street scans, sites, flights.

Any scanner and mounting, measuring by phase or by pulses. Those that judge have more noise than is
usual; those that are learned from have all kinds side by side, and grass of any height.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.core.monitor import SilentMonitor
from processing.core.safe_write import write_safely
from processing.image.images_of_drives import image_of
from processing.laboratory.simulate.airborne.flight import fly_over
from processing.laboratory.simulate.airborne.landscapes import KINDS, landscape_of
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.requests import SiteRequest, StreetRequest
from processing.laboratory.simulate.scanning.any_mounting import any_sensor, write_sensor
from processing.laboratory.simulate.scanning.delivered_files import CRS_NAME
from processing.laboratory.simulate.scanning.noise_options import (
    NoiseOptions,
    noise_options,
    varied_noise,
)
from processing.laboratory.simulate.scanning.returns import Weather
from processing.laboratory.simulate.scanning.sensors import SENSORS, Sensor
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.site import DATES, simulate_site
from processing.laboratory.simulate.sites.bodies import SiteKind
from processing.laboratory.simulate.street.styles import style_of
from processing.laboratory.simulate.street_scans import StreetScan, scan_street
from processing.laboratory.simulate.streets import simulate_street
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.beams.beams_of_drives import beams_of
from processing.methods.noise.beams.standing_scans import standing_scan_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

MOBILE, STANDING, SITE, AIRBORNE = "mobile", "standing", "site", "airborne"
MEADOW, SCANS = "meadow", "scans"
MUCH, VARIED, CLEAR, QUIET = "much", "varied", "clear", "quiet"
_ALL_KINDS = (VARIED, CLEAR)
NOISE_CODES = (7, 18)
_LOW_PLANT, _CROWN, _POLE = 3, 5, 66
_SITE_CODES = {
    SiteKind.GRASS: _LOW_PLANT,
    SiteKind.BRUSH: _CROWN,
    **dict.fromkeys(
        (
            SiteKind.FENCE,
            SiteKind.SCAFFOLD,
            SiteKind.NET,
            SiteKind.BATTER_BOARD,
            SiteKind.SURVEY_POLE,
        ),
        _POLE,
    ),
}
"""Thin things of sites, as streets have them: where only places are known, they are easily lost."""
_STYLES, _SITE_STYLES = (
    ("urban", "urban", "rural", "highway"),
    ("levee", "cutting", "pad", "hillside"),
)
_LENGTH_M, _MOST_POINTS = 14.0, 250_000
_PHASE_SHARE, _VARIED_PHASE_SHARE = 0.55, 0.75
"""Of the sensors: they have kinds of noise that pulses have not, all of which are to be learned."""

_AMBIGUITIES_M = (53.5, 79.0, 119.0)
"""Of phase-based scanners of the last twenty years (Z+F 5003, 5006 and 9012)."""

_OFTEN = {"phase": (-0.3, 0.9), "pulse": (0.0, 2.5)}
"""Powers of ten of the usual noise, so that every kind is met; a phase-based scanner has much."""

_QUIET = (-2.0, -0.3)
_MORE_AMBIGUITIES_M = (25.2, *_AMBIGUITIES_M)
"""With the shorter one of a Z+F 5003."""

_EXIT_M, _DIVERGENCE_RAD = (0.003, 0.015), (0.0003, 0.002)
"""Of beams: the wider, the more of them meet an edge and what is behind it."""

_GROWTH, _FLATTEST = (0.03, 3.0), (0.06, 0.3)
"""From lawns to meadows of half a metre; thin blades let a flat beam by, dense ones end it."""

_MEADOW_STEPS_M = (0.022, 0.06)
_STRIP_SHARE, _STRIP_M = 0.5, (15.0, 30.0)
_WET_SHARE = 0.35
_ON_TRIPODS = ("p40", "vz400i", "zf5016")
_SCANS = (2, 4)
_SECTORS, _PULSES = (1.0, 1.0, 0.4, 0.15), (200_000, 500_000)
_SITE_LENGTH_M, _SITE_SPACINGS_M = (20.0, 45.0), (0.03, 0.09)
_FLIGHT_SPACINGS_M, _FLIGHT_POINTS = (0.25, 2.0), 60_000


@dataclass(frozen=True)
class RecordedScene:
    """Points whose truth is known.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, about their middle.
    labels : (n,) uint8
        Codes of the contract; 7 and 18 are noise.
    intensity : (n,) uint16
    beams : PointBeams or None
        Where they are known.
    """

    xyz: Floats
    labels: NDArray[np.uint8]
    intensity: NDArray[np.uint16]
    beams: PointBeams | None = None

    @property
    def is_noise(self) -> Flags:
        """(n,) whether no surface gave a point."""
        return np.asarray(np.isin(self.labels, NOISE_CODES), np.bool_)

    def chosen(self, kept: Flags) -> RecordedScene:
        """Some of the points, in their order."""
        beams = self.beams
        if beams is not None:
            before = np.concatenate([[0], np.cumsum(kept)])
            beams = beams._replace(
                xyz=beams.xyz[kept],
                origins=beams.origins[kept],
                ranges=beams.ranges[kept],
                columns=beams.columns[kept],
                row_starts=before[beams.row_starts],
            )
        return RecordedScene(self.xyz[kept], self.labels[kept], self.intensity[kept], beams)


def recorded_scene(how: str, seed: int, folder: Path, noise: str = MUCH) -> RecordedScene:
    """The scene of a seed; made once and kept as a file of the folder.

    Parameters
    ----------
    how : {"mobile", "standing", "scans", "site", "meadow", "airborne"}
        Scans are several of a street as one cloud. A meadow is a site scanned from one place, with
        its sweeps.
    noise : {"much", "varied", "clear", "quiet"}
        The usual kinds many times as often; all kinds (and grass of any height); the same with
        panes of which most send nothing back themselves; next to none.
    """
    path = folder / f"{how}-{seed}{'' if noise == MUCH else f'-{noise}'}.npz"
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        _write_scene(_MAKERS[how](seed, noise), path)
    return _read_scene(path)


def _write_scene(scene: RecordedScene, path: Path) -> None:
    beams = scene.beams
    known = {} if beams is None else {f"beams_{k}": v for k, v in beams._asdict().items()}
    own = {"xyz": scene.xyz, "labels": scene.labels, "intensity": scene.intensity}
    arrays: dict[str, Any] = {**own, **known}
    with write_safely(path) as part, part.open("wb") as file:
        np.savez(file, **arrays)


def _read_scene(path: Path) -> RecordedScene:
    with np.load(path) as kept:
        arrays: dict[str, Any] = dict(kept)
    beams = None
    if "beams_xyz" in arrays:
        parts = {name: arrays[f"beams_{name}"] for name in PointBeams._fields}
        beams = PointBeams(**{**parts, "step_rad": float(parts["step_rad"])})
    return RecordedScene(arrays["xyz"], arrays["labels"], arrays["intensity"], beams)


def _noise_of(random: Generator, seed: int, sensor: Sensor, noise: str) -> NoiseOptions:
    if noise in _ALL_KINDS:
        return varied_noise(seed, sensor, has_clear_panes=noise == CLEAR)
    powers = _QUIET if noise == QUIET else _OFTEN[sensor.measures_by]
    return noise_options(seed, sensor, float(10 ** random.uniform(*powers)))


def _weather_of(seed: int) -> Weather:
    """Of recordings that are learned from."""
    random = chance(seed, "training", "weather")
    return Weather(
        float(random.uniform(0.05, 0.7)) if random.random() < _WET_SHARE else 0.0,
        float(random.uniform(0.3, 0.9)),
        float(random.choice([0.0, 0.5, 0.9])),
        float(np.exp(random.uniform(*np.log(_GROWTH)))),
        float(np.exp(random.uniform(*np.log(_FLATTEST)))),
    )


def _varied_sensor(seed: int, sensor: Sensor) -> Sensor:
    """The same scanner with a beam of any width, and any range of unambiguity."""
    random = chance(seed, "training", "beam")
    is_phase = sensor.measures_by == "phase"
    return replace(
        sensor,
        exit_m=round(float(np.exp(random.uniform(*np.log(_EXIT_M)))), 4),
        divergence_rad=round(float(np.exp(random.uniform(*np.log(_DIVERGENCE_RAD)))), 6),
        most_m=float(random.choice(_MORE_AMBIGUITIES_M)) if is_phase else sensor.most_m,
    )


def _of_any_kind(random: Generator, sensor: Sensor, noise: str) -> Sensor:
    """The same scanner, measuring by phase or by pulses."""
    if random.random() < (_VARIED_PHASE_SHARE if noise in _ALL_KINDS else _PHASE_SHARE):
        most_m = float(random.choice(_AMBIGUITIES_M))
        return replace(sensor, measures_by="phase", most_m=most_m, returns=1)
    return replace(sensor, measures_by="pulse", most_m=max(sensor.most_m, 150.0))


def _mobile(seed: int, noise: str) -> RecordedScene:
    """Some seconds of one head, or all that a surveyor cut out of them."""
    random = chance(seed, "training", MOBILE)
    sensor = _of_any_kind(random, any_sensor(seed), noise)
    is_varied = noise in _ALL_KINDS
    sensor = _varied_sensor(seed, sensor) if is_varied else sensor
    sensor = replace(sensor, heads=sensor.heads[:1])
    with TemporaryDirectory(prefix="zuka-") as at:
        delivery, own = Path(at) / "street", Path(at) / "sensor.toml"
        write_sensor(sensor, own)
        request = StreetRequest(
            seed=seed,
            length_m=_LENGTH_M,
            style=str(random.choice(_STYLES)),
            own_sensor=str(own),
            avenue=bool(random.random() < 0.2),
            images=False,
        )
        options = _noise_of(random, seed, sensor, noise)
        weather = _weather_of(seed) if is_varied else None
        simulate_street(request, delivery, SilentMonitor(), noise=options, weather=weather)
        file = min(delivery.glob("*.laz"))
        labels = delivery / "truth" / f"{file.stem}.labels.npy"
        drive, own_labels = _imported(file, (delivery / "trajectory.csv",), labels)
        scene = _drive_scene(drive, own_labels)
    if random.random() < _STRIP_SHARE:  # as surveyors deliver it
        beams = scene.beams
        middle = scene.xyz.mean(axis=0) if beams is None else beams.origins.mean(axis=0)
        across = _across(scene.xyz if beams is None else beams.origins)
        off = (scene.xyz - middle)[:, :2] @ across
        low, wide = random.uniform(-15, 0), random.uniform(*_STRIP_M)
        return scene.chosen((off > low) & (off < low + wide))
    return scene


def _imported(
    file: Path, trajectories: tuple[Path, ...], labels: Path
) -> tuple[Drive, NDArray[np.uint8]]:
    """A file as the program takes it, and what its points are, in the program's order."""
    asked = ImportRequest((file,), trajectories, crs=CRS_NAME)
    folder = next(iter(import_drives(asked, file.parent / "drives", SilentMonitor())))
    drive = Drive(folder)
    _, indices = drive.sources(0, drive.count)
    return drive, np.load(labels)[indices]


def _across(path: Floats) -> Floats:
    """(2,) the horizontal direction in which places spread least."""
    flat = path[:, :2] - path[:, :2].mean(axis=0)
    return np.asarray(np.linalg.eigh(flat.T @ flat)[1][:, 0])


def _drive_scene(drive: Drive, labels: NDArray[np.uint8]) -> RecordedScene:
    origins = beam_origins(drive)
    if origins is None:
        points = slice(0, min(drive.count, _MOST_POINTS))
        xyz = drive.xyz(points)
        intensity = np.asarray(drive.columns["intensity"][points])
        return RecordedScene(xyz - xyz.mean(axis=0), labels[points], intensity)
    image = image_of(drive, drive.pixel_kind)
    starts = image.row_starts
    first = int(np.searchsorted(starts, max(0, (drive.count - _MOST_POINTS) // 2)))
    last = int(np.searchsorted(starts, starts[first] + _MOST_POINTS, "right")) - 1
    beams, points = beams_of(drive, image, range(first, max(first + 1, last)), origins)
    intensity = np.asarray(drive.columns["intensity"][points])
    return RecordedScene(beams.xyz, labels[points], intensity, beams)


def _standing(seed: int, noise: str) -> RecordedScene:
    """One scan with its sweeps."""
    random = chance(seed, "training", STANDING)
    sensor = _of_any_kind(random, SENSORS[str(random.choice(_ON_TRIPODS))], noise)
    sensor = _varied_sensor(seed, sensor) if noise in _ALL_KINDS else sensor
    street = Street(seed, style_of(str(random.choice(_STYLES))), 20.0)
    options = _noise_of(random, seed, sensor, noise)
    pulses, share = int(random.integers(*_PULSES)), float(random.choice(_SECTORS))
    weather = Weather(0.0, float(random.uniform(0.3, 0.9)), 0.0, float(random.uniform(0.03, 1.0)))
    weather = _weather_of(seed) if noise in _ALL_KINDS else weather
    with TemporaryDirectory(prefix="zuka-") as at:
        file = Path(at) / "scan.laz"
        scan = StreetScan(0, sensor, pulses, share, options)
        scan_street(street, scan, weather, file, SilentMonitor())
        drive, labels = _imported(file, (), file.with_suffix(".labels.npy"))
        return _swept_scene(drive, labels)


def _scans(seed: int, noise: str) -> RecordedScene:
    """Some scans of a street as one cloud, of places alone."""
    import laspy

    random = chance(seed, "training", SCANS)
    sensor = _of_any_kind(random, SENSORS[str(random.choice(_ON_TRIPODS))], noise)
    sensor = _varied_sensor(seed, sensor)
    street = Street(seed, style_of(str(random.choice(_STYLES))), 30.0)
    options, weather = _noise_of(random, seed, sensor, noise), _weather_of(seed)
    count = int(random.integers(_SCANS[0], _SCANS[1] + 1))
    pulses = int(random.integers(*_PULSES)) // count
    xyz, labels, intensities = [], [], []
    with TemporaryDirectory(prefix="zuka-") as at:
        for number in range(count):
            file = Path(at) / f"scan{number}.laz"
            scan = StreetScan(number, sensor, pulses, 1.0, options)
            scan_street(street, scan, weather, file, SilentMonitor())
            points = laspy.read(file)
            xyz.append(np.asarray(points.xyz))
            labels.append(np.load(file.with_suffix(".labels.npy")))
            intensities.append(np.asarray(points.intensity))
    places = np.concatenate(xyz)
    scene = RecordedScene(
        places - places.mean(axis=0), np.concatenate(labels), np.concatenate(intensities)
    )
    return _piece_of_many(random, scene)


def _swept_scene(drive: Drive, labels: NDArray[np.uint8]) -> RecordedScene:
    """A standing scan, with its beams where they are found."""
    with TemporaryDirectory(prefix="zuka-") as at:
        found = standing_scan_of(drive, Path(at), SilentMonitor())
        if found is None:
            xyz = drive.xyz(slice(0, drive.count))
            intensity = np.asarray(drive.columns["intensity"])
            return RecordedScene(xyz - xyz.mean(axis=0), labels, intensity)
        starts = found.row_starts
        last = int(np.searchsorted(starts, 2 * _MOST_POINTS, "right")) - 1
        beams, points = found.beams_of(range(max(1, last)))
        intensity = np.asarray(drive.columns["intensity"][points])
        return RecordedScene(np.array(beams.xyz), labels[points], intensity, beams)


def _meadow(seed: int, _: str) -> RecordedScene:
    """A site from one place: banks, hills and grass of any height, with little noise."""
    random = chance(seed, "training", MEADOW)
    request = SiteRequest(
        seed=seed,
        length_m=float(random.uniform(*_SITE_LENGTH_M)),
        style=str(random.choice(_SITE_STYLES)),
        sensor=str(random.choice(_ON_TRIPODS)),
        stations=1,
        spacing_m=float(np.exp(random.uniform(*np.log(_MEADOW_STEPS_M)))),
    )
    with TemporaryDirectory(prefix="zuka-") as at:
        folder = Path(at) / "site"
        simulate_site(request, folder, SilentMonitor(), weather=_weather_of(seed))
        date = str(random.choice(DATES))
        labels = folder / "truth" / f"labels_{date}.npy"
        np.save(labels, _site_labels(folder / "truth", date, (SiteKind.GRASS,)))
        return _swept_scene(*_imported(folder / "in" / f"{date}.laz", (), labels))


def _site_labels(truth: Path, date: str, told: Iterable[SiteKind]) -> NDArray[np.uint8]:
    """Codes of a site's points: some kinds are told that are but "other" in its truth."""
    codes, kinds = np.load(truth / f"labels_{date}.npy"), np.load(truth / f"kinds_{date}.npy")
    for kind in told:
        codes[(kinds == kind) & ~np.isin(codes, NOISE_CODES)] = _SITE_CODES[kind]
    return np.asarray(codes, np.uint8)


def _site(seed: int, noise: str) -> RecordedScene:
    """A site's stations as one cloud, or one of them."""
    import laspy

    random = chance(seed, "training", SITE)
    request = SiteRequest(
        seed=seed,
        length_m=float(random.uniform(*_SITE_LENGTH_M)),
        style=str(random.choice(_SITE_STYLES)),
        sensor=str(random.choice(_ON_TRIPODS)),
        stations=int(random.integers(1, 4)),
        spacing_m=float(np.exp(random.uniform(*np.log(_SITE_SPACINGS_M)))),
    )
    with TemporaryDirectory(prefix="zuka-") as at:
        folder = Path(at) / "site"
        weather = _weather_of(seed) if noise in _ALL_KINDS else None
        simulate_site(request, folder, SilentMonitor(), weather=weather)
        date = str(random.choice(DATES))
        points = laspy.read(folder / "in" / f"{date}.laz")
        xyz, labels = np.asarray(points.xyz), _site_labels(folder / "truth", date, _SITE_CODES)
        intensity = np.asarray(points.intensity)
    scene = RecordedScene(xyz - xyz.mean(axis=0), labels, intensity)
    return _piece_of_many(random, scene)


def _airborne(seed: int, _: str) -> RecordedScene:
    random = chance(seed, "training", AIRBORNE)
    spacing = float(np.exp(random.uniform(*np.log(_FLIGHT_SPACINGS_M))))
    extent = float(np.clip(spacing * np.sqrt(_FLIGHT_POINTS), 40.0, 400.0))
    land = landscape_of(str(random.choice(sorted(KINDS))), seed, extent)
    shaken = float(random.uniform(0.01, 0.2)), float(random.uniform(0.01, 0.04))
    flown = fly_over(land, seed, spacing, shaken)
    xyz = np.asarray(flown.xyz)
    scene = RecordedScene(xyz - xyz.mean(axis=0), flown.codes, np.zeros(len(xyz), np.uint16))
    return _piece_of_many(random, scene)


def _piece_of_many(random: Generator, scene: RecordedScene) -> RecordedScene:
    """A square with as many points as are asked for at once."""
    count = scene.labels.size
    if count <= _MOST_POINTS:
        return scene
    middle = scene.xyz[random.integers(count), :2]
    away = np.abs(scene.xyz[:, :2] - middle).max(axis=1)
    return scene.chosen(away <= np.partition(away, _MOST_POINTS)[_MOST_POINTS])


_MAKERS: Mapping[str, Callable[[int, str], RecordedScene]] = {
    MOBILE: _mobile,
    STANDING: _standing,
    SCANS: _scans,
    SITE: _site,
    MEADOW: _meadow,
    AIRBORNE: _airborne,
}


def quietened(scene: RecordedScene, seed: int) -> RecordedScene:
    """A scene without most of its noise: a tripod on a meadow sees mostly blades of grass."""
    random = np.random.default_rng(seed * 7 + 6)
    share = 2 ** random.uniform(*_KEPT_NOISE)
    return scene.chosen(~scene.is_noise | (random.random(scene.labels.size) < share))


_KEPT_NOISE = (-7.0, -1.0)
"""Powers of two of its share."""


def thin_scene(scene: RecordedScene, seed: int) -> RecordedScene:
    """As clouds are delivered without their order: some thinned, some by a grid, some in pieces."""
    random = np.random.default_rng(seed)
    scene = replace(scene, beams=None)
    if random.random() < _PIECES:
        middle = scene.xyz[random.integers(scene.labels.size)]
        piece = np.abs(scene.xyz - middle).max(axis=1) < random.uniform(1.5, 8)
        scene = scene.chosen(piece) if piece.sum() > _FEWEST_OF_A_PIECE else scene
    way = random.random()
    if way < 0.4:
        return scene
    if way < 0.7:
        return scene.chosen(random.random(scene.labels.size) < 2 ** random.uniform(-2.5, 0))
    cells = np.floor(scene.xyz / random.uniform(0.01, 0.06)).astype(np.int64)
    order = random.permutation(cells.shape[0])
    _, firsts = np.unique(cells[order], axis=0, return_index=True)
    kept = np.zeros(scene.labels.size, np.bool_)
    kept[order[firsts]] = True
    return scene.chosen(kept)


_PIECES, _FEWEST_OF_A_PIECE = 0.08, 100
