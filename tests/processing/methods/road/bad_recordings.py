"""Short recordings of roads that something is wrong with: made of a few triangles, cast exactly.

A profile (across to the left, up) is drawn along a way of the vehicle, or beside it; a head turns
on the vehicle as on any other, and its points are delivered and imported as files are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.core.monitor import Monitor, SilentMonitor
from processing.laboratory.simulate.scanning.beams import ScanPattern, beams_of
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.sensors import Head
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import MeshBuilder, TriangleShape
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, run
from processing.tools.tool import Candidate, CandidateResult

Floats = NDArray[np.float64]
RoadCrossSection = Sequence[tuple[float, float]]

ORIGIN = np.array([-11_000.0, -35_000.0, 100.0])
START_S = 410_000_000.0
HIGH_M = 2.0
RECORDS_PER_S = 200.0
FARTHEST_M = 40.0
SPEED_M_S = 5.0

ROAD: RoadCrossSection = (
    (-7.0, 0.17),
    (-4.02, 0.15),
    (-4.0, 0.0),
    (4.0, 0.0),
    (4.02, 0.15),
    (7.0, 0.17),
)
"""Eight metres between two curbs of 15 cm."""
WALLS: RoadCrossSection = ((-6.0, 8.0), (-6.0, -30.0))
"""A wall to the right of the way; the one to the left is its mirror image."""
TUNNEL: RoadCrossSection = (
    *(
        (3.0 * np.cos(turn), 1.5 + 3.0 * np.sin(turn))
        for turn in np.radians(np.arange(-30, 211, 5))
    ),
    (2.6, 0.0),
)
"""A round pipe with a level floor, nowhere a step."""

HEAD_45 = Head("left", 1, (-0.6, 0.3, 0.5), 45.0, 18.0)
HEAD_90 = Head("left", 1, (-0.6, 0.0, 0.5), 0.0, 0.0)


@dataclass(frozen=True)
class DrivenRecording:
    """What is driven, scanned and delivered.

    Attributes
    ----------
    vehicle_path : (m, 2) float64
        Where the vehicle is at each record, 200 a second, m.
    facing : (m,) float64
        Radians, anticlockwise from east.
    scene : tuple of Shape
        Triangles.
    keep : callable
        (n,) bool of (n, 3) places and (n,) pulse numbers: what comes back.
    """

    vehicle_path: Floats
    facing: Floats
    scene: tuple[TriangleShape, ...]
    head: Head = HEAD_45
    pulses: int = 1_000
    turns_per_s: float = 50.0
    noise_m: float = 0.003
    start_s: float = START_S
    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    seed: int = 0
    keep: Callable[[Floats, NDArray[np.int64]], NDArray[np.bool_]] = field(
        default=lambda xyz, _: np.ones(len(xyz), np.bool_)
    )


@dataclass(frozen=True)
class RunOutcome:
    """What came of a run: candidates, or the sentence that says why there are none."""

    candidates: tuple[Candidate, ...]
    sentence: str


def straight(length_m: float, speed_m_s: float = SPEED_M_S, *, lane_m: float = 0.0) -> Floats:
    """A way to the east at a constant speed."""
    x = np.arange(0.0, length_m, speed_m_s / RECORDS_PER_S)
    return np.column_stack([x, np.full_like(x, lane_m)])


def turning_back(length_m: float, radius_m: float) -> Floats:
    """To the east, half a circle to the left, and back."""
    step = SPEED_M_S / RECORDS_PER_S
    out = np.arange(0.0, length_m, step)
    arc = np.arange(0.0, np.pi, step / radius_m)
    legs = (
        np.column_stack([out, np.full_like(out, -radius_m)]),
        np.column_stack([length_m + radius_m * np.sin(arc), -radius_m * np.cos(arc)]),
        np.column_stack([length_m - out, np.full_like(out, radius_m)]),
    )
    return np.vstack(legs)


def facing_along(vehicle_path: Floats) -> Floats:
    """The direction of a way, where it has one."""
    steps = np.gradient(vehicle_path, axis=0)
    return np.asarray(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))


def drawn_along(profile: RoadCrossSection, line: Floats) -> TriangleShape:
    """A profile swept along a line in plan, as triangles."""
    sides = np.gradient(line, axis=0)
    sides /= np.hypot(*sides.T)[:, None]
    left = np.column_stack([-sides[:, 1], sides[:, 0]])
    across, up = np.array(profile).T
    plan = line[:, None] + across[None, :, None] * left[:, None]
    heights = np.broadcast_to(up, (len(line), len(up)))[..., None]
    vertices = np.concatenate([plan, heights], axis=2).reshape(-1, 3)
    row, column = np.mgrid[: len(line) - 1, : len(up) - 1].reshape(2, -1)
    first = row * len(up) + column
    ahead = first + len(up)
    triangles = [[first, first + 1, ahead], [first + 1, ahead + 1, ahead]]
    return vertices, np.concatenate([np.column_stack(one) for one in triangles]).astype(np.int64)


def road_along(length_m: float, profile: RoadCrossSection = ROAD) -> TriangleShape:
    """A straight road to the east, longer than what is driven of it."""
    return drawn_along(profile, np.array([[-25.0, 0.0], [length_m + 25.0, 0.0]]))


def mirrored(profile: RoadCrossSection) -> RoadCrossSection:
    """The same on the other side."""
    return tuple((-across, up) for across, up in profile)


def delivered(recording: DrivenRecording, folder: Path, name: str = "left") -> ImportRequest:
    """Write points and trajectory."""
    folder.mkdir(parents=True, exist_ok=True)
    driven = _pass(recording)
    count = int(driven.duration_s * recording.pulses * recording.turns_per_s)
    scan_pattern = ScanPattern(recording.pulses, recording.turns_per_s, 0.0)
    beams = beams_of(driven, recording.head, scan_pattern, range(count))
    builder = MeshBuilder()
    for shape in recording.scene:
        builder.add(shape, Material.ASPHALT, 11, 0)
    ranges = RaycastScene(builder.mesh(), np.zeros(3)).cast(beams.origins, beams.directions).ranges
    random = np.random.default_rng(recording.seed)
    is_met = ranges < FARTHEST_M
    ranges = ranges[is_met] + random.normal(0.0, recording.noise_m, int(is_met.sum()))
    xyz = beams.origins[is_met] + ranges[:, None] * beams.directions[is_met]
    pulse = np.flatnonzero(is_met)
    kept = recording.keep(xyz, pulse)
    cloud = folder / f"{name}.laz"
    times = recording.start_s + beams.time_s[pulse[kept]]
    write_points(cloud, xyz[kept] + ORIGIN + recording.shift_m, times, recording.head.source_id)
    trajectory = folder / f"{name}.csv"
    _write_trajectory(trajectory, driven, recording)
    return ImportRequest((cloud,), (trajectory,), crs="EPSG:6677")


def write_points(path: Path, xyz: Floats, time_s: Floats, source_id: int = 1) -> Path:
    """Points as they are delivered, LAZ 1.4."""
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), ORIGIN
    cloud = laspy.LasData(header)
    cloud.xyz = xyz
    cloud.gps_time = time_s
    cloud.point_source_id = np.full(len(xyz), source_id, np.uint16)
    cloud.intensity = np.full(len(xyz), 9_000, np.uint16)
    cloud.return_number = np.ones(len(xyz), np.uint8)
    cloud.number_of_returns = np.ones(len(xyz), np.uint8)
    cloud.write(str(path))
    return path


def imported(folder: Path, *requests: ImportRequest) -> tuple[Drive, ...]:
    """Drives of what was delivered together."""
    whole = ImportRequest(
        tuple(path for one in requests for path in one.inputs),
        tuple(path for one in requests for path in one.trajectories),
        crs="EPSG:6677",
    )
    folders = import_drives(whole, folder / "drives", SilentMonitor())
    return tuple(Drive(one) for one in folders)


def recorded(folder: Path, recording: DrivenRecording) -> tuple[Drive, ...]:
    """A recording, delivered and imported."""
    return imported(folder, delivered(recording, folder))


def told_by(
    tool: str, drives: Sequence[Drive], folder: Path, monitor: Monitor | None = None
) -> RunOutcome:
    """What a tool finds, or why it finds nothing."""
    request = RunRequest(tool, drives[0], TOOLS[tool].parameters(), tuple(drives[1:]))
    try:
        result = run(request, monitor or SilentMonitor(), into=folder / f"{tool} columns")
    except UserError as error:
        return RunOutcome((), error.what.en)
    assert isinstance(result, CandidateResult)
    return RunOutcome(result.candidates, result.note.en)


def told_of(tool: str, request: ImportRequest, folder: Path) -> RunOutcome:
    """The same from the delivery on, which may be refused already."""
    try:
        drives = imported(folder, request)
    except UserError as error:
        return RunOutcome((), error.what.en)
    return told_by(tool, drives, folder)


def nearest_to_path_m(candidates: Sequence[Candidate], vehicle_path: Floats) -> float:
    """How near any candidate comes to the middle of the vehicle's path, m; inf without any."""
    import shapely

    path = shapely.linestrings(vehicle_path[:, :2] + ORIGIN[:2])
    rings = [
        np.vstack([one.xyz, one.xyz[:1]]) if one.geometry == "area" else one.xyz
        for one in candidates
    ]
    lines = [shapely.linestrings(ring[:, :2]) for ring in rings]
    return min((float(shapely.distance(one, path)) for one in lines), default=np.inf)


