"""A confusion matrix as a picture: SVG, which browsers show and word processors take."""

from __future__ import annotations

import math
from collections.abc import Iterator
from html import escape

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Language, Text
from processing.recording.columns.classes import point_classes
from processing.scoring.points.class_scores import balanced_sample, judged_classes
from processing.scoring.points.confusion_matrix import ConfusionMatrix

_CELL, _LEFT, _TOP, _BOTTOM, _COLUMN = 46, 190, 96, 74, 66
_RIGHT, _WRONG = (0, 114, 178), (213, 94, 0)
"""Blue and orange of Okabe and Ito (2008), told apart by every eye and in print by their places."""

_LEAST_SHOWN = 0.005
"""Shares below half a per cent are left empty, so that one sees where points go."""

_TITLE = Text(
    "Points of each true class (rows) by the class given (columns), %",
    "正解クラス（行）の点が分類されたクラス（列）の割合（%）",
)
_SAMPLING = Text(
    "Natural: {points} points as they were recorded. Balanced: as many points of each class that "
    "counts; noise and “other” don't.",
    "実際の構成比：計測した{points}点。同数：評価対象の各クラスを同数とした場合"
    "（ノイズと「その他」は対象外）。",
)
_HEADS = (
    Text("points", "点数"),
    Text("precision", "適合率"),
    Text("recall", "再現率"),
    Text("F", "F値"),
    Text("precision", "適合率"),
    Text("F", "F値"),
)
_NATURAL, _BALANCED = Text("natural", "実際の構成比"), Text("balanced", "同数")
_MEAN = Text("mean F of the classes that count", "評価対象クラスのF値平均")


def confusion_svg(matrix: ConfusionMatrix, language: Language) -> str:
    """The matrix with the figures of each class, for natural and for balanced sampling.

    Parameters
    ----------
    matrix : ConfusionMatrix
        Of points whose true class is known.
    """
    codes = matrix.codes
    names = {one.code: one.name.in_language(language) for one in point_classes()}
    wide = _LEFT + _CELL * len(codes) + _COLUMN * len(_HEADS) + 24
    high = _TOP + _CELL * len(codes) + _BOTTOM
    said = _SAMPLING.filled(points=f"{matrix.count:,}").in_language(language)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}" '
        f'height="{high}" font-family="sans-serif" font-size="12">',
        f'<rect width="{wide}" height="{high}" fill="#ffffff"/>',
        _words(8, 20, _TITLE.in_language(language), "start", "font-weight='bold'"),
        _words(8, 38, said, "start"),
    ]
    for at, code in enumerate(codes):
        x, y = _LEFT + _CELL * at, _TOP + _CELL * at
        name = f"{code} {names.get(code, '')}".strip()
        parts.append(_words(_LEFT - 8, y + _CELL / 2 + 4, name, "end"))
        parts.append(_words(x + _CELL / 2, _TOP - 8, str(code), "middle"))
    parts += _cells(matrix)
    parts += _figures(matrix, language)
    return "\n".join([*parts, "</svg>", ""])


def _cells(matrix: ConfusionMatrix) -> Iterator[str]:
    shares = matrix.counts / np.maximum(matrix.true_counts, 1)[:, None]
    for (row, column), share in np.ndenumerate(shares):
        x, y = _LEFT + _CELL * column, _TOP + _CELL * row
        end = _RIGHT if row == column else _WRONG
        red, green, blue = (round(255 + (one - 255) * share**0.5) for one in end)
        yield (
            f'<rect x="{x}" y="{y}" width="{_CELL}" height="{_CELL}" '
            f'fill="#{red:02x}{green:02x}{blue:02x}" stroke="#dddddd"/>'
        )
        if share >= _LEAST_SHOWN:
            ink = "fill='#ffffff'" if share > 0.3 else ""  # light letters on what is dark
            yield _words(x + _CELL / 2, y + _CELL / 2 + 4, f"{share * 100:.0f}", "middle", ink)


def _figures(matrix: ConfusionMatrix, language: Language) -> Iterator[str]:
    balanced = balanced_sample(matrix)
    columns = (
        matrix.precision,
        matrix.recall,
        matrix.f_measure,
        _in_order(balanced, balanced.precision, matrix),
        _in_order(balanced, balanced.f_measure, matrix),
    )
    left = _LEFT + _CELL * len(matrix.codes) + 8
    for number, head in enumerate(_HEADS):
        x = left + _COLUMN * (number + 1)
        yield _words(x, _TOP - 8, head.in_language(language), "end")
    for last, words in ((4, _NATURAL), (6, _BALANCED)):
        yield _words(left + _COLUMN * last, _TOP - 26, words.in_language(language), "end")
    for row, points in enumerate(matrix.true_counts.tolist()):
        y = _TOP + _CELL * row + _CELL / 2 + 4
        yield _words(left + _COLUMN, y, f"{points:,}", "end")
        for number, values in enumerate(columns):
            yield _words(left + _COLUMN * (number + 2), y, _figure(float(values[row])), "end")
    y = _TOP + _CELL * len(matrix.codes) + 24
    yield _words(left + _COLUMN * 2, y, _MEAN.in_language(language), "end")
    natural = matrix.mean_f_of(judged_classes(matrix))
    for last, value in ((4, natural), (6, balanced.mean_f)):
        yield _words(left + _COLUMN * last, y, _figure(value), "end", "font-weight='bold'")


def _in_order(
    drawn: ConfusionMatrix, values: NDArray[np.float64], matrix: ConfusionMatrix
) -> NDArray[np.float64]:
    """Figures of some of a matrix' classes in the order of all; NaN for what doesn't count."""
    of_code = dict(zip(drawn.codes, values.tolist(), strict=True))
    counts = set(judged_classes(matrix))
    return np.array([of_code.get(code, math.nan) if code in counts else math.nan
                     for code in matrix.codes])  # fmt: skip


def _figure(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.3f}"


def _words(x: float, y: float, words: str, anchor: str, more: str = "") -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" {more}>{escape(words)}</text>'
