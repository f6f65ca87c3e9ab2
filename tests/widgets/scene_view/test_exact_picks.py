"""A click takes the measured point that looking at every single point would give."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from processing.image.attributes.tile_cache import TileRequest
from processing.image.images_of_drives import image_of
from processing.image.search.clip import Clip
from processing.image.search.ray_hits import HitLimits, hits_kernel, merge_kernel
from processing.image.tiles.tiles import TileKey
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import small_drive
from widgets.scene_view.points.point_finder import PointFinder
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import NEAR_M, SceneProjection
from widgets.scene_view.rendering.scene_tile import DrawnTile, SceneTile
from widgets.shared.view_settings import ViewSettings

DriveImage = tuple[Drive, ImageKind]


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[DriveImage, ...]:
    """Two scanners' recordings of one street, shown by different images."""
    folder = tmp_path_factory.mktemp("drives")
    left, _ = small_drive(folder / "left", seed=1, multi_return_share=0.1)
    right, _ = small_drive(folder / "right", seed=2)
    return (left, ImageKind.REVERSIBLE), (right, ImageKind.TRAJECTORY_CENTER)


def drawn_of(drive: Drive, kind: ImageKind) -> DrawnTile:
    """A tile in the picture: that the drive is seen at all; its points are none."""
    request = TileRequest(drive.id, kind, TileKey(0, 0, 0), "intensity", 2.0, 98.0)
    empty = np.empty((0, 3), np.float32)
    tile = SceneTile(request, np.empty(0, np.int64), empty, empty.astype(np.uint8), 0.1)
    return DrawnTile(tile, np.zeros(3, np.float32), np.zeros(3, np.float32))


def brute_force(
    drives: tuple[DriveImage, ...],
    projection: SceneProjection,
    pixel: tuple[float, float],
    clip: Clip | None,
) -> tuple[float, float] | None:
    """Depth and offset of the point that the rule gives among all points of all drives."""
    depths, offsets = [], []
    for drive, _ in drives:
        xyz = drive.xyz(slice(None))
        if clip is not None:
            xyz = xyz[clip.holds(xyz)]
        pixels, depth = projection.to_screen(xyz - ORIGIN)
        offset = np.hypot(*(pixels - pixel).T)
        offsets.append(offset[offset <= 6.0])
        depths.append(depth[offset <= 6.0])
    depth, offset = np.concatenate(depths), np.concatenate(offsets)
    if not depth.size:
        return None
    within = offset <= 2.0 if (offset <= 2.0).any() else np.ones(offset.size, np.bool_)
    front = float(depth[within].min())
    surface = np.flatnonzero(within & (depth <= front + max(0.1, 0.02 * front)))
    best = surface[offset[surface].argmin()]
    return float(depth[best]), float(offset[best])


ORIGIN = np.array([-11_020.0, -35_010.0, 123.0])
PIXELS = st.tuples(st.floats(0, 800), st.floats(0, 600))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    away_m=st.floats(0.5, 3000.0),
    is_parallel=st.booleans(),
    pixel=PIXELS,
    what=st.sampled_from(["all", "box", "one drive"]),
)
def test_a_pick_is_what_looking_at_every_point_gives(
    drives: tuple[DriveImage, ...],
    *,
    seed: int,
    away_m: float,
    is_parallel: bool,
    pixel: tuple[float, float],
    what: str,
) -> None:
    random = np.random.default_rng(seed)
    shown = drives[:1] if what == "one drive" else drives
    drive = shown[-1][0]
    target = drive.xyz(np.array([random.integers(drive.count)]))[0]
    camera = SceneCamera(
        (0.0, 0.0, 0.0),
        heading_deg=random.uniform(0, 360),
        pitch_deg=random.uniform(-90, 20),
        is_parallel=is_parallel,
    ).centred_on(target - ORIGIN, away_m)
    projection = SceneProjection(camera, 800, 600)
    # Half of the clicks go where something is for sure.
    if seed % 2:
        pixel = 400.0 + random.uniform(-5, 5), 300.0 + random.uniform(-5, 5)
    clip = (
        Clip.box(target - np.array([4.0, 3.0, 0.5]), target + np.array([4.0, 6.0, 2.0]))
        if what == "box"
        else None
    )
    finder = PointFinder(ViewSettings())
    finder.use(shown, ORIGIN)
    finder.clip_to(clip)
    found = finder.exact([drawn_of(*one) for one in shown], projection, *pixel)
    wanted = brute_force(shown, projection, pixel, clip)
    assert (found is None) == (wanted is None)
    if found is None or wanted is None:
        return
    pixels, depth = projection.to_screen(np.array(found.position.xyz)[None] - ORIGIN)
    assert found.depth_m == pytest.approx(depth[0], abs=1e-6)
    # Two points may be equally near; which of them is taken doesn't matter.
    assert np.hypot(*(pixels[0] - pixel)) == pytest.approx(wanted[1], abs=1e-6)
    assert found.position.measured is not None


