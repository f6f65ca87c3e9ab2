"""How well places in space and places in camera images agree, on streets whose truth is known.

``python -m processing.laboratory.accuracy.camera_accuracy STREET_FOLDER…`` writes one Markdown
table: how far the projections of true things are from where the pictures show them, how near a
click at a sign's centre comes to it, and how near two images do, where they foretell an error of at
most 10 cm. A street is a folder with LAZ files, ``trajectory.csv``, ``images.csv`` and ``truth``.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from processing.cameras.depth import DepthPicture
from processing.cameras.stereo import stereo_position
from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.plate_visibility import (
    TruePlate,
    line_in_picture,
    plate_in_picture,
    plate_of,
)
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_pixels import read_pixels
from processing.recording.drive import Drive

_LEAST_PX = 8.0
_LEAST_FACING = 0.3
_LEAST_POINTS = 20
_CURB_FROM_M, _CURB_TO_M, _CURB_PIECE_M, _ALONE_PX = 3.0, 12.0, 0.5, 8.0
_POLE_TO_M, _POLE_HEIGHTS_M = 20.0, (0.7, 1.7)
_CLICK_TO_M = 30.0
_FORETOLD_M, _NOISE_PX, _REPETITIONS = 0.1, 0.5, 50


@dataclass(frozen=True)
class Photograph:
    """One image of a street: its camera, what it shows and what hides what."""

    name: str
    camera: Camera
    picture: Floats
    depth: DepthPicture

    def sees(self, xyz: Floats) -> bool:
        """Whether (n, 3) places are all inside the image and none is hidden."""
        inside = self.camera.shows(self.camera.pixels_of(xyz)).all()
        return bool(inside) and not self.depth.hides(xyz).any()

    def sees_plate(self, plate: TruePlate) -> bool:
        """Whether a plate's bright side is seen whole, and not too small."""
        to_camera = np.array(self.camera.image.xyz) - plate.xyz
        facing = float(plate.normal @ to_camera / np.linalg.norm(to_camera))
        middle = plate.xyz + 0.05 * plate.normal
        if facing < _LEAST_FACING or not self.sees(np.vstack([plate.outline, middle])):
            return False
        return bool(np.ptp(self.camera.pixels_of(plate.outline), axis=0).min() >= _LEAST_PX)


@dataclass(frozen=True)
class AccuracyRow:
    """One line of the table: how many, and how far off in a unit."""

    what: str
    unit: str
    off: tuple[float, ...]
    allowed: float

    def text(self, street: str) -> str:
        """As Markdown."""
        values = np.array(self.off)
        if not values.size:
            return f"| {street} | {self.what} | 0 | – | – | – | {self.allowed:g} {self.unit} |"
        share = float((values <= self.allowed).mean())
        return (
            f"| {street} | {self.what} | {values.size} | {np.median(values):.2f} {self.unit} "
            f"| {values.max():.2f} {self.unit} | {share:.0%} | {self.allowed:g} {self.unit} |"
        )


def main(arguments: list[str]) -> int:
    """Score the streets named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("streets", nargs="+", type=Path)
    chosen = parser.parse_args(arguments)
    sys.stdout.write("| street | what | seen | median off | largest | within | wanted |\n")
    sys.stdout.write("|---|---|---|---|---|---|---|\n")
    for street in chosen.streets:
        for row in rows_of(street):
            sys.stdout.write(row.text(street.name) + "\n")
            sys.stdout.flush()
    return 0


def rows_of(street: Path) -> Iterator[AccuracyRow]:
    """The lines of the table for one street."""
    signs = [plate_of(f) for f in _features(street / "truth" / "signs.geojson")]
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        photographs = _photographs(street, Path(folder) / "drives")
        yield AccuracyRow("sign outlines", "px", tuple(_plates_off(photographs, signs)), 1.5)
        poles = _features(street / "truth" / "poles.geojson")
        yield AccuracyRow("pole sides", "px", tuple(_poles_off(photographs, poles)), 1.5)
        curbs = _features(street / "truth" / "curbs.geojson")
        yield AccuracyRow("curb edges", "px", tuple(_curbs_off(photographs, curbs)), 1.5)
        yield AccuracyRow("click at a sign", "m", tuple(_clicks_off(photographs, signs)), 0.05)
        yield AccuracyRow(
            "stereo of marked signs", "m", tuple(_stereo_found(photographs, signs)), 0.10
        )
        yield AccuracyRow(
            "stereo with 0.5 px noise", "m", tuple(_stereo_noisy(photographs, signs)), 0.10
        )


def _features(path: Path) -> list[dict[str, Any]]:  # as GeoJSON has them
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["features"]
    return found


def _photographs(street: Path, into: Path) -> list[Photograph]:
    request = ImportRequest(
        tuple(sorted(street.glob("*.laz"))), (street / "trajectory.csv",), (street / "images.csv",)
    )
    drives = [Drive(path) for path in import_drives(request, into, SilentMonitor())]
    return [
        Photograph(
            image.path.stem,
            Camera(image),
            read_pixels(image).pixels.astype(np.float64),
            DepthPicture(image, drives),
        )
        for image in drives[0].images or ()
    ]


def _plates_off(photographs: list[Photograph], signs: list[TruePlate]) -> Iterator[float]:
    for photograph, plate in itertools.product(photographs, signs):
        if photograph.sees_plate(plate):
            off = plate_in_picture(photograph.picture, photograph.camera, plate)
            if off is not None:
                yield float(np.hypot(*off))


def _poles_off(photographs: list[Photograph], poles: list[dict[str, Any]]) -> Iterator[float]:
    for photograph, pole in itertools.product(photographs, poles):
        foot = np.array(pole["geometry"]["coordinates"], dtype=np.float64)
        way = foot[:2] - photograph.camera.image.xyz[:2]
        distance = float(np.hypot(*way))
        if not _CURB_FROM_M < distance < _POLE_TO_M:
            continue
        radius = pole["properties"]["diameter_m"] / 2
        side = radius * np.array([-way[1], way[0], 0.0]) / distance
        low, high = (foot + np.array([0.0, 0.0, up]) for up in _POLE_HEIGHTS_M)
        sides = np.array([low + side, high + side, low - side, high - side])
        if not photograph.sees(np.vstack([low, high]) - np.append(way, 0.0) * radius / distance):
            continue
        ends = photograph.camera.pixels_of(sides)
        off = line_in_picture(photograph.picture, ends)
        if off is not None:
            yield abs(off)


def _curbs_off(photographs: list[Photograph], curbs: list[dict[str, Any]]) -> Iterator[float]:
    lines = [
        (curb["properties"]["edge"], _pieces(np.array(curb["geometry"]["coordinates"])))
        for curb in curbs
        if curb["properties"]["type"] == "curb"
    ]
    everything = np.vstack([piece.mean(axis=0) for _, pieces in lines for piece in pieces])
    for photograph in photographs:
        shown = photograph.camera.pixels_of(everything)
        for piece in itertools.chain.from_iterable(pieces for _, pieces in lines):
            distance = float(photograph.camera.distances_to(piece[:1])[0])
            if not _CURB_FROM_M < distance < _CURB_TO_M or not photograph.sees(piece):
                continue
            ends = photograph.camera.pixels_of(piece)
            if _is_alone(ends, shown):
                off = line_in_picture(photograph.picture, ends)
                if off is not None:
                    yield abs(off)


def _pieces(line: Floats) -> list[Floats]:
    """(2, 3) pieces of a line, about as long as wanted."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.arange(0.0, along[-1], _CURB_PIECE_M)
    positions = np.column_stack([np.interp(at, along, axis) for axis in line.T])
    return [positions[i : i + 2] for i in range(len(positions) - 1)]


