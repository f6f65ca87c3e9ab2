"""Seeds of simulated scenes as words of a command."""

from __future__ import annotations


def seeds_of(text: str) -> range:
    """Numbers from one to another, ``3000-3011``, or one alone; of nothing none."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1) if first else range(0)
