"""Reliability curves as a small SVG, for documents: text, so that a change of it can be read.

Matplotlib's of such a plot has 820 lines where this has 48.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from html import escape

from processing.scoring.points.reliability import Reliability

_SIDE, _LEFT, _TOP, _BOTTOM = 300, 52, 16, 58
_COLOURS = ("#0072b2", "#d55e00", "#009e73")
_GREY = "#999999"
_LEAST_R, _MOST_R = 2.5, 8.0


def reliability_svg(curves: Mapping[str, Reliability], x_title: str, y_title: str) -> str:
    """A plot of the share that is right over the confidence, with 95 % intervals.

    The area of a dot is the square root of how many candidates it stands for; the diagonal is what
    a confidence promises.

    Parameters
    ----------
    curves : mapping
        By name, which the legend shows with the calibration error.
    """
    wide, high = _LEFT + _SIDE + 16, _TOP + _SIDE + _BOTTOM
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}" '
        f'height="{high}" font-family="sans-serif" font-size="12">',
        f'<rect width="{wide}" height="{high}" fill="#ffffff"/>',
        *_frame(x_title, y_title),
    ]
    for number, (name, curve) in enumerate(curves.items()):
        parts += _curve(curve, _COLOURS[number % len(_COLOURS)])
        parts += _legend(number, name, curve)
    return "\n".join([*parts, "</svg>", ""])


def _frame(x_title: str, y_title: str) -> Iterator[str]:
    for tenth in range(0, 11, 2):
        share = tenth / 10
        x, y = _x(share), _y(share)
        yield f'<path d="M{x} {_y(0)}V{_y(1)}M{_x(0)} {y}H{_x(1)}" stroke="#e5e5e5"/>'
        yield f'<text x="{x}" y="{_y(0) + 16}" text-anchor="middle">{share:.1f}</text>'
        yield f'<text x="{_x(0) - 6}" y="{y + 4}" text-anchor="end">{share:.1f}</text>'
    yield f'<path d="M{_x(0)} {_y(0)}L{_x(1)} {_y(1)}" stroke="{_GREY}" stroke-dasharray="4 4"/>'
    middle = _y(0.5)
    yield f'<text x="{_x(0.5)}" y="{_y(0) + 36}" text-anchor="middle">{escape(x_title)}</text>'
    yield (
        f'<text x="14" y="{middle}" text-anchor="middle" transform="rotate(-90 14 {middle})">'
        f"{escape(y_title)}</text>"
    )


def _curve(curve: Reliability, colour: str) -> Iterator[str]:
    filled = [one for one in curve.bins if one.accepted.of]
    if not filled:
        return
    positions = " ".join(f"{_x(one.mean_confidence)},{_y(one.accepted.value)}" for one in filled)
    yield f'<polyline points="{positions}" fill="none" stroke="{colour}" stroke-width="1.5"/>'
    most = max(one.accepted.of for one in filled)
    for one in filled:
        x, y = _x(one.mean_confidence), _y(one.accepted.value)
        if not math.isnan(one.accepted.low):
            ends = f"M{x} {_y(one.accepted.low)}V{_y(one.accepted.high)}"
            yield f'<path d="{ends}" stroke="{colour}" stroke-opacity="0.5"/>'
        radius = max(_LEAST_R, _MOST_R * (one.accepted.of / most) ** 0.25)
        yield f'<circle cx="{x}" cy="{y}" r="{radius:.1f}" fill="{colour}" fill-opacity="0.8"/>'


def _legend(number: int, name: str, curve: Reliability) -> Iterator[str]:
    y = _TOP + 18 + 18 * number
    count = sum(round(one.accepted.of) for one in curve.bins)
    error = "–" if math.isnan(curve.calibration_error) else f"{curve.calibration_error:.3f}"
    colour = _COLOURS[number % len(_COLOURS)]
    yield f'<circle cx="{_x(0) + 14}" cy="{y - 4}" r="5" fill="{colour}"/>'
    words = f"{name}: {count:,} candidates, calibration error {error}"
    yield f'<text x="{_x(0) + 24}" y="{y}">{escape(words)}</text>'


def _x(share: float) -> float:
    return round(_LEFT + _SIDE * share, 1)


def _y(share: float) -> float:
    return round(_TOP + _SIDE * (1 - share), 1)
