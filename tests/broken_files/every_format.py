"""A small file of every format and content that the registry says is read by a command."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import ezdxf
import laspy
import numpy as np
import pyogrio.raw
import shapely

from processing.formats.format import Content
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.app.volume_command import CORNER, SIDE_M, write_design
from tests.delivered_files import make_las, ply_bytes, sbet_bytes, trajectory_rows, trajectory_text
from tests.pulsewaves_flight import write_pulse_flight
from tests.structured_scans import ptx_text, sphere_scan, write_e57

COUNT = 60
_PCD = (
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\n"
    "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n1 2 3\n4 5 6\n7 8 9\n"
)
_IMAGES = (
    "path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,"
    "focal_px,cx_px,cy_px,width_px,height_px,projection\n"
    "画像/a.jpg,10.5,1,2,3,90,0,-30,500,399.5,299.5,800,600,perspective\n"
)
_AREA = [(2.0, 2.0), (18.0, 2.0), (18.0, 18.0), (2.0, 18.0), (2.0, 2.0)]
_LINE = [(1.0, 10.0), (SIDE_M - 1.0, 10.0)]
_CODES = np.arange(COUNT, dtype=np.uint8) % 3 * 9

Writer = Callable[[Path], object]


def _las(path: Path) -> None:
    make_las(path, count=COUNT)


def _text(path: Path) -> None:
    """The points of :func:`_las`, and whether each is no noise."""
    las = path.with_suffix(".las")
    _las(las)
    np.savetxt(path, np.column_stack([laspy.read(las).xyz, _CODES == 0]), "%.3f %.3f %.3f %d")
    las.unlink()


def _sbet(path: Path) -> None:
    """At the times of :func:`_las`."""
    records = np.frombuffer(sbet_bytes()).reshape(-1, 17).copy()
    records[:, 0] += 1_000.0 - records[0, 0]
    records.tofile(path)


def _pulses(path: Path) -> None:
    """A folder; its first file by name is what gets damaged."""
    echoes = np.ones(COUNT, "u1")
    for name, values in (
        ("pulse-float32-theta", np.radians(np.arange(COUNT) + 100.0).astype("<f4")),
        ("pulse-uint8-n_echo", echoes),
        ("echo-float32-range", np.full(COUNT, 5.0, "<f4")),
    ):
        (path / name).mkdir(parents=True)
        values.tofile(path / name / "100.bin")
    (path / "pulse-linear-time").mkdir()
    times = f"{COUNT} entries 1000.0 + 4e-06 pulse_index\n"
    (path / "pulse-linear-time" / "100.txt").write_text(times)


def _coordinates(places: list[tuple[float, float]]) -> list[list[float]]:
    return [(CORNER[:2] + place).tolist() for place in places]


def _geojson(kind: str, places: list[tuple[float, float]]) -> Writer:
    shown: object = _coordinates(places) if kind == "LineString" else [_coordinates(places)]
    member = {"type": "Feature", "properties": {}, "geometry": {"type": kind, "coordinates": shown}}

    def write(path: Path) -> None:
        path.write_text(json.dumps({"type": "FeatureCollection", "features": [member]}))

    return write


def _gpkg(kind: str, places: list[tuple[float, float]]) -> Writer:
    make = shapely.LineString if kind == "LineString" else shapely.Polygon
    shape = shapely.to_wkb(np.array([make(_coordinates(places))]))

    def write(path: Path) -> None:
        pyogrio.raw.write(path, shape, [], [], geometry_type=kind, crs="EPSG:6677", driver="GPKG")

    return write


def _dxf(places: list[tuple[float, float]], *, is_closed: bool) -> Writer:
    def write(path: Path) -> None:
        drawing = ezdxf.new("R2010")
        drawing.modelspace().add_lwpolyline(_coordinates(places), close=is_closed)
        drawing.saveas(path)

    return write


def _map_of_curbs(path: Path) -> None:
    """Both edges of a curb of 10 m, as ``zuka run curbs`` writes them."""
    lines = [
        {
            "type": "Feature",
            "properties": {"kind": "curb", "edge": edge, "run": 1, "height_m": 0.15},
            "geometry": {
                "type": "LineString",
                "coordinates": [[x, 0.0, up] for x in np.arange(0.0, 10.5, 0.5)],
            },
        }
        for edge, up in (("upper", 0.15), ("lower", 0.0))
    ]
    crs = {"type": "name", "properties": {"name": "EPSG:6677"}}
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": lines}))


def _file_of_curbs(driver: str) -> Writer:
    """Lines of a driver of GDAL; a Shapefile has its table and the rest beside it."""
    lines = [[(x, 0.0, up) for x in np.arange(0.0, 10.5, 0.5)] for up in (0.15, 0.0)]
    shapes = shapely.to_wkb(np.array([shapely.LineString(one) for one in lines]))
    values = [np.array(["curb"] * 2, object), np.array(["upper", "lower"], object)]

    def write(path: Path) -> None:
        pyogrio.raw.write(
            path,
            shapes,
            values,
            ["kind", "edge"],
            geometry_type="LineString Z",
            crs="EPSG:6677",
            driver=driver,
        )

    return write


def _exported_map(format_id: str, kinds: tuple[str, ...] = ("curb_upper", "curb_lower")) -> Writer:
    """A map as ``zuka export`` writes it: lines of 10 m, and points for trees."""

    def write(path: Path) -> None:
        features = [
            Feature(kind, kind, Geometry.LINE, (Vertex((0.0, 0.0, up)), Vertex((10.0, 0.0, up))))
            if kind.startswith("curb")
            else Feature(kind, kind, Geometry.POINT, (Vertex((3.0, 4.0, up)),))
            for kind, up in zip(kinds, (0.15, 0.0), strict=False)
        ]
        catalogue = read_catalogue(path_of("catalogue/level500.toml"))
        with TemporaryDirectory() as folder:
            request = ExportRequest((format_id,), Path(folder) / "map")
            (written,) = export(features, catalogue, "EPSG:6677", request)
            path.write_bytes(written.read_bytes())

    return write


_OF_AREA, _OF_LINE = _geojson("Polygon", _AREA), _geojson("LineString", _LINE)


SMALL_FILES: dict[tuple[Content, str], Writer] = {
    (Content.POINTS, "las"): _las,
    (Content.POINTS, "laz"): _las,
    (Content.POINTS, "ply"): lambda path: path.write_bytes(ply_bytes()),
    (Content.POINTS, "e57"): lambda path: write_e57(path, sphere_scan(12, 10)),
    (Content.POINTS, "ptx"): lambda path: path.write_text(ptx_text(sphere_scan(12, 10))),
    (Content.POINTS, "pulsewaves"): lambda path: write_pulse_flight(path, 20),
    (Content.POINTS, "pcd"): lambda path: path.write_text(_PCD),
    (Content.POINTS, "text"): _text,
    (Content.POINTS, "pulses"): _pulses,
    (Content.CLASSES, "las"): _las,
    (Content.CLASSES, "laz"): _las,
    (Content.CLASSES, "text"): _text,
    (Content.CLASSES, "npy"): lambda path: np.save(path, _CODES),
    (Content.CLASSES, "npz"): lambda path: np.savez(path, code=_CODES),
    (Content.IMAGES, "image-list"): lambda path: path.write_text(_IMAGES, "utf-8"),
    (Content.TRAJECTORY, "trajectory"): lambda path: path.write_text(
        trajectory_text(trajectory_rows())
    ),
    (Content.TRAJECTORY, "sbet"): _sbet,
    (Content.FEATURES, "geojson"): _map_of_curbs,
    (Content.FEATURES, "json"): _map_of_curbs,
    (Content.FEATURES, "gpkg"): _file_of_curbs("GPKG"),
    (Content.FEATURES, "shp"): _file_of_curbs("ESRI Shapefile"),
    (Content.FEATURES, "dxf"): _exported_map("dxf"),
    (Content.FEATURES, "dm"): _exported_map("dm", ("street_tree",)),
    (Content.FEATURES, "sima"): _exported_map("sima", ("street_tree",)),
    (Content.AREAS, "geojson"): _OF_AREA,
    (Content.AREAS, "json"): _OF_AREA,
    (Content.AREAS, "gpkg"): _gpkg("Polygon", _AREA),
    (Content.AREAS, "dxf"): _dxf(_AREA, is_closed=True),
    (Content.LINES, "geojson"): _OF_LINE,
    (Content.LINES, "json"): _OF_LINE,
    (Content.LINES, "gpkg"): _gpkg("LineString", _LINE),
    (Content.LINES, "dxf"): _dxf(_LINE, is_closed=False),
    (Content.SURFACE, "landxml"): lambda path: write_design(path, "FH1"),
}
