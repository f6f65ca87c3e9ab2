"""Which tiles stand in for others, how large a budget grows, and what a feed tells."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache
from processing.image.tiles.tiles import TileKey
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.scene_view.points.budget import FrameBudget
from widgets.scene_view.points.tile_feed import SceneRequest, TileFeed
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.scene_tile import TileAppearance, TileId, shown_tiles
from widgets.shared.view_settings import PointStyle

KIND = ImageKind.TRAJECTORY_CENTER


def tile(level: int, row: int, column: int, drive: str = "a") -> TileId:
    return TileId(drive, KIND, TileKey(level, row, column))


PARENT = tile(1, 0, 0)
CHILDREN = [tile(0, row, column) for row in (0, 1) for column in (0, 1)]


def test_tiles_that_are_there_are_shown_as_wanted() -> None:
    assert shown_tiles(CHILDREN, [*CHILDREN, PARENT]) == set(CHILDREN)


def test_a_parent_stays_until_all_its_children_are_there() -> None:
    assert shown_tiles(CHILDREN, [PARENT, *CHILDREN[:3]]) == {PARENT}


def test_children_stay_until_their_parent_is_there() -> None:
    assert shown_tiles([PARENT], CHILDREN) == set(CHILDREN)


def test_the_nearest_coarser_tile_stands_in() -> None:
    grand = tile(2, 0, 0)
    assert shown_tiles([CHILDREN[0]], [grand, PARENT]) == {PARENT}
    assert shown_tiles([CHILDREN[0]], [grand]) == {grand}


def test_a_tile_with_all_points_takes_the_place_of_the_finest_one_of_its_pixels() -> None:
    fine = CHILDREN[3]
    whole = TileId("a", KIND, TileKey(0, 1, 1, has_all=True))
    assert shown_tiles([whole], [fine]) == {fine}
    assert shown_tiles([whole], [fine, whole]) == {whole}
    assert shown_tiles([fine], [whole]) == {whole}
    assert shown_tiles([whole, *CHILDREN[:3]], [PARENT, whole]) == {PARENT}


def test_tiles_of_another_drive_never_stand_in() -> None:
    assert shown_tiles([PARENT], [tile(0, 0, 0, "b")]) == frozenset()


def test_nothing_is_shown_of_what_is_no_longer_wanted() -> None:
    assert shown_tiles([tile(0, 5, 5)], [tile(0, 5, 5), PARENT]) == {tile(0, 5, 5)}


@given(st.lists(st.tuples(st.integers(0, 2**31), st.integers(0, 3)), min_size=2, max_size=6))
def test_a_slow_loader_never_leaves_a_hole_where_something_was(
    looks: list[tuple[int, int]],
) -> None:
    there: set[TileId] = set()
    shown: frozenset[TileId] = frozenset()
    for seed, at_once in looks:
        random = np.random.default_rng(seed)
        wanted = random_choice(random)
        coming = sorted(wanted - there, key=lambda one: random.random())
        while True:
            covered = cells_of(shown) & cells_of(wanted)
            shown = shown_tiles(wanted, there)
            assert cells_of(shown) >= covered
            assert len(cells_of(shown)) == sum(len(cells_of([one])) for one in shown)
            # As the cloud does: what is neither shown nor wanted goes.
            there &= wanted | shown
            # The camera may move on before all has come.
            if not coming or random.random() < 0.1:
                break
            for _ in range(at_once + 1):
                there |= {coming.pop()} if coming else set()
        if not coming:
            assert shown_tiles(wanted, there) == wanted


_LEVELS = 4


def random_choice(random: np.random.Generator) -> set[TileId]:
    """Tiles that cover the whole image once, some finer than others."""
    waiting, chosen = [tile(_LEVELS - 1, 0, 0)], set()
    while waiting:
        one = waiting.pop()
        if one.key.level == 0 or random.random() < 0.3:
            chosen.add(one)
            continue
        level, row, column = one.key.level - 1, 2 * one.key.row, 2 * one.key.column
        waiting += [tile(level, row + i, column + j) for i in (0, 1) for j in (0, 1)]
    return chosen


def cells_of(tiles: Iterable[TileId]) -> set[tuple[int, int]]:
    """The tiles of the finest level that lie below some tiles."""
    return {
        ((one.key.row << one.key.level) + i, (one.key.column << one.key.level) + j)
        for one in tiles
        for i in range(1 << one.key.level)
        for j in range(1 << one.key.level)
    }


def test_slow_frames_make_the_budget_smaller_and_fast_ones_larger() -> None:
    slow, fast = FrameBudget(), FrameBudget()
    for _ in range(20):
        slow.record_moving(slow.moving_points, 0.3)
        fast.record_moving(fast.moving_points, 0.01)
    assert slow.moving_points < 50_000
    assert fast.moving_points > 1_000_000
    assert fast.is_fast
    assert not slow.is_fast


def test_a_frame_with_few_points_does_not_raise_the_budget() -> None:
    budget = FrameBudget()
    before = budget.moving_points
    budget.record_moving(before // 10, 0.001)
    assert budget.moving_points == before


def test_frames_about_as_long_as_wanted_leave_the_budget() -> None:
    budget = FrameBudget()
    before = budget.moving_points
    budget.record_moving(before, 0.076)
    assert budget.moving_points == before


def test_a_picture_at_rest_has_never_fewer_points_than_a_moving_one() -> None:
    budget = FrameBudget()
    for _ in range(40):
        budget.record_still(budget.still_points, 5.0)
        budget.record_moving(budget.moving_points, 0.001)
    assert budget.still_points >= budget.moving_points


@pytest.fixture
def scene_request(left_drive: Drive) -> SceneRequest:
    origin = np.array(left_drive.info.lowest)
    middle = (np.array(left_drive.info.highest) - origin) / 2
    camera = SceneCamera((0.0, 0.0, 0.0)).centred_on(middle, 60.0)
    return SceneRequest(
        drives=((left_drive, KIND),),
        origin=origin,
        age=7,
        camera=camera.for_tiles(origin, 800, 600),
        showing=TileAppearance(PointStyle()),
        budget_points=1_000_000,
        is_still=True,
        kept=frozenset(),
        there={},
        known=frozenset(),
    )


def test_a_feed_gives_the_points_of_the_tiles_that_it_chose(
    qtbot: QtBot, left_drive: Drive, scene_request: SceneRequest
) -> None:
    tiles = TileCache()
    tiles.use({left_drive.id: left_drive}.__getitem__)
    feed = TileFeed(tiles)
    arrived: dict[TileId, object] = {}
    feed.arrived.connect(
        lambda tiles: arrived.update({one.id: one for one in tiles}),
        Qt.ConnectionType.QueuedConnection,
    )
    with qtbot.waitSignal(feed.chosen, timeout=20_000) as chosen:
        feed.request(scene_request)
    assert chosen.args is not None
    choice = chosen.args[0]
    qtbot.waitUntil(lambda: arrived.keys() >= set(choice.tiles), timeout=20_000)
    for one in arrived.values():
        assert one.age == 7
        assert one.local_xyz.dtype == np.float32
        exact = left_drive.xyz(one.points) - scene_request.origin
        assert one.local_xyz == pytest.approx(exact, abs=1e-4)
        assert one.colours.shape == (one.points.size, 3)
    feed.close()
    tiles.close()


def test_a_feed_asks_for_nothing_that_is_known(
    qtbot: QtBot, left_drive: Drive, scene_request: SceneRequest
) -> None:
    from dataclasses import replace

    tiles = TileCache()
    tiles.use({left_drive.id: left_drive}.__getitem__)
    feed = TileFeed(tiles)
    with qtbot.waitSignal(feed.chosen, timeout=20_000) as chosen:
        feed.request(scene_request)
    assert chosen.args is not None
    known = frozenset((one, TileAppearance(PointStyle())) for one in chosen.args[0].tiles)
    qtbot.waitUntil(lambda: tiles.held_bytes > 0, timeout=20_000)
    arrived: list[object] = []
    with qtbot.waitSignal(feed.chosen, timeout=20_000):
        feed.request(replace(scene_request, known=known))
    feed.arrived.connect(arrived.append)
    feed.close()
    assert arrived == []
    tiles.close()


def test_a_closed_feed_tells_nothing(
    qtbot: QtBot, left_drive: Drive, scene_request: SceneRequest
) -> None:
    tiles = TileCache()
    tiles.use({left_drive.id: left_drive}.__getitem__)
    feed = TileFeed(tiles)
    feed.close()
    with qtbot.assertNotEmitted(feed.chosen, wait=50):
        feed.request(scene_request)
    tiles.close()
