"""Simulating a street or a site: a value that says which, and the one function that makes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from processing.core.errors import name_with_type
from processing.core.monitor import Monitor
from processing.core.parameters import ParameterValue, fill_parameters, parameters_of
from processing.core.text import Text
from processing.laboratory.simulate.simulated import Simulated
from processing.laboratory.simulate.simulations import SIMULATIONS, SimulationKind


@dataclass(frozen=True)
class SimulateOperation:
    """What is to be made.

    Attributes
    ----------
    what : str
        A key of :data:`SIMULATIONS`.
    folder : Path
        A new folder.
    parameters : mapping of str to value
        Those that are given, by name.
    """

    what: str
    folder: Path
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)

    @property
    def simulation(self) -> SimulationKind:
        """What can be made under this name.

        Raises
        ------
        OutOfRange
            Nothing.
        """
        what = Text("There is no such simulation.", "そのような模擬計測はありません。")
        return name_with_type(SIMULATIONS, self.what, what)

    @property
    def parameter_class(self) -> type[Any]:
        """What can be set."""
        return self.simulation.request

    def check(self) -> None:
        """Refuse what there isn't.

        Raises
        ------
        OutOfRange
            There is no such simulation, parameter or value.
        """
        fill_parameters(self.parameter_class, self.parameters)


def operation_for(what: str, request: object, folder: Path) -> SimulateOperation:
    """The making of a request with all its values, as the window's form gives it.

    Parameters
    ----------
    request : object
        An instance of what can be set for ``what``.
    """
    declared = parameters_of(type(request))
    return SimulateOperation(what, folder, {one.id: getattr(request, one.id) for one in declared})


def simulate(operation: SimulateOperation, monitor: Monitor) -> Simulated:
    """Make what is asked for, with its truth.

    Raises
    ------
    UserError, Cancelled
        Nothing is left.
    """
    request = fill_parameters(operation.parameter_class, operation.parameters)
    made: Simulated = operation.simulation.fulfil(request, operation.folder, monitor)
    return made
