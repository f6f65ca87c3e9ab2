"""What every test of a damaged file asks: success or one sentence, soon, in little memory."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from processing.core.errors import UserError

_LONGEST_S = 20.0
_MOST_BYTES = 200 << 20


def check_refusal(error: UserError, path: Path) -> None:
    """The message names the file and a remedy, in both languages, on one line."""
    for language in ("en", "ja"):
        assert path.name in error.where.in_language(language)
        assert len(error.what.in_language(language)) > 5
        assert len(error.remedy.in_language(language)) > 5
        assert "\n" not in error.line(language)


def outcome(read: Callable[[], object], path: Path) -> UserError | None:
    """None when reading succeeds, or the refusal; anything else fails the test."""
    started = time.monotonic()
    tracemalloc.start()
    try:
        read()
    except UserError as error:
        check_refusal(error, path)
        return error
    else:
        return None
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < _MOST_BYTES
        assert time.monotonic() - started < _LONGEST_S


def flipped(data: bytes, count: int, seed: int) -> Iterator[bytes]:
    """The same bytes with one to three bits turned over, half of the time near the start."""
    random = np.random.default_rng(seed)
    for number in range(count):
        damaged = bytearray(data)
        reach = len(data) if number % 2 else min(len(data), 400)
        for position in random.integers(0, reach, random.integers(1, 4)):
            damaged[position] ^= 1 << int(random.integers(0, 8))
        yield bytes(damaged)


def overwritten(data: bytes, count: int, seed: int) -> Iterator[bytes]:
    """The same bytes with runs of others written over them, anywhere."""
    random = np.random.default_rng(seed)
    for number in range(count):
        damaged = bytearray(data)
        for position in random.integers(0, len(data), random.integers(1, 12)):
            fill = (b"\0" * 8, b"\xff" * 4, random.bytes(3))[number % 3]
            damaged[position : position + len(fill)] = fill
        yield bytes(damaged[: len(data)])
