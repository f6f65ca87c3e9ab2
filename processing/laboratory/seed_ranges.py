"""Seeds of simulated scenes as words of a command."""

from __future__ import annotations


def seeds_of(text: str) -> tuple[int, ...]:
    """Numbers from one to another, ``3000-3011``, one alone, several of both; of nothing none."""
    found: list[int] = []
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        found += range(int(first), int(last or first) + 1)
    return tuple(found)
