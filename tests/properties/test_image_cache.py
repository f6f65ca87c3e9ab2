"""The tile cache never gives a wrong tile, whatever order tiles are asked for and dropped in."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from processing.core.errors import Unsuitable, UserError
from processing.image.attributes.attributes import colours, most_telling_attribute
from processing.image.attributes.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.images_of_drives import image_of
from processing.image.tiles.tiles import TileKey
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import small_drive

KINDS = (ImageKind.TRAJECTORY_CENTER, ImageKind.REVERSIBLE)
ATTRIBUTES = ("intensity", "height", "class", "segment")
WAIT_S = 30


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Drive]:
    folder = tmp_path_factory.mktemp("drives")
    return {name: small_drive(folder / name, seed)[0] for seed, name in enumerate(("a", "b"))}


@pytest.fixture
def cache(drives: dict[str, Drive]) -> Iterator[TileCache]:
    cache = TileCache(limit_bytes=2_000_000)
    cache.use(drives.__getitem__)
    yield cache
    cache.close()


class CacheListener:
    """Notes what it is told."""

    def __init__(self) -> None:
        self.reported: list[tuple[TileRequest, TilePixels]] = []
        self.reasons: list[UserError] = []
        self._changed = threading.Condition()

    def done(self, request: TileRequest, pixels: TilePixels) -> None:
        with self._changed:
            self.reported.append((request, pixels))
            self._changed.notify_all()

    def refused(self, _: TileRequest, reason: UserError) -> None:
        with self._changed:
            self.reasons.append(reason)
            self._changed.notify_all()

    def wait_for(self, count: int) -> None:
        with self._changed:
            assert self._changed.wait_for(
                lambda: len(self.reported) + len(self.reasons) >= count, timeout=WAIT_S
            )


REQUESTS = st.builds(
    TileRequest,
    drive_id=st.sampled_from(["a", "b"]),
    kind=st.sampled_from(KINDS),
    key=st.builds(TileKey, st.just(0), st.just(0), st.integers(0, 1)),
    attribute=st.sampled_from(["intensity", "height", "class"]),
    low_percent=st.sampled_from([0.0, 2.0]),
    high_percent=st.sampled_from([98.0, 100.0]),
)


def assert_right(drive: Drive, request: TileRequest, pixels: TilePixels) -> None:
    points = image_of(drive, request.kind).pyramid.points(request.key)
    np.testing.assert_array_equal(pixels.points, points)
    shown = most_telling_attribute(drive, request.attribute)
    wanted = colours(drive, points, shown, request.low_percent, request.high_percent)
    np.testing.assert_array_equal(pixels.colours, wanted)


@given(asked=st.lists(REQUESTS, min_size=1, max_size=12), dropped=st.booleans())
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_every_tile_told_and_got_is_the_one_asked_for(
    cache: TileCache, drives: dict[str, Drive], asked: list[TileRequest], dropped: bool
) -> None:
    listener = CacheListener()
    for request in asked:
        cache.request(request, listener.done)
        if dropped:
            cache.drop(request.drive_id)
    listener.wait_for(len(set(asked)))
    for request, pixels in listener.reported:
        assert_right(drives[request.drive_id], request, pixels)
    for request in asked:
        held = cache.get(request)
        if held is not None:
            assert_right(drives[request.drive_id], request, held)
    assert cache.held_bytes <= 2_000_000


def request_of(column: int = 0, attribute: str = "intensity", drive: str = "a") -> TileRequest:
    key = TileKey(0, 0, column)
    return TileRequest(drive, ImageKind.REVERSIBLE, key, attribute, 2.0, 98.0)


def test_a_tile_that_is_there_is_told_at_once(cache: TileCache) -> None:
    first, second = CacheListener(), CacheListener()
    cache.request(request_of(), first.done)
    first.wait_for(1)
    cache.request(request_of(), second.done)
    assert len(second.reported) == 1
    assert second.reported[0][1] is cache.get(request_of())


def test_tiles_used_last_are_kept_within_the_limit(drives: dict[str, Drive]) -> None:
    cache = TileCache(limit_bytes=1)
    cache.use(drives.__getitem__)
    listener = CacheListener()
    for number, name in enumerate(("a", "b"), start=1):
        cache.request(request_of(drive=name), listener.done)
        listener.wait_for(number)
    assert cache.get(request_of(drive="a")) is None
    assert cache.get(request_of(drive="b")) is not None
    cache.close()


class Gate:
    """Drives that are given only once the gate is open, so that a queue can build up."""

    def __init__(self, drives: dict[str, Drive]) -> None:
        self._drives = drives
        self.opened = threading.Event()
        self.entered = threading.Semaphore(0)

    def drive(self, name: str) -> Drive:
        self.entered.release()
        assert self.opened.wait(WAIT_S)
        return self._drives[name]


def loading_cache(drives: dict[str, Drive], listener: CacheListener) -> tuple[TileCache, Gate]:
    """A cache whose loaders are both busy."""
    gate, cache = Gate(drives), TileCache()
    cache.use(gate.drive)
    for column in (0, 1):
        cache.request(request_of(column), listener.done)
        assert gate.entered.acquire(timeout=WAIT_S)
    return cache, gate


def test_what_is_no_longer_wanted_is_not_loaded(drives: dict[str, Drive]) -> None:
    listener = CacheListener()
    cache, gate = loading_cache(drives, listener)
    unwanted, wanted = request_of(0, "height"), request_of(0, "class")
    cache.request(unwanted, listener.done)
    cache.request(wanted, listener.done)
    cache.keep_only(listener.done, {wanted})
    gate.opened.set()
    listener.wait_for(3)
    cache.close()
    assert {request for request, _ in listener.reported} == {request_of(0), request_of(1), wanted}


def test_another_listener_of_the_same_tile_is_not_forgotten(drives: dict[str, Drive]) -> None:
    listener, other = CacheListener(), CacheListener()
    cache, gate = loading_cache(drives, listener)
    shared = request_of(0, "height")
    cache.request(shared, listener.done)
    cache.request(shared, other.done)
    cache.keep_only(listener.done, set())
    gate.opened.set()
    other.wait_for(1)
    cache.close()
    assert [request for request, _ in other.reported] == [shared]
    assert shared not in {request for request, _ in listener.reported}


def test_a_tile_being_made_when_its_drive_changes_is_made_again(
    drives: dict[str, Drive],
) -> None:
    listener = CacheListener()
    cache, gate = loading_cache(drives, listener)
    cache.drop("a")
    gate.opened.set()
    listener.wait_for(2)
    cache.close()
    assert sorted(request.key.column for request, _ in listener.reported) == [0, 1]


def test_what_cannot_be_shown_is_refused_until_the_drive_changes(
    cache: TileCache, drives: dict[str, Drive]
) -> None:
    listener, refused = CacheListener(), CacheListener()
    from_above = replace(request_of(attribute="height"), kind=ImageKind.TOP_VIEW)
    cache.request(from_above, listener.done, refused.refused)
    refused.wait_for(1)
    assert isinstance(cache.refusal("a", "height"), Unsuitable)
    cache.request(from_above, listener.done, refused.refused)
    cache.request(request_of(), listener.done)
    listener.wait_for(1)
    assert [request for request, _ in listener.reported] == [request_of()]
    assert len(refused.reasons) == 1
    cache.drop("a")
    assert cache.refusal("a", "height") is None


def test_a_drive_is_shown_by_what_it_has_where_it_lacks_the_attribute(
    cache: TileCache, drives: dict[str, Drive]
) -> None:
    listener = CacheListener()
    cache.request(request_of(attribute="segment"), listener.done)
    listener.wait_for(1)
    assert_right(drives["a"], *listener.reported[0])
    assert cache.refusal("a", "segment") is None


def test_a_closed_drive_is_no_error(cache: TileCache) -> None:
    listener = CacheListener()
    cache.request(request_of(drive="gone"), listener.done)
    cache.request(request_of(), listener.done)
    listener.wait_for(1)
    assert listener.reported[0][0] == request_of()


def test_a_closed_cache_has_no_threads_and_tells_nothing(drives: dict[str, Drive]) -> None:
    listener = CacheListener()
    cache, gate = loading_cache(drives, listener)
    cache.request(request_of(0, "height"), listener.done)
    closing = threading.Thread(target=cache.close)
    closing.start()
    gate.opened.set()
    closing.join(WAIT_S)
    assert not closing.is_alive()
    assert request_of(0, "height") not in {request for request, _ in listener.reported}
    assert not [t for t in threading.enumerate() if t.name.startswith("tiles-")]
    cache.request(request_of(), listener.done)


def test_who_leaves_is_told_nothing_more_and_held_by_nobody(drives: dict[str, Drive]) -> None:
    listener = CacheListener()
    cache, gate = loading_cache(drives, listener)
    cache.request(request_of(0, "height"), listener.done)

    def open_once_given_up() -> None:
        while cache._waiting:
            pass
        gate.opened.set()

    opening = threading.Thread(target=open_once_given_up)
    opening.start()
    cache.tell_nobody()
    opening.join(WAIT_S)
    assert listener.reported == []
    left = weakref.ref(listener)
    del listener
    assert left() is None
    later = CacheListener()
    cache.request(request_of(0, "class"), later.done)
    later.wait_for(1)
    cache.close()


def test_a_cache_that_knows_no_drives_says_so() -> None:
    cache = TileCache()
    with pytest.raises(ValueError, match="drives"):
        cache.request(request_of(), CacheListener().done)
    cache.close()


def test_a_machine_without_memory_gives_tiles_back_and_says_so(drives: dict[str, Drive]) -> None:
    cache, listener = TileCache(), CacheListener()
    is_short = threading.Event()

    def drive_of(name: str) -> Drive:
        if is_short.is_set():
            raise MemoryError
        return drives[name]

    cache.use(drive_of)
    top = image_of(drives["a"], KINDS[0]).pyramid.top
    first = TileRequest("a", KINDS[0], top, "intensity", 1.0, 99.0)
    cache.request(first, listener.done, listener.refused)
    listener.wait_for(1)
    is_short.set()
    cache.request(replace(first, attribute="height"), listener.done, listener.refused)
    listener.wait_for(2)
    assert cache.held_bytes == 0
    (reason,) = listener.reasons
    assert "memory" in reason.what.en
    assert cache.refusal("a", "height") is reason
    is_short.clear()  # the loaders live on
    cache.request(first, listener.done, listener.refused)
    listener.wait_for(3)
    assert len(listener.reported) == 2
    cache.close()
