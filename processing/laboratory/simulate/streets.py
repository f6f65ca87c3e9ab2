"""A street made to order: built, driven along, recorded, written as a delivery with its truth."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.core.whole_folder import write_whole_folder
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.cameras.photographs import (
    DeliveryFrame,
    write_image_list,
    write_images,
)
from processing.laboratory.simulate.cameras.rigs import poses_of_pass, rig_of
from processing.laboratory.simulate.cameras.seen_street import SeenStreet
from processing.laboratory.simulate.control_points import write_control_points
from processing.laboratory.simulate.edge_evidence import EdgeEvidence
from processing.laboratory.simulate.moving_traffic.moving import movers_of
from processing.laboratory.simulate.plant_evidence import PlantEvidence
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.road_truth.clearance_evidence import ClearanceEvidence
from processing.laboratory.simulate.road_truth.true_roads import true_roads, write_true_roads
from processing.laboratory.simulate.scanning.beams import ScanPattern
from processing.laboratory.simulate.scanning.delivered_files import (
    CRS_NAME,
    ArrayFile,
    DeliveredPoints,
    PointFile,
)
from processing.laboratory.simulate.scanning.moving import MovingScene
from processing.laboratory.simulate.scanning.noise_options import NoiseOptions, noise_options
from processing.laboratory.simulate.scanning.recording import (
    Evidence,
    HeadChunk,
    Setup,
    SimulatedRecording,
    delivered_positions,
)
from processing.laboratory.simulate.scanning.return_kernels import intensities
from processing.laboratory.simulate.scanning.returns import Weather
from processing.laboratory.simulate.scanning.sensors import Head, Sensor, sensor_of
from processing.laboratory.simulate.scanning.simulated_passes import Driving, SimulatedPass, pass_of
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import Mover, Thing, TrueFeature
from processing.laboratory.simulate.simulated import Simulated
from processing.laboratory.simulate.street.styles import style_of
from processing.laboratory.simulate.truth import (
    RecordingEvidence,
    write_rough_positions,
    write_things,
    write_truth,
)
from processing.laboratory.simulate.wall_evidence import WallEvidence

_DRY_SHARE = 0.65
_SHORTEST_GROWTH = 0.03  # of grass: from a lawn just mown to a meadow, as often short as long
_POINTS_SHARE = 0.4  # of the progress of a pass; the rest is photographs
_SHOWN_M = 40.0  # of truth before the beginning and behind the end
_KMH = 3.6
DELTA_M = 1e-4
"""Step of the truth of places: true minus delivered, in tenths of a millimetre."""

_MOST_STEPS = np.iinfo(np.int16).max
_TRUTH_SHARE = 0.97  # of the progress; the rest is truth


def simulate_street(
    request: StreetRequest,
    folder: Path,
    monitor: Monitor,
    *,
    noise: NoiseOptions | None = None,
    weather: Weather | None = None,
) -> Simulated:
    """Make a street and its recording.

    Parameters
    ----------
    folder : Path
        New or empty; whole or not there afterwards.
    noise : NoiseOptions or None
        None: what the request says.
    weather : Weather or None
        None: drawn for the seed.

    Raises
    ------
    OutOfRange
        The request names a style or a sensor that there is none of.
    InUse
        There is something in the folder.
    NoSpace
        The disk is full.
    Cancelled
    """
    style = style_of(request.style)
    sensor = sensor_of(request.sensor, "mobile", request.own_sensor)
    with write_whole_folder(folder) as hidden:
        (hidden / "truth").mkdir()
        street = Street(
            request.seed,
            style,
            request.length_m,
            request.wear,
            is_avenue=request.avenue,
            is_flush=request.flush,
        )
        work = _Work(request, street, sensor, hidden, noise=noise, weather=weather)
        for number in range(request.passes):
            share = _TRUTH_SHARE / request.passes
            work.drive(number, PartMonitor(monitor, number * share, (number + 1) * share))
        monitor.report(_TRUTH_SHARE, Text("Writing truth", "正解データを書き出し中"))
        work.finish()
    return Simulated(
        folder,
        tuple(folder / name for name in work.point_files),
        tuple(folder / name for name in work.trajectories),
        tuple(folder / name for name in work.image_lists),
        folder / "truth",
        CRS_NAME,
        sum(work.counts.values()),
    )


@dataclass(frozen=True)
class _Files:
    """What one head's points go to."""

    points: PointFile
    labels: ArrayFile
    instances: ArrayFile
    deltas: ArrayFile


