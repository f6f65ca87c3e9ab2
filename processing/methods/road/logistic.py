"""From the sum of weighted facts to a chance: what every learnt confidence of a thing ends with."""

from __future__ import annotations

import math

_MOST_LOGIT = 30.0
"""A chance of 1e-13 from certainty; beyond, the exponential says nothing more."""


def chance_of_logit(logit: float) -> float:
    """The chance, 0 to 1, of log-odds."""
    return 1 / (1 + math.exp(-max(-_MOST_LOGIT, min(_MOST_LOGIT, logit))))
