"""Sparse recordings of simulated streets with what each point is of: profiles and single scans."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import laspy
import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.road.road_scenes import cloud_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.scanning.any_mounting import any_sensor, write_sensor
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.spinning_head import scanned_streets
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

_PROFILE_M = 100.0
"""Length of a street that is driven along."""

_PROFILE_STYLES = ("urban", "urban", "rural", "urban", "highway", "rural")
_AVENUES = 0.35

_PULSES, _TURNS_PER_S = (250.0, 1500.0), (15.0, 80.0)
_NOISE_M, _DIVERGENCE_RAD, _MOST_M = (0.003, 0.02), (0.0005, 0.004), (40.0, 120.0)
"""Profile scanners of the first vehicles and small ones of today: some hundred points a turn, a
quarter to one degree apart, some tens of turns a second."""

_SPEED_KM_H, _SHAKES_M = (15.0, 40.0), (0.0, 0.005, 0.01, 0.02)
"""By how much each turn is off its neighbours, standard deviation along each axis: poses that come
less often than turns."""

_ORIGIN_M = (10_000.0, 20_000.0, 100.0)
"""Where single scans lie, which know no place of their own."""


@dataclass(frozen=True)
class CoarseRecording:
    """A sparse cloud and what is true of it.

    Attributes
    ----------
    name : str
        Of its street, and behind a dot its number there.
    xyz : (n, 3) float64
        m.
    label : (n,) uint8
        Codes of the contract.
    instance : (n,) int32
    kinds : mapping of int to str
        What each instance is.
    """

    name: str
    xyz: Floats
    label: NDArray[np.uint8]
    instance: NDArray[np.int32]
    kinds: Mapping[int, str]

    def drive(self, folder: Path) -> Drive:
        """The cloud as a delivery of points alone, imported into a folder."""
        header = laspy.LasHeader(point_format=0, version="1.2")
        header.scales, header.offsets = [0.001] * 3, np.floor(self.xyz.min(axis=0))
        las = laspy.LasData(header)
        las.x, las.y, las.z = self.xyz.T
        las.write(folder / "cloud.laz")
        (drive,) = import_drives(
            ImportRequest((folder / "cloud.laz",)), folder / "drives", SilentMonitor()
        )
        return Drive(drive)


def profile_recordings(seeds: Sequence[int]) -> Iterator[CoarseRecording]:
    """Streets of seeds, driven along with a sparse profile scanner whose turns are shaken."""
    for seed in seeds:
        random = chance(seed, "coarse profiles")
        sensor = _sparse_sensor(seed, random)
        with TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position)
            write_sensor(sensor, folder / "sensor.toml")
            style = _PROFILE_STYLES[seed % len(_PROFILE_STYLES)]
            request = StreetRequest(
                seed=seed,
                length_m=_PROFILE_M,
                style=style,
                own_sensor=str(folder / "sensor.toml"),
                images=False,
                avenue=bool(random.random() < _AVENUES),
                speed_km_h=float(random.uniform(*_SPEED_KM_H)),
            )
            simulate_street(request, folder / "street", SilentMonitor())
            cloud = cloud_of(folder / "street")
            things = json.loads((folder / "street/truth/instance_kinds.json").read_text("utf-8"))
            clouds = sorted((folder / "street").glob("*.laz"))
            times = np.concatenate([np.asarray(laspy.read(one)["gps_time"]) for one in clouds])
        turn = np.unique(np.floor(times * sensor.turns_per_s), return_inverse=True)[1]
        shake_m = random.choice(_SHAKES_M)
        shaken = shake_m * random.normal(0.0, 1.0, (int(turn.max()) + 1, 3))[turn]
        kinds = {int(number): one["kind"] for number, one in things.items()}
        name, xyz = f"{style} profiles {seed}", cloud.xyz + shaken
        yield CoarseRecording(name, xyz, cloud.label, cloud.instance, kinds)


def _sparse_sensor(seed: int, random: Generator) -> Sensor:
    """A head of any mounting that measures some hundred points a turn."""
    return replace(
        any_sensor(seed),
        pulses=int(_log_uniform(random, _PULSES)),
        turns_per_s=round(_log_uniform(random, _TURNS_PER_S), 1),
        noise_m=round(_log_uniform(random, _NOISE_M), 4),
        divergence_rad=float(random.uniform(*_DIVERGENCE_RAD)),
        returns=int(random.choice([1, 1, 2])),
        most_m=float(random.uniform(*_MOST_M)),
        measures_by="pulse",
    )


def _log_uniform(random: Generator, bounds: tuple[float, float]) -> float:
    return float(np.exp(random.uniform(*np.log(bounds))))


def scan_recordings(seeds: Sequence[int]) -> Iterator[CoarseRecording]:
    """Single scans of spinning heads on streets of seeds."""
    for street, scans in scanned_streets(seeds):
        rows = street.within(-street.length_m, 2 * street.length_m)
        things = [one for row in rows for one in street.section(row).things]
        kinds = {one.instance: one.kind for one in things}
        for number, scan in enumerate(scans):
            name = f"{street.style.id} scan {street.seed}.{number}"
            xyz = scan.xyz + _ORIGIN_M
            yield CoarseRecording(name, xyz, scan.labels, scan.instance, kinds)
