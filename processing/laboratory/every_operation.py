"""Every operation that can be written down: those on projects, and what the laboratory makes."""

from __future__ import annotations

from processing.laboratory.simulate.simulate_operation import SimulateOperation, simulate
from processing.operations.operation_files import OPERATIONS, Kinds, OperationKind

EVERY_OPERATION: Kinds = {
    **OPERATIONS,
    "simulate": OperationKind("simulate", SimulateOperation, simulate),
}
