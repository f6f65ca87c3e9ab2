"""How sure a lid is: the share of such lids that is expected to be right."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.road.gutter_lids import Cover
from processing.road.gutter_runs import GutterRun

# Logistic in a few physical facts; how they were fitted is said in `run_evidence`.
_BIAS, _JOINTS, _HOLES, _SEEN, _BRIDGED, _FEW_POINTS = -4.0, 0.2, 2.0, 0.5, -1.0, -0.8
_MOST_JOINTS, _MOST_HOLES = 30.0, 1.2
_FEW_HOLES = 8  # notches that make the holes' places half believed
_MOST = 0.99


def run_evidence(run: GutterRun) -> float:
    """What a whole gutter is worth: the evidence of its joints, and of its holes' places.

    Notes
    -----
    Set by hand on seven simulated streets: rows of notches by chance have joints worth 2 to 6, or
    up to 17 with holes worth less than nothing (a logarithm of the likelihood per notch); gutters
    mostly have joints worth 17 to 400 and holes worth 0.3 to 1.2. The holes of a few notches say
    little. A gutter of which most joints were seen comes to more than nine in ten.
    """
    joints = min(run.row.value, _MOST_JOINTS)
    holes = float(np.clip(run.holes.gain, -1.0, _MOST_HOLES))
    believed = run.holes.count / (run.holes.count + _FEW_HOLES)
    return _BIAS + _JOINTS * joints + _HOLES * holes * believed


def confidences(run: GutterRun, covers: tuple[Cover, ...]) -> NDArray[np.float64]:
    """(n,) float64 for the covers of one gutter."""
    base = run_evidence(run)
    return np.array([_confidence(base, one) for one in covers])


def _confidence(base: float, cover: Cover) -> float:
    value = base + _SEEN * (min(cover.seen[0], 2) + min(cover.seen[1], 2)) / 2
    value += _BRIDGED if cover.is_bridged else 0.0
    value += _FEW_POINTS if cover.on_top < 10 else 0.0
    return min(_MOST, 1.0 / (1.0 + math.exp(-value)))
