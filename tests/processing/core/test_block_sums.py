"""Checksums by blocks: no single bit turns over unseen, and a kill leaves no false alarm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from processing.core.block_sums import (
    BLOCK,
    begin_writing,
    damaged_blocks,
    end_writing,
    keep_sums,
    kept_sums,
    place_with_sums,
    record_of,
    refuse_damaged,
    settle_sums,
    sum_of,
)
from processing.core.errors import BadFile
from processing.project.checking.bit_mending import _flipped_bit_kernel, with_bit_mended

SIZE = 2 * BLOCK + 12_345


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sums") / "xyz.bin"
    path.write_bytes(np.random.default_rng(1).bytes(SIZE))
    keep_sums(path)
    return path


def turn_over(path: Path, bit: int) -> None:
    with path.open("rb+") as file:
        file.seek(bit // 8)
        (byte,) = file.read(1)
        file.seek(bit // 8)
        file.write(bytes([byte ^ (1 << bit % 8)]))


@given(bit=st.integers(0, SIZE * 8 - 1))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_single_bit_is_seen_in_its_block_and_turned_back(whole: Path, bit: int) -> None:
    known = kept_sums(whole)
    assert known is not None
    turn_over(whole, bit)
    try:
        (block,) = damaged_blocks(whole, known)
        assert block.start <= bit // 8 < block.stop
        with pytest.raises(BadFile, match=f"xyz.bin, bytes {block.start:,}"):
            refuse_damaged(whole)
        damaged = whole.read_bytes()[block.start : block.stop]
    finally:
        turn_over(whole, bit)
    assert (
        with_bit_mended(damaged, known.sums[block.number])
        == (whole.read_bytes()[block.start : block.stop])
    )


@given(data=st.binary(min_size=1, max_size=300), seed=st.integers(0, 1 << 30))
@settings(deadline=None)
def test_more_than_a_bit_is_never_taken_for_one(data: bytes, seed: int) -> None:
    random = np.random.default_rng(seed)
    altered = bytearray(data)
    for place in random.integers(0, len(data) * 8, 2 + seed % 9):
        altered[place // 8] ^= 1 << place % 8
    mended = with_bit_mended(bytes(altered), sum_of(data))
    assert mended is None or mended == data


def test_the_kernel_finds_the_same_bit_as_the_plain_function() -> None:
    from processing.project.checking import bit_mending

    data = bytearray(range(40))
    known = sum_of(data)
    data[7] ^= 16
    place = np.zeros(2, np.int64)
    plain = _flipped_bit_kernel.py_func  # type: ignore[attr-defined]
    difference = sum_of(data).crc ^ known.crc
    assert plain(difference, len(data), bit_mending._table(), place)
    assert place.tolist() == [7, 4]


def test_only_the_blocks_that_are_read_are_compared(whole: Path, tmp_path: Path) -> None:
    path = tmp_path / "xyz.bin"
    path.write_bytes(whole.read_bytes())
    keep_sums(path)
    turn_over(path, 8 * (BLOCK + 5))
    refuse_damaged(path, 0, BLOCK)
    refuse_damaged(path, 2 * BLOCK, SIZE)
    with pytest.raises(BadFile):
        refuse_damaged(path, BLOCK - 1, BLOCK + 1)


def test_a_file_of_another_length_is_refused_and_one_without_a_record_is_not(
    tmp_path: Path,
) -> None:
    path = tmp_path / "time.bin"
    path.write_bytes(b"12345678")
    refuse_damaged(path)
    keep_sums(path)
    path.write_bytes(b"1234")
    with pytest.raises(BadFile, match="4 ≠ 8"):
        refuse_damaged(path)


@given(bit=st.integers(0, 8 * 37 - 1))
@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_damaged_record_is_told_and_blames_no_file(tmp_path: Path, bit: int) -> None:
    path = tmp_path / "label.bin"
    path.write_bytes(b"x" * 100)
    keep_sums(path)
    turn_over(record_of(path), bit)
    with pytest.raises(BadFile, match="checksums") as refused:
        kept_sums(path)
    assert refused.value.where.en.endswith("label.bin.sums")


def test_a_file_takes_a_place_with_its_record_and_without_that_of_the_other(tmp_path: Path) -> None:
    old, new = tmp_path / "label.bin", tmp_path / "after.bin"
    old.write_bytes(b"old")
    keep_sums(old)
    new.write_bytes(b"newer")
    place_with_sums(new, old)
    assert kept_sums(old) is None
    new.write_bytes(b"newest")
    keep_sums(new)
    place_with_sums(new, old)
    refuse_damaged(old)
    assert not record_of(new).exists()


def test_a_kill_while_blocks_are_written_blames_nothing_and_forgets_no_other_block(
    tmp_path: Path,
) -> None:
    path = tmp_path / "label.bin"
    path.write_bytes(bytes(2 * BLOCK))
    keep_sums(path)
    assert begin_writing(path) is not None
    turn_over(path, 3)
    refuse_damaged(path)  # killed here: nobody knows what it should be
    settle_sums(path, [0])
    refuse_damaged(path)
    turn_over(path, 8 * BLOCK + 1)
    with pytest.raises(BadFile):
        refuse_damaged(path)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["label.bin", "label.bin.sums"]


def test_what_was_damaged_before_it_was_written_over_stays_told(tmp_path: Path) -> None:
    path = tmp_path / "label.bin"
    path.write_bytes(bytes(BLOCK))
    keep_sums(path)
    turn_over(path, 77)
    known = begin_writing(path)
    turn_over(path, 1)
    end_writing(path, known, {0: False})
    with pytest.raises(BadFile):
        refuse_damaged(path)
