"""A street of known curbs: where their edges are, and drives that recorded it without noise."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.templates.profile_template import MadeLine, ProfileTemplate
from processing.methods.templates.slab import SectionFrame
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from tests.builders import START, SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv
from tests.street_scene import CROSSFALL, CURB_AT_M, CURB_HEIGHT_M, WALL_AT_M, StreetScene

Floats = NDArray[np.float64]

CURVE = 1 / 60
LENGTH_M = 30.0
LOW_M = -CROSSFALL * CURB_AT_M
TOP_M = LOW_M + CURB_HEIGHT_M

CURB = ProfileTemplate(
    "curb",
    (
        (
            (-0.3, 0.0),
            (0.0, 0.0),
            (0.0, -CURB_HEIGHT_M),
            (0.3, -CURB_HEIGHT_M + 0.3 * CROSSFALL),
        ),
    ),
    (MadeLine("curb_upper"), MadeLine("curb_upper", (0.0, -CURB_HEIGHT_M))),
)
"""Of the left side: sidewalk, face, road."""


def recorded(folder: Path, *, without: tuple[float, float] | None = None) -> Drive:
    """Drive along a bend without noise; points of the curb between two stations are lost."""
    street = simulated_drive(
        3,
        pulses_per_revolution=1200.0,
        length_m=LENGTH_M,
        lost_share=0.0,
        curve=CURVE,
        range_noise_m=0.0,
    )
    if without is not None:
        along, across = stations(street.xyz)
        is_lost = (along >= without[0]) & (along < without[1]) & (np.abs(across - CURB_AT_M) < 1.0)
        kept = {name: values[~is_lost] for name, values in street.columns.items()}
        street = dataclasses.replace(street, columns=kept)
    return imported(folder, street)


def imported(folder: Path, street: SimulatedDrive, *, is_bare: bool = False) -> Drive:
    """Import a recording; a bare one has neither times, nor trajectory, nor its order."""
    if is_bare:
        order = np.random.default_rng(0).permutation(street.columns["time"].size)
        columns = {name: values[order] for name, values in street.columns.items()}
        times = np.full_like(columns["time"], np.nan)
        street = dataclasses.replace(street, columns={**columns, "time": times})
    points = write_laz(street, folder / "street.laz")
    trajectories = () if is_bare else (write_trajectory_csv(street, folder / "trajectory.csv"),)
    (folder / "drives").mkdir()
    request = ImportRequest((points,), trajectories)
    (made,) = import_drives(request, folder / "drives", SilentMonitor())
    return Drive(made)


def stations(xyz: Floats) -> tuple[Floats, Floats]:
    """Distance along the road's middle line of places, and to the left of it."""
    return StreetScene(CURVE, LENGTH_M).along_across(xyz - START)


def frame_at(along: float, across: float, height: float) -> SectionFrame:
    """Look along the road from a place of it."""
    turned, radius = CURVE * along, 1 / CURVE
    east, north = (math.cos(turned) - 1) * radius, math.sin(turned) * radius
    position = START + np.array(
        [east - across * math.cos(turned), north - across * math.sin(turned), height]
    )
    return SectionFrame(position, math.pi / 2 + turned)


def off_edge(xyz: Floats, height: float, across: float = CURB_AT_M) -> Floats:
    """How far places lie off an edge of the curb, in the plane square to it."""
    return np.hypot(stations(xyz)[1] - across, xyz[:, 2] - START[2] - height)


WALL_FOOT = ProfileTemplate(
    "step",
    (((0.0, CURB_HEIGHT_M), (0.0, 0.0), (0.3, 0.0)),),
    (MadeLine("curb_upper", (0.0, CURB_HEIGHT_M)), MadeLine("curb_upper")),
)
"""What a curb and the foot of a wall have in common, seen from the left of it."""

WALL_FRAME = frame_at(15.0, WALL_AT_M, TOP_M)
CURB_FRAME = frame_at(15.0, CURB_AT_M, TOP_M)