def test_a_point_that_no_pixel_of_the_image_shows_is_found(drives: tuple[DriveImage, ...]) -> None:
    drive, kind = drives[0]
    image = image_of(drive, kind)
    shown = image.raster(range(image.rows), range(image.width))
    hidden = np.setdiff1d(np.arange(drive.count), shown)
    assert hidden.size
    position = drive.xyz(hidden[:1])[0]
    camera = SceneCamera((0.0, 0.0, 0.0), pitch_deg=-50.0).centred_on(position - ORIGIN, 0.6)
    finder = PointFinder(ViewSettings())
    finder.use([(drive, kind)], ORIGIN)
    found = finder.exact([drawn_of(drive, kind)], SceneProjection(camera, 800, 600), 400.0, 300.0)
    assert found is not None
    assert found.position.measured is not None
    assert found.position.measured.point == hidden[0]


def test_drives_without_anything_in_the_picture_are_not_searched(
    drives: tuple[DriveImage, ...],
) -> None:
    finder = PointFinder(ViewSettings())
    finder.use(drives, ORIGIN)
    camera = SceneCamera((0.0, 0.0, 50.0), pitch_deg=-90.0)
    assert finder.exact([], SceneProjection(camera, 800, 600), 400.0, 300.0) is None


@given(st.lists(st.tuples(st.integers(-3, 9), st.integers(0, 6)), max_size=40))
def test_what_is_kept_are_those_nearer_to_the_eye_or_to_the_pixel_than_all_others(
    pairs: list[tuple[int, int]],
) -> None:
    assume(pairs)
    found = np.column_stack([np.array(pairs, np.float64), np.zeros((len(pairs), 2))])
    for merge in (merge_kernel, merge_kernel.py_func):  # type: ignore[attr-defined]
        kept = np.empty((len(found), 4))
        half = merge(found[: len(found) // 2], kept, 0)
        kept = kept[: merge(found[len(found) // 2 :], kept, half)]
        wanted = sorted(
            {
                (depth, offset)
                for depth, offset in pairs
                if not any(
                    one != (depth, offset) and one[0] <= depth and one[1] <= offset for one in pairs
                )
            }
        )
        assert [(row[0], row[1]) for row in kept] == wanted


def test_the_plain_loops_give_the_same() -> None:
    random = np.random.default_rng(3)
    integers = random.integers(-50, 50, (300, 3)).astype(np.int32)
    projection = SceneProjection(SceneCamera((0.0, -80.0, 0.0), pitch_deg=0.0), 100, 100)
    limits = HitLimits(50.0, 50.0, NEAR_M, 6.0, 2.0, np.inf, 0.1, 0.02)
    matrix = projection.matrix_with_depth
    stretches, whole = np.array([[0, 120], [130, 300]]), np.array([[0, 300]])
    fast, plain = np.zeros((300, 4)), np.zeros((300, 4))
    count = hits_kernel(integers, stretches, matrix, limits, fast)
    hits_kernel.py_func(integers, stretches, matrix, limits, plain)  # type: ignore[attr-defined]
    np.testing.assert_allclose(fast, plain, rtol=1e-12)
    positions = integers.astype(np.float32)
    fast[:], plain[:] = 0.0, 0.0
    assert 0 < count <= hits_kernel(positions, whole, matrix, limits, fast)
    hits_kernel.py_func(positions, whole, matrix, limits, plain)  # type: ignore[attr-defined]
    np.testing.assert_allclose(fast, plain, rtol=1e-12)
