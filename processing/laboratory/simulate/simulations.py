"""The one door to the simulator: what can be ordered, by its name on the command line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.laboratory.simulate.forecast import (
    Forecast,
    forecast_flight,
    forecast_site,
    forecast_street,
)
from processing.laboratory.simulate.requests import FlightRequest, SiteRequest, StreetRequest
from processing.laboratory.simulate.simulated import Simulated


@dataclass(frozen=True)
class SimulationKind:
    """One thing that can be made.

    Attributes
    ----------
    request : type
        Its frozen dataclass of fields from :mod:`processing.core.parameters`.
    forecast : callable
        About what a request would give.
    fulfil : callable
        Makes it into a new folder; nothing is left of what is cancelled.
    """

    id: str
    name: Text
    request: type[Any]  # each order has a dataclass of its own
    forecast: Callable[[Any], Forecast]
    fulfil: Callable[[Any, Path, Monitor], Simulated]


def _make_street(request: StreetRequest, folder: Path, monitor: Monitor) -> Simulated:
    # Kernels and ray casting are loaded when something is to be made.
    from processing.laboratory.simulate.streets import simulate_street

    return simulate_street(request, folder, monitor)


def _make_site(request: SiteRequest, folder: Path, monitor: Monitor) -> Simulated:
    from processing.laboratory.simulate.site import simulate_site

    return simulate_site(request, folder, monitor)


def _make_flight(request: FlightRequest, folder: Path, monitor: Monitor) -> Simulated:
    from processing.laboratory.simulate.flights import simulate_flight

    return simulate_flight(request, folder, monitor)


SIMULATIONS: Mapping[str, SimulationKind] = {
    "street": SimulationKind(
        "street", Text("Street", "道路"), StreetRequest, forecast_street, _make_street
    ),
    "site": SimulationKind(
        "site", Text("Earthwork site", "土工現場"), SiteRequest, forecast_site, _make_site
    ),
    "flight": SimulationKind(
        "flight",
        Text("Full-waveform flight", "航空レーザ（全波形）"),
        FlightRequest,
        forecast_flight,
        _make_flight,
    ),
}
