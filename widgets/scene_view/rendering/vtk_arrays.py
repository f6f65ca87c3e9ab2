"""How numpy arrays become VTK's: copied, since VTK frees what it got at a time of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def as_vtk(values: NDArray[Any]) -> vtkDataArray:  # of any dtype that VTK knows
    """(n,) or (n, k) values as an array of VTK, a copy."""
    # VTK doesn't type this function.
    array: vtkDataArray = numpy_to_vtk(np.ascontiguousarray(values), deep=True)  # type: ignore[no-untyped-call]
    return array


def positions_of(local_xyz: NDArray[np.floating]) -> vtkPoints:
    """(n, 3) places as float32 points of VTK."""
    positions = vtkPoints()
    positions.SetData(as_vtk(local_xyz.astype(np.float32, copy=False)))
    return positions


def cloud_of(local_xyz: NDArray[np.floating]) -> vtkPolyData:
    """Places, each of them drawn."""
    data = vtkPolyData()
    data.SetPoints(positions_of(local_xyz))
    data.SetVerts(_cells(len(local_xyz), 1))
    return data


def lines_of(local_xyz: NDArray[np.floating]) -> vtkPolyData:
    """(m, 2, 3) places at both ends of lines."""
    data = vtkPolyData()
    data.SetPoints(positions_of(local_xyz.reshape(-1, 3)))
    data.SetLines(_cells(len(local_xyz), 2))
    return data


def faces_of(corners: NDArray[np.int64], sizes: NDArray[np.int64]) -> vtkCellArray:
    """Faces with their corners one after the other, ``sizes`` of each."""
    cells = vtkCellArray()
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    cells.SetData(as_vtk(offsets), as_vtk(corners.astype(np.int32)))
    return cells


def _cells(count: int, size: int) -> vtkCellArray:
    cells = vtkCellArray()
    offsets = as_vtk(np.arange(0, count * size + 1, size, dtype=np.int32))
    cells.SetData(offsets, as_vtk(np.arange(count * size, dtype=np.int32)))
    return cells