class _Work:
    """One simulation on its way: what is known of it so far."""

    def __init__(
        self,
        request: StreetRequest,
        street: Street,
        sensor: Sensor,
        folder: Path,
        *,
        noise: NoiseOptions | None,
        weather: Weather | None,
    ) -> None:
        self.request, self.street, self.sensor, self.folder = request, street, sensor, folder
        random = chance(request.seed, "place")
        self.origin = np.array(
            [random.uniform(-14_000, -8_000), random.uniform(-38_000, -32_000), 0.0]
        )
        self.origin[2] = random.uniform(5, 300)
        self.start_s = float(np.round(random.uniform(3.5e8, 4.2e8), 3))
        wet = random.random() > _DRY_SHARE
        self.weather = weather or Weather(
            float(random.uniform(0.05, 0.7)) if wet else 0.0,
            float(random.uniform(0.3, 0.9)),
            float(random.choice([0.0, 0.5, 0.9])),
            float(_SHORTEST_GROWTH ** chance(request.seed, "grass").random()),
        )
        self.scan_pattern = ScanPattern(
            request.pulses or sensor.pulses, request.turns_per_s or sensor.turns_per_s, 0.0
        )
        self.setup = Setup(
            sensor,
            self.scan_pattern,
            self.weather,
            noise or noise_options(request.seed, sensor, request.noise),
        )
        slow, fast = street.style.speed_m_s
        usual = float(chance(request.seed, "speed").uniform(slow, fast))
        self.driving = Driving(
            request.speed_km_h / _KMH or usual,
            request.stops,
            request.drift_m,
            request.attitude_deg,
            request.jumps_m,
            request.wander_m,
        )
        self.evidence = Evidence()
        self.walls, self.edges = WallEvidence(()), EdgeEvidence(())
        self.plants = PlantEvidence(())
        self.clearance = ClearanceEvidence(street, request.length_m)
        self.point_files: list[str] = []
        self.trajectories: list[str] = []
        self.image_lists: list[str] = []
        self.counts: dict[str, int] = {}
        self.things: dict[int, Thing] = {}
        self.truth: dict[tuple[int, int], TrueFeature] = {}
        self.passes: list[SimulatedPass] = []

    def drive(self, number: int, monitor: Monitor) -> None:
        """Drive once and write what was recorded."""
        monitor.report(0.0, Text("Recording", "計測中"))
        driven = pass_of(self.street, number, self.driving)
        movers = movers_of(self.street, driven)
        for mover in movers:
            instance = int(mover.mesh.instance[0])
            self.things[instance] = Thing(instance, mover.kind)
        recording = SimulatedRecording(
            self.street, self.setup, driven, MovingScene(self.street, movers)
        )
        points_share = _POINTS_SHARE if self.request.images else 1.0
        for section in recording.sections():
            monitor.check()
            self.things.update({one.instance: one for one in section.things})
            for position, one in enumerate(section.truth):
                # Walls are seen from afar, and must not count as made up.
                near = -_SHOWN_M < one.chainage_m < self.request.length_m + _SHOWN_M
                if near or one.file == "walls":
                    self.truth.setdefault((section.plan.index, position), one)
        if number == 0:  # later passes are along the same street
            self.walls = WallEvidence(self.truth.values())
            self.edges = EdgeEvidence(self.truth.values())
            self.plants = PlantEvidence(self.truth.values())
        with self._files(number) as files:
            for chunk in recording.chunks(PartMonitor(monitor, 0.0, points_share)):
                self._write(driven, number, chunk, files[chunk.head.name])
        self._write_trajectory(driven, number)
        self._write_true_trajectory(driven, number)
        if self.request.images:
            self._photograph(driven, movers, PartMonitor(monitor, points_share, 1.0))
        self.passes.append(driven)

    def finish(self) -> None:
        """Write truth, and what the whole is."""
        truth = self.folder / "truth"
        counted = (self.walls, self.edges, self.plants)
        seen = RecordingEvidence.by(self.passes[0], self.evidence, counted)
        features = list(self.truth.values())
        objects = write_truth(truth, features, seen, self.origin)
        self.clearance.write(truth, self.things, self.origin, CRS_NAME)
        roads = true_roads(self.street, self.request.length_m, self.origin)
        write_true_roads(truth / "road.csv", roads)
        write_things(truth / "instance_kinds.json", self.things.values())
        write_rough_positions(
            truth / "sign_initial.csv", features, seen, self.origin, self.request.seed
        )
        if self.request.control_per_km:
            write_control_points(
                self.folder, features, self.origin, self.request.seed, self.request.control_per_km
            )
        heads = {
            one.name: {
                "point_source_id": one.source_id,
                "lever_arm_fwd_left_up_m": list(one.lever_m),
                "spin_axis_yaw_deg": one.yaw_deg,
                "spin_axis_pitch_deg": one.pitch_deg,
            }
            for one in self.sensor.heads
        }
        scene: dict[str, Any] = {  # whatever JSON can hold
            **asdict(self.request),
            "heads": heads,
            "pulses_per_revolution": self.scan_pattern.pulses,
            "revolutions_per_s": self.scan_pattern.turns_per_s,
            "start_time_s": self.start_s,
            "duration_s": [one.duration_s for one in self.passes],
            "origin": self.origin.tolist(),
            "wetness": self.weather.wetness,
            "objects": objects,
            "points": self.counts,
        }
        text = json.dumps(scene, indent=1, ensure_ascii=False)
        (truth / "scene.json").write_text(text + "\n", encoding="utf-8")

    @contextmanager
    def _files(self, number: int) -> Iterator[dict[str, _Files]]:
        with ExitStack() as stack:
            files = {}
            for head in self.sensor.heads:
                stem = _numbered(head.name, number)
                truth = self.folder / "truth"
                files[head.name] = _Files(
                    stack.enter_context(PointFile(self.folder / f"{stem}.laz", self.origin)),
                    stack.enter_context(ArrayFile(truth / f"{stem}.labels.npy", np.uint8)),
                    stack.enter_context(ArrayFile(truth / f"{stem}.instances.npy", np.int32)),
                    stack.enter_context(ArrayFile(truth / f"{stem}.delta.npy", np.int16, 3)),
                )
                self.point_files.append(f"{stem}.laz")
            yield files
            for name, one in files.items():
                self.counts[_numbered(name, number)] = one.points.count

    def _write(self, driven: SimulatedPass, number: int, chunk: HeadChunk, files: _Files) -> None:
        returns = chunk.returns
        strength: NDArray[np.uint16] = np.empty(returns.pulse.size, np.uint16)
        intensities(returns.strength, self.weather.damping, strength)
        delivered = delivered_positions(
            driven, chunk.head, returns, self._mounted_rad(driven, chunk.head)
        )
        files.points.write(
            DeliveredPoints(
                delivered + self.origin,
                self._times(number) + returns.time_s,
                strength,
                returns.number,
                returns.count,
                chunk.head.source_id + number * len(self.sensor.heads),
            )
        )
        off = np.rint((returns.xyz - delivered) / DELTA_M)
        files.deltas.write(np.clip(off, -_MOST_STEPS, _MOST_STEPS))
        files.labels.write(returns.label)
        files.instances.write(returns.instance)
        self.evidence.count([returns])
        self.walls.count(returns)
        self.clearance.count(returns)
        self.edges.count(returns)
        self.plants.count(returns)

    def _mounted_rad(self, driven: SimulatedPass, head: Head) -> Floats:
        """(3,) how far a head is turned from what its calibration says; see `SimulatedPass`."""
        random = chance(self.request.seed, "mounting", driven.number, head.name)
        mounted: Floats = np.radians(self.request.mounting_deg) * random.normal(size=3)
        return mounted

    def _times(self, number: int) -> float:
        """When a pass begins: adjusted standard GPS time; some minutes after the one before."""
        before = sum(one.duration_s for one in self.passes[:number])
        return self.start_s + before + 600.0 * number

    def _photograph(self, driven: SimulatedPass, movers: list[Mover], monitor: Monitor) -> None:
        frame = DeliveryFrame(self.origin, self._times(driven.number), _prefix(driven.number))
        images = write_images(
            self.folder,
            poses_of_pass(driven),
            SeenStreet(self.street, movers, monitor.check).at,
            monitor,
            seed=self.request.seed,
            rig=rig_of(self.request.seed),
            frame=frame,
        )
        name = f"{_numbered('images', driven.number)}.csv"
        write_image_list(self.folder / name, images)
        self.image_lists.append(name)

    def _write_trajectory(self, driven: SimulatedPass, number: int) -> None:
        name = f"{_numbered('trajectory', number)}.csv"
        positions: Floats = driven.positions + driven.errors + self.origin
        self._write_table(self.folder / name, driven, positions, driven.delivered_deg)
        self.trajectories.append(name)

    def _write_true_trajectory(self, driven: SimulatedPass, number: int) -> None:
        path = self.folder / "truth" / f"{_numbered('trajectory', number)}.csv"
        self._write_table(path, driven, driven.positions + self.origin, driven.angles_deg)

    def _write_table(
        self, path: Path, driven: SimulatedPass, positions: Floats, angles_deg: Floats
    ) -> None:
        times = driven.time_s + self._times(driven.number)
        np.savetxt(
            path,
            np.column_stack([times, positions, angles_deg]),
            fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
            delimiter=",",
            comments="",
            header="time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg",
            encoding="utf-8",
        )


def _prefix(number: int) -> str:
    return "" if number == 0 else f"pass{number + 1}_"


def _numbered(name: str, number: int) -> str:
    return name if number == 0 else f"{name}_{number + 1}"
