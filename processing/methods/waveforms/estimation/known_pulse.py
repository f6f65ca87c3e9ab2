"""The scanner's pulse and brightness where waveforms are to be estimated: given, or from points."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.methods.waveforms.estimation.packet_inputs import SystemResponse
from processing.methods.waveforms.estimation.pulse_returns import packets_of_returns
from processing.recording.drive import Drive

_POINTS = 400_000
"""From the middle of a recording: some thousand pulses with several returns."""

_NEXT_PERCENT = 2.0
_NEXT_OF_FWHM = 1.3
"""The closest of two returns of one pulse lie that many widths of the pulse apart: two equal
Gaussians have two maxima from .85 on, and a sensor tells them apart by a valley between them. In 30
simulated flights of 2.4 to 9.4 ns the hundredth that lies closest was at 1.1 to 1.6 widths."""

_FEWEST = 200
_USUAL_FWHM_NS = 4.0
"""Where nothing tells: of the scanners that recorded the thesis' waveforms (section 2.1)."""

_LEAST_NS, _MOST_NS = 2.0, 12.0
_TO_FWHM = 2.0 * np.sqrt(2.0 * np.log(2.0))

_FULL_RANGES = (255, 4095, 65_535)
_COUNTS = 255.0


def response_of(times: Floats, values: Floats) -> SystemResponse:
    """A pulse as it was given.

    Raises
    ------
    Unsuitable
        There is no maximum within.
    """
    top = int(np.argmax(values))
    if top in {0, len(values) - 1} or values[top] <= 0.0:
        raise Unsuitable(
            Text("These values are no pulse.", "パルスの波形ではありません。"),
            Text.same(f"{len(values)}"),
            Text(
                "Give times and amplitudes with a maximum between them.",
                "途中に最大値をもつ時刻と振幅を指定してください。",
            ),
        )
    return SystemResponse(times, values / values[top])


def response_from_points(drive: Drive) -> SystemResponse:
    """A Gaussian as long as the closest returns of one pulse say."""
    fwhm = _USUAL_FWHM_NS
    if drive.columns.has("return_number"):
        start = max(0, (drive.count - _POINTS) // 2)
        some = slice(start, min(drive.count, start + _POINTS))
        number = np.asarray(drive.columns["return_number"][some], np.uint8)
        time = np.asarray(drive.columns["time"][some], np.float64)
        found = packets_of_returns(drive.xyz(some), time, number)
        between = np.diff(found.after_ns)[np.diff(found.packet) == 0]
        if between.size >= _FEWEST:
            fwhm = float(np.percentile(between, _NEXT_PERCENT)) / _NEXT_OF_FWHM
    sigma = float(np.clip(fwhm, _LEAST_NS, _MOST_NS)) / _TO_FWHM
    times = np.arange(-6.0 * sigma, 6.0 * sigma, 0.05)
    times -= times[np.abs(times).argmin()]
    return SystemResponse(times, np.exp(-0.5 * (times / sigma) ** 2))


def intensity_of_count(drive: Drive) -> float:
    """Intensity of one count of 8 bits: LAS wants the sensor's whole range spread over 16 bits.

    Where no intensity is beyond 8 or 12 bits, these are taken for the whole range.
    """
    most, start = 0, 0
    intensity = drive.columns["intensity"]
    while start < drive.count:
        most = max(most, int(intensity[start : start + _POINTS].max()))
        start += _POINTS
    full = next(one for one in _FULL_RANGES if most <= one)
    return full / _COUNTS


def has_intensities(drive: Drive) -> bool:
    """Whether returns differ in intensity: many archives have none."""
    if not drive.columns.has("intensity"):
        return False
    some = np.asarray(drive.columns["intensity"][: drive.count : max(1, drive.count // _POINTS)])
    return bool(some.size and some.min() != some.max())
