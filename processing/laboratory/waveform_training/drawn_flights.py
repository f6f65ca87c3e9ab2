"""Simulated flights by scanners that are drawn anew for each, and what is learnt from them."""

from __future__ import annotations

import dataclasses
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.airborne.flight_scene import FLIGHT_STYLES
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS, FlightSensor
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.laboratory.waveform_training.flight_examples import FlightExamples, examples_of

_DRAWN = {
    "fwhm_ns": (0.75, 1.35),
    "divergence_mrad": (0.7, 1.5),
    "decay_ns": (0.7, 1.3),
    "noise": (0.6, 1.6),
    "half_counts": (0.6, 1.3),
    "density": (0.6, 1.6),
}
"""Factors: from one of five scanners to the next they leave no gap of pulse lengths (2 to 9.5 ns)
or beams, which is what a waveform's shape depends on."""

_THRESHOLD = (4.5, 9.0)
"""Standard deviations of the noise: from where one pulse in some thousand has a false
return to where weak ones are given up."""

_DENSITY = (4.0, 24.0)
"""Pulses per m²; a denser flight only takes longer."""


def drawn_sensor(seed: int) -> FlightSensor:
    """One of the scanners, in turn, with its pulse, beam, noise and brightness drawn."""
    random = np.random.default_rng(seed)
    names = sorted(FLIGHT_SENSORS)
    usual = FLIGHT_SENSORS[names[seed % len(names)]]
    # Any: the values of some of the scanner's fields.
    drawn: dict[str, Any] = {
        name: float(getattr(usual, name) * random.uniform(*limits))
        for name, limits in _DRAWN.items()
    }
    drawn["density"] = float(np.clip(drawn["density"], *_DENSITY))
    return dataclasses.replace(usual, threshold=float(random.uniform(*_THRESHOLD)), **drawn)


def examples_of_seed(
    folder: Path, seed: int, length_m: float, most: int, *, knows_intensity: bool
) -> FlightExamples:
    """Examples of a flight; what the folder has of it isn't simulated or described again.

    Parameters
    ----------
    most : int
        Of a class.
    """
    # Both kinds are made at once: the flight, which takes longest, is then no longer needed.
    paths = {
        kind: folder / f"{seed}-{length_m:g}m-{most}-{name}.npz"
        for kind, name in ((True, "all"), (False, "positions"))
    }
    if not all(path.exists() for path in paths.values()):
        styles = sorted(FLIGHT_STYLES)
        request = FlightRequest(seed=seed, length_m=length_m, style=styles[seed % len(styles)])
        with tempfile.TemporaryDirectory(dir=folder) as work:
            flight = Path(work) / "flight"
            simulate_flight(request, flight, SilentMonitor(), drawn_sensor(seed))
            for kind, path in paths.items():
                random = np.random.default_rng(seed)
                examples_of(flight, most, random, knows_intensity=kind).write(path)
    return FlightExamples.read(paths[knows_intensity])
