"""The one door to the simulator: what can be ordered, by its name on the command line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from processing.monitor import Monitor
from processing.simulate.forecast import Forecast, forecast_site, forecast_street
from processing.simulate.simulated import Simulated
from processing.simulate.wishes import SiteWish, StreetWish
from processing.text import Text


@dataclass(frozen=True)
class Order:
    """One thing that can be made.

    Attributes
    ----------
    wish : type
        Its frozen dataclass of fields from :mod:`processing.tools.parameters`.
    forecast : callable
        About what a wish would give.
    fulfil : callable
        Makes it into a new folder; nothing is left of what is cancelled.
    """

    id: str
    name: Text
    wish: type[Any]  # each order has a dataclass of its own
    forecast: Callable[[Any], Forecast]
    fulfil: Callable[[Any, Path, Monitor], Simulated]


def _make_street(wish: StreetWish, folder: Path, monitor: Monitor) -> Simulated:
    # Kernels and ray casting are loaded when something is to be made.
    from processing.simulate.streets import simulate_street

    return simulate_street(wish, folder, monitor)


def _make_site(wish: SiteWish, folder: Path, monitor: Monitor) -> Simulated:
    from processing.simulate.site import simulate_site

    return simulate_site(wish, folder, monitor)


ORDERS: Mapping[str, Order] = {
    "street": Order("street", Text("Street", "道路"), StreetWish, forecast_street, _make_street),
    "site": Order("site", Text("Earthwork site", "土工現場"), SiteWish, forecast_site, _make_site),
}