def _is_alone(ends: Floats, others: Floats) -> bool:
    """Whether no other edge's piece is so near beside a piece that they could be mixed up."""
    way = ends[1] - ends[0]
    long = float(np.hypot(*way))
    if long < _LEAST_PX:
        return False
    away = others - ends.mean(axis=0)
    along, across = away @ way / long, np.abs(away @ np.array([-way[1], way[0]]) / long)
    beside = (np.abs(along) < long) & (across > 1.0)
    return bool(np.min(across[beside], initial=np.inf) > _ALONE_PX)


def _clicks_off(photographs: list[Photograph], signs: list[TruePlate]) -> Iterator[float]:
    for photograph, plate, pixel in _mark_plates(photographs, signs):
        is_near = float(photograph.camera.distances_to(plate.xyz[None])[0]) <= _CLICK_TO_M
        if plate.points >= _LEAST_POINTS and is_near:
            found = photograph.depth.point_at((float(pixel[0]), float(pixel[1])))
            away = np.inf if found is None else np.linalg.norm(np.array(found.xyz) - plate.xyz)
            yield float(away)


def _mark_plates(
    photographs: list[Photograph], signs: list[TruePlate]
) -> Iterator[tuple[Photograph, TruePlate, Floats]]:
    """Plates that are found in pictures, and where their centres are seen."""
    for photograph, plate in itertools.product(photographs, signs):
        if photograph.sees_plate(plate):
            off = plate_in_picture(photograph.picture, photograph.camera, plate)
            if off is not None:
                yield photograph, plate, photograph.camera.pixels_of(plate.xyz[None])[0] + off


def _stereo_found(photographs: list[Photograph], signs: list[TruePlate]) -> Iterator[float]:
    """Signs marked in two pictures, by the pair that foretells the smallest error."""
    marked = list(_mark_plates(photographs, signs))
    for plate in signs:
        own = [(photograph.camera, pixel) for photograph, again, pixel in marked if again is plate]
        yield from _best_pair_off(own, plate)


def _stereo_noisy(photographs: list[Photograph], signs: list[TruePlate]) -> Iterator[float]:
    random = np.random.default_rng(1)
    for plate in signs:
        middle = plate.xyz + 0.05 * plate.normal
        cameras = [p.camera for p in photographs if p.sees(middle[None])]
        for _ in range(_REPETITIONS):
            noisy = [
                (camera, camera.pixels_of(plate.xyz[None])[0] + random.normal(0, _NOISE_PX, 2))
                for camera in cameras
            ]
            yield from _best_pair_off(noisy, plate)


def _best_pair_off(marked: list[tuple[Camera, Floats]], plate: TruePlate) -> Iterator[float]:
    found = []
    for one, other in itertools.combinations(marked, 2):
        try:
            found.append(stereo_position(one, other, pixel_error_px=_NOISE_PX))
        except Unsuitable:
            continue
    if found:
        best = min(found, key=lambda position: position.error_m)
        if best.error_m <= _FORETOLD_M:
            yield float(np.linalg.norm(best.xyz - plate.xyz))


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
