"""The six classes of full-waveform flights: plants of any height are one of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import CODES, ConfusionMatrix
from processing.scoring.points.point_scores import PointScore

SIX = (2, 5, 6, 14, 15, 11)
"""Ground, vegetation, building, wire, tower, road: the order of the tables of Shinohara 2022."""

_READ_AS = {3: 5, 4: 5, 13: 14}


def as_six_classes(codes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Codes as one of :data:`SIX`; 0, which isn't scored, for all others."""
    table = np.zeros(CODES, np.uint8)
    for code in SIX:
        table[code] = code
    for code, read_as in _READ_AS.items():
        table[code] = read_as
    return np.asarray(table[codes], np.uint8)


def six_class_score(counts: ConfusionMatrix) -> PointScore:
    """The score of classes where 3, 4 and 5 are one, 13 and 14 too; other true ones don't count.

    References
    ----------
    Shinohara 2022, tables 3.1 and 6.1.
    """
    codes = np.array(counts.codes, np.uint8)
    true = as_six_classes(codes)
    found = np.where(true > 0, true, codes)
    merged = tuple(sorted({*true.tolist(), *found.tolist()}))
    place = {code: at for at, code in enumerate(merged)}
    table = np.zeros((len(merged), len(merged)), np.int64)
    rows = np.array([place[int(code)] for code in true], np.int64)
    columns = np.array([place[int(code)] for code in found], np.int64)
    np.add.at(table, (rows[:, None], columns[None, :]), np.asarray(counts.counts, np.int64))
    score = class_score(ConfusionMatrix(merged, table))
    return replace(score, tool="waveform-classify")
