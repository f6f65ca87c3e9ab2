"""What looks like a covered gutter and is none: L-gutters, joints of pavement, old curb stones."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.tools.tool import Candidate
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    DrivenRecording,
    RoadCrossSection,
    drawn_along,
    facing_along,
    recorded,
    straight,
    told_by,
)

LookalikeShape = tuple[NDArray[np.float64], NDArray[np.int64]]
Box = tuple[float, float, float, float]  # from and to along, from and to across to the left

LENGTH_M, BEYOND_M = 16.0, 8.0
LID_M, EDGES_M = 0.6, (-3.38, -3.0)
HOLES_M = ((-3.335, -3.235), (-3.145, -3.045))
HOLE_M = 0.03
BAR_M = 0.01
BARRED = frozenset((22, 27, 28))


def plates(boxes: list[Box], height_m: float = 0.0) -> LookalikeShape:
    """Level rectangles."""
    corners = [
        (x, y, height_m) for a, b, c, d in boxes for x, y in ((a, c), (b, c), (b, d), (a, d))
    ]
    first = 4 * np.arange(len(boxes))[:, None]
    faces = np.vstack([first + np.array(face) for face in ((0, 1, 2), (0, 2, 3))])
    return np.array(corners), faces.astype(np.int64)


def sheet(across: tuple[float, float], height_m: float) -> LookalikeShape:
    """A level strip along the whole way."""
    low, high = across
    return plates([(-BEYOND_M, LENGTH_M + BEYOND_M, low, high)], height_m)


def pieces(length_m: float, gap_m: float) -> Iterator[tuple[float, float]]:
    """Where pieces of one length begin and end, a gap between them."""
    for start in np.arange(-BEYOND_M, LENGTH_M + BEYOND_M, length_m):
        yield float(start) + gap_m / 2, float(start + length_m) - gap_m / 2


def lids(barred: frozenset[int] = frozenset()) -> list[LookalikeShape]:
    """Lids with twin holes at their joints, some pieces barred, over a channel 30 cm deep."""
    boxes: list[Box] = []
    for number, (first, last) in enumerate(pieces(LID_M, 0.004)):
        if number in barred:
            bars = np.arange(first, last - BAR_M, 4 * BAR_M).tolist()
            boxes += [(bar, bar + BAR_M, *EDGES_M) for bar in bars]
            continue
        boxes.append((first + HOLE_M / 2, last - HOLE_M / 2, *EDGES_M))
        solid = (EDGES_M[0], *(edge for hole in HOLES_M for edge in hole), EDGES_M[1])
        for low, high in zip(solid[::2], solid[1::2], strict=True):
            boxes += [(first, first + HOLE_M / 2, low, high), (last - HOLE_M / 2, last, low, high)]
    low, high = EDGES_M
    channel = ((low, 0.0), (low, -0.3), (high, -0.3), (high, 0.0))
    sides = [sheet((-7.0, low), 0.0), sheet((high, 7.0), 0.0)]
    return [plates(boxes), along_way(channel), *sides]


def along_way(profile: RoadCrossSection) -> LookalikeShape:
    """A profile along the whole way."""
    return drawn_along(profile, np.array([[-BEYOND_M, 0.0], [LENGTH_M + BEYOND_M, 0.0]]))


def grooved(across: tuple[float, float], gap_m: float, deep_m: float) -> list[LookalikeShape]:
    """A strip of blocks of 60 cm with grooves between them."""
    blocks: list[Box] = [(first, last, *across) for first, last in pieces(0.6, gap_m)]
    return [plates(blocks), sheet(across, -deep_m)]


def l_gutter() -> list[LookalikeShape]:
    """Blocks of 60 cm with an apron of 50 cm before a curb of 15 cm."""
    curb = along_way(((-7.0, 0.17), (-3.52, 0.15), (-3.5, 0.0)))
    return [curb, *grooved((-3.5, -3.0), 0.008, 0.012), sheet((-3.0, 7.0), 0.0)]


def pavement_of_slabs() -> list[LookalikeShape]:
    """Concrete slabs of 60 cm over the whole road."""
    return grooved((-7.0, 7.0), 0.008, 0.015)


def old_curb_stones() -> list[LookalikeShape]:
    """Worn stones of 60 cm, 15 cm wide and 3 cm high, with open joints between them."""
    stones = plates([(first, last, -3.15, -3.0) for first, last in pieces(0.6, 0.02)], 0.03)
    return [stones, sheet((-7.0, 7.0), 0.0)]


def covers_found(shapes: list[LookalikeShape], folder: Path) -> list[Candidate]:
    """Lids and gratings that the tool finds."""
    vehicle_path = straight(LENGTH_M)
    recording = DrivenRecording(
        vehicle_path,
        facing_along(vehicle_path),
        tuple(shapes),
        head=HEAD_45,
        pulses=3_000,
        turns_per_s=60.0,
        noise_m=0.002,
    )
    told = told_by("gutters", recorded(folder, recording), folder)
    return [one for one in told.candidates if one.geometry == "area"]


def test_lids_with_holes_are_found(tmp_path: Path) -> None:
    found = covers_found(lids(), tmp_path)
    assert len(found) >= 15
    assert {one.attributes["length_m"] for one in found} == {LID_M}
    inner = found[2:-2]
    assert np.concatenate([one.points for one in inner]).min() >= 0


def test_gratings_between_lids_are_told_from_lids(tmp_path: Path) -> None:
    """One and two side by side, to a usual length; no lid beside them is taken for one."""
    found = covers_found(lids(BARRED), tmp_path)
    gratings = [one for one in found if one.attributes["type"] == "grating"]
    middles = sorted(float(one.xyz[:, 0].mean()) for one in gratings)
    begins = [(number + 0.5) * LID_M - BEYOND_M for number in sorted(BARRED)]
    assert len(middles) == len(begins)
    np.testing.assert_allclose(np.diff(middles), np.diff(begins), atol=0.05)
    assert {one.attributes["length_m"] for one in gratings} <= {LID_M, 0.5}
    assert len(found) >= 15


@pytest.mark.parametrize("shapes", [l_gutter, pavement_of_slabs, old_curb_stones])
def test_what_looks_like_a_gutter_is_none(
    shapes: Callable[[], list[LookalikeShape]], tmp_path: Path
) -> None:
    assert covers_found(shapes(), tmp_path) == []
