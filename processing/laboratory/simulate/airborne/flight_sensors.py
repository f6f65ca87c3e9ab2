"""Airborne laser scanners that record waveforms: their pulses, beams, scan patterns, digitisers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from processing.core.errors import name_with_type
from processing.core.text import Text
from processing.laboratory.simulate.airborne.landscapes import Floats

PULSE_STEP_NS = 0.02
"""Between values of a tabulated pulse: 3 mm of range, below what any digitiser resolves."""

PULSE_BEFORE_NS, PULSE_AFTER_NS = 24.0, 60.0
"""How far a tabulated pulse reaches before and behind its maximum."""

PULSE_FILE_STEP_NS = 0.25
"""Between the lines of ``system_pulse.csv``."""

_TO_FWHM = 2.0 * np.sqrt(2.0 * np.log(2.0))


@dataclass(frozen=True)
class FlightSensor:
    """A scanner as it is flown.

    Attributes
    ----------
    pulse : {"gaussian", "skewed", "ringing"}
        Shape of its response to a flat target across the beam: a Gaussian, one with an
        exponential decay, or one followed by a damped oscillation of the receiver.
    fwhm_ns, decay_ns : float
        Full width at half maximum of its Gaussian part; time constant of the decay or oscillation.
    divergence_mrad : float
        Full angle between the directions where the beam has 1/e² of its power.
    height_m : float
        Usual height above the ground.
    half_swath_deg : float
        Widest scan angle off nadir; of a conical scan its only one.
    pattern : {"parallel", "conical"}
    density : float
        Pulses per m² of all lines together, as usually ordered.
    interval_ns, samples, bits : float, int, int
        Of its digitiser: between samples, in one packet, of a sample.
    half_counts : float
        Maximum of the echo of a flat target of 50 % at the usual height.
    baseline, noise : float
        Mean and standard deviation of the counts where nothing is met.
    threshold : float
        Standard deviations of the noise above which an echo is told as a return.
    lead_ns : float
        From a packet's beginning to its first return.
    """

    id: str
    name: Text
    pulse: Literal["gaussian", "skewed", "ringing"]
    fwhm_ns: float
    decay_ns: float
    divergence_mrad: float
    height_m: float
    half_swath_deg: float
    pattern: Literal["parallel", "conical"]
    density: float
    interval_ns: float
    samples: int
    bits: int
    half_counts: float
    baseline: float
    noise: float
    threshold: float
    lead_ns: float


def pulse_table(sensor: FlightSensor) -> Floats:
    """Response to a flat target, maximum 1 at ``PULSE_BEFORE_NS``, each :data:`PULSE_STEP_NS`."""
    step = PULSE_STEP_NS
    times = np.arange(-PULSE_BEFORE_NS - PULSE_AFTER_NS, 2 * PULSE_AFTER_NS, step)
    sigma = sensor.fwhm_ns / _TO_FWHM
    shape = np.exp(-0.5 * (times / sigma) ** 2)
    if sensor.pulse != "gaussian":
        behind = np.maximum(times, 0.0)
        answer = np.where(times >= 0, np.exp(-behind / sensor.decay_ns), 0.0)
        if sensor.pulse == "ringing":
            # The receiver swings back below the baseline and over it again.
            swing = 2.0 * np.pi * behind / (2.6 * sensor.decay_ns)
            answer *= -np.sin(swing)
        answer *= 1.0 / np.abs(answer).sum()
        first = int(np.searchsorted(times, 0.0))
        later = np.convolve(shape, answer)[first : first + times.size]
        shape = later if sensor.pulse == "skewed" else shape + _RINGING * later
    place = int(shape.argmax())
    before, after = round(PULSE_BEFORE_NS / step), round(PULSE_AFTER_NS / step)
    table: Floats = shape[place - before : place + after + 1] / shape[place]
    return np.ascontiguousarray(table)


_RINGING = 0.35
"""Energy of the oscillation beside that of the echo: swings of 5 to 10 % of its maximum."""


FLIGHT_SENSORS: Mapping[str, FlightSensor] = {
    one.id: one
    for one in (
        FlightSensor(
            "corridor", Text("Helicopter, 500 m, 4 ns", "ヘリコプター 500 m・4 ns"), "gaussian",
            fwhm_ns=4.0, decay_ns=1.0, divergence_mrad=0.5, height_m=500.0, half_swath_deg=25.0,
            pattern="parallel", density=14.0, interval_ns=1.0, samples=160, bits=8,
            half_counts=170.0, baseline=9.0, noise=1.3, threshold=6.0, lead_ns=14.0,
        ),
        FlightSensor(
            "drone", Text("Drone, 100 m, 3 ns", "ドローン 100 m・3 ns"), "skewed",
            fwhm_ns=2.6, decay_ns=0.9, divergence_mrad=1.2, height_m=100.0, half_swath_deg=35.0,
            pattern="parallel", density=40.0, interval_ns=1.0, samples=120, bits=16,
            half_counts=4200.0, baseline=180.0, noise=26.0, threshold=6.0, lead_ns=9.0,
        ),
        FlightSensor(
            "topographic", Text("Aircraft, 900 m, 5 ns", "航空機 900 m・5 ns"), "skewed",
            fwhm_ns=4.4, decay_ns=1.8, divergence_mrad=0.35, height_m=900.0, half_swath_deg=28.0,
            pattern="parallel", density=8.0, interval_ns=1.0, samples=200, bits=16,
            half_counts=1500.0, baseline=95.0, noise=9.0, threshold=6.5, lead_ns=18.0,
        ),
        FlightSensor(
            "conical",
            Text("Aircraft, conical scan, 1,200 m, 6 ns", "航空機 円錐走査 1,200 m・6 ns"),
            "ringing",
            fwhm_ns=5.6, decay_ns=5.0, divergence_mrad=0.3, height_m=1200.0, half_swath_deg=17.0,
            pattern="conical", density=12.0, interval_ns=1.0, samples=240, bits=8,
            half_counts=150.0, baseline=14.0, noise=1.0, threshold=7.0, lead_ns=20.0,
        ),
        FlightSensor(
            "wide", Text("Aircraft, 1,800 m, 7 ns at 2 ns", "航空機 1,800 m・7 ns（2 ns間隔）"),
            "gaussian",
            fwhm_ns=7.0, decay_ns=1.0, divergence_mrad=0.22, height_m=1800.0, half_swath_deg=18.0,
            pattern="parallel", density=4.0, interval_ns=2.0, samples=128, bits=8,
            half_counts=140.0, baseline=8.0, noise=1.2, threshold=6.0, lead_ns=24.0,
        ),
    )
}  # fmt: skip
"""Kinds of scanners that are flown today, none of them one maker's: three shapes of pulses of 3 to
8 ns, footprints of 0.1 to 0.4 m, 4 to 40 pulses/m², digitisers of 8 to 16 bits at 1 and 2 ns."""


def flight_sensor_of(name: str) -> FlightSensor:
    """The scanner of a name.

    Raises
    ------
    OutOfRange
        There is none; names those there are.
    """
    nothing = Text("There is no such airborne scanner.", "そのような航空レーザはありません。")
    return name_with_type(FLIGHT_SENSORS, name, nothing)
