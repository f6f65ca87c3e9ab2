"""Streets on which curbs and gutters are scored: simulated ones and given deliveries, as drives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.scanning.any_mounting import any_sensor, write_sensor
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.tools.listed.registry import TOOLS
from processing.tools.running.run_shares import run_shares
from processing.tools.running.runner import run
from processing.tools.tool import Candidate, CandidateResult

LENGTH_M = 120.0
BOTH = "both"
_CRS = "EPSG:6677"
_TIMES, _IMAGES = "time_s,", "path,time_s,"
_STYLES = ("urban", "rural", "urban", "rural", "urban", "highway")
_COUNTRY_STYLES = ("rural", "rural", "highway")
_SENSORS = ("vq250", "vq450", "zf9012", "vmx2ha", "lynx")
_AVENUE_STYLES = ("urban", "urban", "highway", "urban", "rural", "urban")
_AVENUE_SENSORS = ("vq250", "vq450", "lynx", "vmx2ha")
_AVENUE_TWICE_OF = 5
_URBAN_OF = 3  # every third street of any mounting is urban, the others have gutters oftener
_TWICE_OF, _STOPS_OF = 4, 3  # every fourth street is driven twice, every third waits somewhere


@dataclass(frozen=True)
class RoadScene:
    """A street that was recorded, and what is true of it.

    Attributes
    ----------
    name : str
    delivery : Path
        Its LAZ files, with ``truth/`` beside them.
    drives : tuple of Drive
    """

    name: str
    delivery: Path
    drives: tuple[Drive, ...]

    @property
    def points(self) -> int:
        """How many were measured."""
        return sum(drive.count for drive in self.drives)

    def heads(self) -> dict[str, tuple[Drive, ...]]:
        """Drives by the head that recorded them, over all passes; all of them under `BOTH`."""
        found: dict[str, tuple[Drive, ...]] = {}
        for drive in self.drives:
            head = Path(drive.info.sources[0].path).stem.partition("_")[0]
            found[head] = (*found.get(head, ()), drive)
        return {**found, BOTH: self.drives}

    def truth(self, tool: str) -> Path:
        """The map that is true."""
        return self.delivery / "truth" / f"{tool}.geojson"


@dataclass(frozen=True)
class StreetCloud:
    """All points of a delivery with what they are.

    Attributes
    ----------
    xyz : (n, 3) float64
        m.
    intensity : (n,) uint16
    label : (n,) uint8
        Codes of the contract.
    instance : (n,) int32
    """

    xyz: Floats
    intensity: NDArray[np.uint16]
    label: NDArray[np.uint8]
    instance: NDArray[np.int32]


@dataclass(frozen=True)
class RoadRun:
    """What a tool found on a street.

    Attributes
    ----------
    result : MappedFile
        Its candidates, without what is for drawings only.
    notes : tuple of str
        Why few or nothing was found.
    """

    result: MappedFile
    notes: tuple[str, ...]


def options_of(number: int, seed: int, length_m: float = LENGTH_M) -> StreetRequest:
    """The street of a seed: styles, sensors, waits and second passes take turns."""
    return StreetRequest(
        seed=seed,
        length_m=length_m,
        style=_STYLES[number % len(_STYLES)],
        sensor=_SENSORS[number % len(_SENSORS)],
        passes=2 if number % _TWICE_OF == _TWICE_OF - 1 else 1,
        stops=number % _STOPS_OF == _STOPS_OF - 1,
        images=False,
    )


def worn_options_of(number: int, seed: int, length_m: float = LENGTH_M) -> StreetRequest:
    """The same street with worn stones, by a trajectory that drifts and heads mounted otherwise.

    Errors are those of good systems (2 cm, 0.01°, 0.02°), every other street is worn as far as can
    be, and speeds are the usual ones.
    """
    options = options_of(number, seed, length_m)
    wear = 1.0 if number % 2 else 0.5
    return replace(options, wear=wear, drift_m=0.02, attitude_deg=0.01, mounting_deg=0.02)


def avenue_options_of(number: int, seed: int, length_m: float = LENGTH_M) -> StreetRequest:
    """An avenue: rows of large trees with posts and lamps under their crowns.

    Every other one is recorded with the errors of good systems, as worn streets are; the third and
    fifth style and every fifth second pass take turns.
    """
    drift = (0.02, 0.01, 0.02) if number % 2 else (0.005, 0.0, 0.0)
    return StreetRequest(
        seed=seed,
        length_m=length_m,
        style=_AVENUE_STYLES[number % len(_AVENUE_STYLES)],
        sensor=_AVENUE_SENSORS[number % len(_AVENUE_SENSORS)],
        passes=2 if number % _AVENUE_TWICE_OF == _AVENUE_TWICE_OF - 1 else 1,
        drift_m=drift[0],
        attitude_deg=drift[1],
        mounting_deg=drift[2],
        avenue=True,
        images=False,
    )


def country_options_of(number: int, seed: int, length_m: float = LENGTH_M) -> StreetRequest:
    """Country roads and a highway in turns, every other one worn: much rises there, few curbs."""
    options = (worn_options_of if number % 2 else options_of)(number, seed, length_m)
    style = _COUNTRY_STYLES[number % len(_COUNTRY_STYLES)]
    return replace(options, style=style, passes=1, stops=False)


def simulated_scenes(
    seeds: Sequence[int],
    length_m: float = LENGTH_M,
    request_of: Callable[[int, int, float], StreetRequest] = options_of,
) -> Iterator[RoadScene]:
    """Streets of seeds, one after the other; each is gone when the next one is asked for."""
    for number, seed in enumerate(seeds):
        with recorded_scene(request_of(number, seed, length_m)) as scene:
            yield scene


def avenue_scenes(seeds: Sequence[int], length_m: float = LENGTH_M) -> Iterator[RoadScene]:
    """Avenues of seeds."""
    return simulated_scenes(seeds, length_m, avenue_options_of)


def mounted_scenes(
    seeds: Sequence[int], length_m: float = LENGTH_M, *, images: bool = False
) -> Iterator[RoadScene]:
    """Streets of seeds that are recorded by heads of any height, tilt, rate and noise each."""
    for seed in seeds:
        sensor = any_sensor(seed)
        style = "rural" if seed % _URBAN_OF else "urban"
        request = StreetRequest(seed=seed, length_m=length_m, style=style, images=images)
        heads = "one head" if len(sensor.heads) == 1 else "two heads"
        name = f"{style}, {heads}, {sensor.turns_per_s:.0f}/s × {sensor.pulses} {seed}"
        with recorded_scene(request, sensor, name) as scene:
            yield scene


@contextmanager
def recorded_scene(
    request: StreetRequest, sensor: Sensor | None = None, name: str = ""
) -> Iterator[RoadScene]:
    """A street that is made and recorded, by a sensor of its own where one is given."""
    usual = f"{request.style} {request.sensor if sensor is None else 'any'} {request.seed}"
    usual += " twice" if request.passes > 1 else ""
    with TemporaryDirectory(prefix="zuka-") as position:
        folder, own = Path(position) / "street", Path(position) / "sensor.toml"
        if sensor is not None:
            write_sensor(sensor, own)
            request = replace(request, own_sensor=str(own))
        simulate_street(request, folder, SilentMonitor())
        with opened_scene(name or usual, folder) as scene:
            yield scene


def given_scenes(folders: Sequence[Path]) -> Iterator[RoadScene]:
    """Deliveries: LAZ files, trajectories and lists of images as CSV, and ``truth/``."""
    for folder in folders:
        with opened_scene(folder.name, folder) as scene:
            yield scene


@contextmanager
def opened_scene(name: str, delivery: Path) -> Iterator[RoadScene]:
    """A delivery, imported for the moment.

    Raises
    ------
    UserError
        As an import does.
    """
    request = ImportRequest(
        tuple(sorted(delivery.glob("*.laz"))),
        trajectories_in(delivery),
        _lists_in(delivery, _IMAGES),
        crs=_CRS,
    )
    with TemporaryDirectory(prefix="zuka-") as position:
        folders = import_drives(request, Path(position) / "drives", SilentMonitor())
        yield RoadScene(name, delivery, tuple(Drive(folder) for folder in folders))


def trajectories_in(delivery: Path) -> tuple[Path, ...]:
    """The CSV files of a delivery that begin with a column of times, whatever their names."""
    return _lists_in(delivery, _TIMES)


def _lists_in(delivery: Path, beginning: str) -> tuple[Path, ...]:
    """Its CSV files whose header begins so."""
    found = []
    for path in sorted(delivery.glob("*.csv")):
        with path.open(encoding="utf-8") as lines:
            if lines.readline().startswith(beginning):
                found.append(path)
    return tuple(found)


def cloud_of(delivery: Path) -> StreetCloud:
    """All points of a delivery, file by file."""
    paths = sorted(delivery.glob("*.laz"))
    parts = [laspy.read(path) for path in paths]
    truth = delivery / "truth"
    return StreetCloud(
        np.concatenate([np.asarray(one.xyz) for one in parts]),
        np.concatenate([np.asarray(one.intensity) for one in parts]),
        np.concatenate([np.load(truth / f"{path.stem}.labels.npy") for path in paths]),
        np.concatenate([np.load(truth / f"{path.stem}.instances.npy") for path in paths]),
    )


def found_by(tool: str, drives: Sequence[Drive]) -> RoadRun:
    """What a tool finds with its own parameters on drives of one street.

    Raises
    ------
    UserError
        As the runner does.
    """
    features: list[MappedFeature] = []
    notes: list[str] = []
    for result in results_of(tool, drives):
        for one in result.candidates:
            if not one.is_drawing:
                features.append(map_candidate(one, len(features) + 1))
        notes += [result.note.en] if result.note.en else []
    return RoadRun(MappedFile(Path(f"{tool}.geojson"), _CRS, tuple(features)), (*notes,))


def results_of(tool: str, drives: Sequence[Drive]) -> Iterator[CandidateResult]:
    """What a tool finds with its own parameters, one result for each share of the drives.

    Raises
    ------
    UserError
        As the runner does.
    """
    parameters = TOOLS[tool].parameters()
    with TemporaryDirectory(prefix="zuka-") as position:
        for share in run_shares(tool, drives, parameters, SilentMonitor()):
            into = Path(position) / share.drives[0].id
            result = run(share.request, share.monitor, into=into)
            if isinstance(result, CandidateResult):
                yield result


def map_candidate(candidate: Candidate, number: int) -> MappedFeature:
    """A candidate as a result file has it."""
    facts = {"kind": candidate.kind, "confidence": candidate.confidence, "status": "candidate"}
    return MappedFeature(
        number, candidate.geometry, candidate.xyz, {**candidate.attributes, **facts}
    )
