"""The kernels as plain functions: points on a known shape, beside it and in its empty zones."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.templates import fit_kernels
from processing.methods.templates.fit_kernels import (
    GRADE,
    HEIGHT,
    OFFSET,
    POSE,
    TILT,
    TURN,
    refine_kernel,
    score_kernel,
    slab_kernel,
)
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.shape import FittableTemplate
from tests.processing.methods.templates.curb_street import CURB

Floats = NDArray[np.float64]
KERNELS = [name for name in vars(fit_kernels) if hasattr(vars(fit_kernels)[name], "py_func")]


@pytest.fixture(params=["compiled", "plain"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Run everything compiled, then as the plain functions that were compiled."""
    if request.param == "plain":
        for name in KERNELS:
            monkeypatch.setattr(fit_kernels, name, vars(fit_kernels)[name].py_func)
    return str(request.param)


def on_shape(template: ProfileTemplate, pose: Floats, *, rows: int = 9) -> Floats:
    """Points on a template that lies in a slab by a pose, a row every 8 cm."""
    positions = []
    for profile in template.shape:
        for one, other in itertools.pairwise(profile):
            share = np.linspace(0, 1, max(2, round(math.dist(one, other) / 0.015)))[:, None]
            positions.append(np.array(one) + share * (np.array(other) - np.array(one)))
    across, up = np.vstack(positions).T
    cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
    slab = []
    for along in np.linspace(-0.35, 0.35, rows):
        u = pose[OFFSET] + pose[TURN] * along + across * cos - up * sin
        v = pose[HEIGHT] + pose[GRADE] * along + across * sin + up * cos
        slab.append(np.column_stack([u, v, np.full(u.size, along)]))
    return np.ascontiguousarray(np.vstack(slab))


def score(slab: Floats, pose: Floats, shape: FittableTemplate) -> float:
    limits = (shape.tolerance_m, shape.reach_m, 1.0)
    return float(fit_kernels.score_kernel(slab, pose, shape.segments, shape.zones, limits)[0])


def test_a_moved_tilted_and_turned_shape_is_found_again(way: str) -> None:
    true = np.array([0.013, -0.008, math.radians(1.5), 0.02, -0.015])
    slab, shape = on_shape(CURB, true), FittableTemplate.of(CURB)
    pose = np.zeros(POSE)
    loose = np.full(POSE, 0.2)
    fit_kernels.refine_kernel(slab, pose, (np.zeros(POSE), loose), shape.segments, 0.02)
    assert pose == pytest.approx(true, abs=5e-4)
    assert score(slab, pose, shape) > 0.99


def test_stretches_without_points_are_unseen_not_missed(way: str) -> None:
    slab, shape = on_shape(CURB, np.zeros(POSE)), FittableTemplate.of(CURB)
    without_road = np.ascontiguousarray(slab[slab[:, 0] < 0.05])
    assert score(without_road, np.zeros(POSE), shape) > 0.99


def test_points_off_the_shape_count_against_what_they_lie_beside(way: str) -> None:
    shape = FittableTemplate.of(CURB)
    level = np.column_stack([np.linspace(-0.3, 0.3, 60), np.full(60, -0.15), np.zeros(60)])
    assert score(level, np.zeros(POSE), shape) < 0.6


def test_points_in_an_empty_zone_take_from_the_score(way: str) -> None:
    zone = (((-0.2, 0.1), (0.2, 0.1), (0.2, 0.4), (-0.2, 0.4)),)
    strict = FittableTemplate.of(
        ProfileTemplate("curb", CURB.shape, CURB.lines, zone, CURB.tolerance_m)
    )
    slab = on_shape(CURB, np.zeros(POSE))
    assert score(slab, np.zeros(POSE), strict) > 0.99
    wall = np.column_stack([np.zeros(200), np.linspace(0.12, 0.38, 200), np.zeros(200)])
    assert score(np.vstack([slab, wall]), np.zeros(POSE), strict) < 0.6
    assert score(np.vstack([slab, wall]), np.zeros(POSE), FittableTemplate.of(CURB)) > 0.7


def test_no_points_give_no_score(way: str) -> None:
    assert score(np.empty((0, 3)), np.zeros(POSE), FittableTemplate.of(CURB)) == 0.0


def test_a_slab_holds_what_lies_in_its_box(way: str) -> None:
    random = np.random.default_rng(5)
    local = random.uniform(-2, 2, (500, 3))
    heading = 0.7
    frame = np.array([0.2, -0.1, 0.3, math.cos(heading), math.sin(heading)])
    box = np.array([-1.0, 0.8, -0.5, 0.9, 0.4])
    slab, chosen = np.empty((500, 3)), np.empty(500, np.int64)
    count = fit_kernels.slab_kernel(local, frame, box, slab, chosen)
    away = local - frame[:3]
    along = away[:, 0] * frame[3] + away[:, 1] * frame[4]
    right = away[:, 0] * frame[4] - away[:, 1] * frame[3]
    inside = (abs(along) <= 0.4) & (right >= -1) & (right <= 0.8)
    inside &= (away[:, 2] >= -0.5) & (away[:, 2] <= 0.9)
    assert chosen[:count].tolist() == np.flatnonzero(inside).tolist()
    wanted = np.column_stack([right, away[:, 2], along])[inside]
    assert slab[:count] == pytest.approx(wanted)


def test_kernels_are_there_to_be_tried() -> None:
    assert {score_kernel, refine_kernel, slab_kernel} <= {vars(fit_kernels)[k] for k in KERNELS}
