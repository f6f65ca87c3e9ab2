"""An earthwork site to order: two dates, scanned from tripods, with exact cut and fill."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import fill_parameters
from processing.core.text import Text
from processing.core.whole_folder import write_whole_folder
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.returns import Weather
from processing.laboratory.simulate.scanning.sensors import Sensor, sensor_of
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.simulated import Simulated
from processing.laboratory.simulate.sites.bodies import NAMES, SiteKind
from processing.laboratory.simulate.sites.delivery import (
    CRS,
    CloudFile,
    SiteReference,
    write_json,
    write_site,
    write_terrain,
)
from processing.laboratory.simulate.sites.layout import SiteLayout, layout_of, scene_mesh
from processing.laboratory.simulate.sites.movement import MovingThings, dust_of, tracks_of
from processing.laboratory.simulate.sites.recording import (
    SiteSurvey,
    pattern_of,
    record_points,
    scans_at,
)
from processing.laboratory.simulate.sites.stations import count_for, stations_of
from processing.laboratory.simulate.sites.terrain import SiteTerrain, terrain_of
from processing.laboratory.simulate.sites.volumes import SEEN_CELL_M, cut_and_fill

DATES = ("before", "after")
_FIRST_S = 350_000_000.0  # adjusted standard GPS time
_DAY_S = 86_400.0


def simulate_site(
    request: SiteRequest,
    folder: Path,
    monitor: Monitor,
    *,
    registration_m: float = 0.0,
    weather: Weather | None = None,
) -> Simulated:
    """Make a site, record it on both dates, and write the delivery and its truth.

    Parameters
    ----------
    folder : Path
        Holds ``in`` and ``truth`` afterwards; appears only when everything is written.
    registration_m : float
        Standard deviation of an error that all of the later date has in common: nothing changed
        where nothing was done, and yet the clouds differ.
    weather : Weather or None
        Of both dates; None: drawn for the seed.

    Raises
    ------
    InUse
        The folder holds files already.
    OutOfRange
        A wish is not within its limits.
    MissingInput, NoSpace, BadFile
        What the operating system says; `Cancelled`.
    """
    request = fill_parameters(SiteRequest, dataclasses.asdict(request))
    sensor = sensor_of(request.sensor, "standing", request.own_sensor)
    with write_whole_folder(folder) as hidden:
        for part in ("in", "truth"):
            (hidden / part).mkdir()
        count = _write(request, sensor, hidden, (monitor, registration_m), weather)
    monitor.report(1.0)
    points = tuple(folder / "in" / f"{date}.laz" for date in DATES)
    return Simulated(folder, points, (), (), folder / "truth", CRS, count)


@dataclass(frozen=True)
class _Site:
    """What both dates have in common."""

    request: SiteRequest
    sensor: Sensor
    terrain: SiteTerrain
    position: SiteReference
    polygon: Floats
    weather: Weather | None

    @property
    def cells(self) -> tuple[int, int]:
        per_cell = max(1, round(SEEN_CELL_M / self.terrain.before.heights.res))
        rows, columns = self.terrain.before.heights.z.shape
        return -(-(rows - 1) // per_cell), -(-(columns - 1) // per_cell)


def _write(
    request: SiteRequest,
    sensor: Sensor,
    hidden: Path,
    work: tuple[Monitor, float],
    weather: Weather | None,
) -> int:
    """Write all files; gives how many points there are."""
    monitor, registration_m = work
    random = chance(request.seed, "place")
    terrain = terrain_of(request.seed, request.style, request.length_m, monitor.check)
    east, north = np.round(random.uniform((-30_000, -60_000), (10_000, -20_000)))
    position = SiteReference(float(east), float(north))
    site = _Site(
        request,
        sensor,
        terrain,
        position,
        _polygon(request.seed, terrain.before.heights.size_m),
        weather,
    )
    starts = [_FIRST_S + float(random.integers(0, 30_000)) * 1000.0]
    starts.append(starts[0] + round(float(random.uniform(5, 60))) * _DAY_S)
    common = chance(request.seed, "registration").normal(0, 1, 3) * registration_m
    seen, epochs = [], {}
    for number, date in enumerate(DATES):
        part = PartMonitor(monitor, 0.48 * number, 0.48 * (number + 1))
        cloud, epoch = _record(site, date, hidden, starts[number], (part, common * number))
        epochs[date] = {**cloud.counts, **epoch}
        ground = terrain.before if date == "before" else terrain.after
        write_terrain(hidden / "truth" / f"terrain_{date}.npz", ground.heights, position)
        seen.append(cloud.seen)
        monitor.check()
    on_map = position.on_map(site.polygon)
    write_site(hidden / "in" / "site.geojson", on_map)
    write_json(hidden / "truth" / "volume.json", _volumes(site, seen[0], seen[1]))
    scene = {"scene": "simulated site", **dataclasses.asdict(request), "epochs": epochs}
    write_json(hidden / "truth" / "scene.json", {**scene, "later_shift_m": common.tolist()})
    return sum(int(str(one["points"])) for one in epochs.values())


def _record(
    site: _Site, date: str, hidden: Path, starts_s: float, work: tuple[Monitor, Floats]
) -> tuple[CloudFile, dict[str, object]]:
    """Record one date; gives its cloud and what stood there."""
    monitor, shift = work
    survey = _survey(site, date, monitor)
    text = Text("Scanning the site.", "現場をスキャンしています。")
    path, truth = hidden / "in" / f"{date}.laz", hidden / "truth"
    with CloudFile(path, truth, site.position, starts_s, cells=site.cells) as cloud:
        for share, points in record_points(survey):
            monitor.check()
            cloud.write(dataclasses.replace(points, xyz=points.xyz + shift))
            monitor.report(share, text)
    east, north = site.position.easting_m, site.position.northing_m
    stations = [
        [one.position[0] + east, one.position[1] + north, one.position[2]]
        for one in survey.stations
    ]
    objects = [
        {"kind": NAMES[one.kind], "x": one.x + east, "y": one.y + north}
        for one in survey.layout.things
    ]
    moving = [NAMES[one.body.kind] for one in survey.moving.tracks]
    return cloud, {
        "stations": stations,
        "wetness": survey.weather.wetness,
        "objects": objects,
        "moving": moving,
        "dust_clouds": len(survey.dust),
    }


def _survey(site: _Site, date: str, monitor: Monitor) -> SiteSurvey:
    request, sensor = site.request, site.sensor
    pattern = pattern_of(sensor, request.spacing_m)
    layout = layout_of(request.seed, date, site.terrain, monitor.check)
    monitor.check()
    mesh = scene_mesh(layout)
    monitor.check()
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    scene = RaycastScene(mesh, middle)
    monitor.check()
    random = chance(request.seed, "stations", date)
    count = count_for(request.length_m, request.stations)
    stations = stations_of(random, layout, scene, count, monitor.check)
    starts = scans_at(pattern, len(stations))
    moving = chance(request.seed, "moving", date)
    tracks = tracks_of(moving, layout, starts[-1] + pattern.scan_s)
    usual = Weather(
        float(moving.uniform(0, 0.6)) if moving.random() < 0.5 else 0.0,
        float(moving.uniform(0.4, 1.0)),
    )
    return SiteSurvey(
        request.seed,
        date,
        sensor,
        pattern,
        site.weather or usual,
        stations,
        layout,
        scene,
        MovingThings(tracks, layout),
        dust_of(moving, layout, starts, pattern.scan_s),
        _kinds(layout, [track.body.kind for track in tracks]),
    )


def _kinds(layout: SiteLayout, moving: list[SiteKind]) -> Integers:
    return np.concatenate([layout.kinds(), np.array([int(one) for one in moving], np.int64)])


def _polygon(seed: int, size_m: tuple[float, float]) -> Floats:
    """The site's outline: the rectangle with its corners cut off, some sides bent inwards."""
    random = chance(seed, "polygon")
    east, north = size_m
    margin = random.uniform(0.02, 0.08) * north
    low, high = np.array([margin, margin]), np.array([east - margin, north - margin])
    cuts = random.uniform(0.05, 0.35, (4, 2)) * (high - low)
    corners = [
        (low[0], low[1] + cuts[0, 1]),
        (low[0] + cuts[0, 0], low[1]),
        (high[0] - cuts[1, 0], low[1]),
        (high[0], low[1] + cuts[1, 1]),
        (high[0], high[1] - cuts[2, 1]),
        (high[0] - cuts[2, 0], high[1]),
        (low[0] + cuts[3, 0], high[1]),
        (low[0], high[1] - cuts[3, 1]),
    ]
    if random.random() < 0.4:
        notch = (random.uniform(0.4, 0.6) * east, low[1] + random.uniform(0.05, 0.2) * north)
        corners.insert(2, notch)
    return np.array(corners)


def _volumes(site: _Site, before: Integers, after: Integers) -> dict[str, object]:
    heights = site.terrain.before.heights
    found = cut_and_fill(heights, site.terrain.after.heights, site.polygon)
    seen = (before > 0) & (after > 0)
    cut, fill = float(found.cut_m3.sum()), float(found.fill_m3.sum())
    area = float(found.area_m2.sum())
    unseen = float(found.area_m2[~seen].sum())
    return {
        "cut_m3": cut,
        "fill_m3": fill,
        "net_m3": fill - cut,
        "area_m2": area,
        "polygon": site.position.on_map(site.polygon).tolist(),
        "seen_in_both_share": 1.0 - unseen / area,
        "unseen_area_m2": unseen,
        "cut_where_seen_m3": float(found.cut_m3[seen].sum()),
        "fill_where_seen_m3": float(found.fill_m3[seen].sum()),
        "grid_m": heights.res,
        "integration_step_m": 0.0,
        "note": "net = fill - cut; exact, between the triangulated grounds of both dates",
    }