def with_pause(recording: DrivenRecording, at: int, seconds: float) -> DrivenRecording:
    """The same, but the vehicle stands a while at one of its records and goes on scanning."""
    again = np.full(int(seconds * RECORDS_PER_S), at)
    order = np.r_[np.arange(at), again, np.arange(at, len(recording.vehicle_path))]
    return replace(
        recording, vehicle_path=recording.vehicle_path[order], facing=recording.facing[order]
    )


def _pass(recording: DrivenRecording) -> SimulatedPass:
    count = len(recording.vehicle_path)
    time_s = np.arange(count) / RECORDS_PER_S
    positions = np.column_stack([recording.vehicle_path, np.full(count, HIGH_M)])
    c, s, zero, one = (
        np.cos(recording.facing),
        np.sin(recording.facing),
        np.zeros(count),
        np.ones(count),
    )
    axes = np.stack(
        [
            np.stack([c, s, zero], -1),
            np.stack([-s, c, zero], -1),
            np.stack([zero, zero, one], -1),
        ],
        axis=-1,
    )
    angles = np.column_stack([zero, zero, (90.0 - np.degrees(recording.facing)) % 360.0])
    none = np.zeros((count, 3))
    return SimulatedPass(0, time_s, positions, axes, zero, angles, none, none)


def _write_trajectory(path: Path, driven: SimulatedPass, recording: DrivenRecording) -> None:
    positions = driven.positions + ORIGIN + recording.shift_m
    np.savetxt(
        path,
        np.column_stack([driven.time_s + recording.start_s, positions, driven.angles_deg]),
        fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
        delimiter=",",
        comments="",
        header="time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg",
        encoding="utf-8",
    )
