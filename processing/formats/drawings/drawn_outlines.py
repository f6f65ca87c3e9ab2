"""Closed polylines of a drawing (DXF) as areas: how CAD programs draw a boundary."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.drawings.dxf_document import APP_ID

_CLOSED_M = 1e-3
"""A polyline whose ends are no farther apart is closed: many CAD programs draw outlines so."""

_ARC_M = 1e-3
"""Arcs of polylines become chords that leave them by no more."""

_SILENT = logging.NullHandler()


@dataclass(frozen=True)
class DrawnOutlines:
    """Closed polylines of a drawing's model space.

    Attributes
    ----------
    by_layer : dict of str to list of (n, 2) float64
        Easting and northing, m; the first place is not repeated.
    crs : str
        ``EPSG:n`` that a drawing of this program names; empty for others.
    """

    by_layer: dict[str, list[NDArray[np.float64]]]
    crs: str


def outlines_of_dxf(path: Path) -> DrawnOutlines:
    """The closed polylines of a drawing.

    Numbers are taken as metres whatever the drawing says of its units: templates of CAD programs
    say millimetres, and survey coordinates are drawn into them in metres all the same.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is no DXF.
    """
    found: dict[str, list[NDArray[np.float64]]] = {}
    with opened_drawing(path) as drawing:
        for entity in drawing.modelspace().query("LWPOLYLINE POLYLINE"):
            outline = _outline(entity)
            if outline is not None:
                found.setdefault(entity.dxf.layer, []).append(outline)
        return DrawnOutlines(found, system_of_drawing(drawing))


@contextmanager
def opened_drawing(path: Path) -> Iterator[Any]:  # an ezdxf drawing; ezdxf is not typed here
    """A drawing to be read in the body.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is no DXF; damage that only the body meets too.
    """
    from ezdxf.filemanagement import readfile
    from ezdxf.lldxf.const import DXFError

    with report_as_user_error(path), path.open("rb"):
        pass  # the library takes a missing file for a damaged one
    # What the library mends by itself is no line on a terminal.
    logging.getLogger("ezdxf").addHandler(_SILENT)
    try:
        yield readfile(path)
    # Damage comes out of the library as whatever it stumbles over.
    except (
        DXFError,
        OSError,
        ValueError,
        TypeError,
        AttributeError,
        LookupError,
        ArithmeticError,
        StopIteration,
    ) as error:
        raise BadFile(
            Text("The file is no DXF drawing, or is damaged.", "DXFではないか、壊れています。"),
            Text.same(str(path)),
            Text(
                "Save the drawing as DXF once more, or give it as GeoJSON.",
                "DXFで保存し直すか、GeoJSONで指定してください。",
            ),
        ) from error


def system_of_drawing(drawing: Any) -> str:  # as of opened_drawing
    """``EPSG:n`` that a drawing of this program names; empty for others."""
    layer = drawing.layers.get("0")
    reported = [value for _, value in layer.get_xdata(APP_ID)] if layer.has_xdata(APP_ID) else []
    return next((str(value) for value in reported if str(value).startswith("EPSG:")), "")


def _outline(entity: Any) -> NDArray[np.float64] | None:
    from ezdxf.path import make_path

    if entity.dxftype() == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None
    drawn = list(make_path(entity).flattening(_ARC_M)) if len(entity) > 1 else []
    positions = np.array([(one.x, one.y) for one in drawn], dtype=np.float64).reshape(-1, 2)
    if len(positions) > 1 and float(np.hypot(*(positions[0] - positions[-1]))) <= _CLOSED_M:
        positions = positions[:-1]
    elif not entity.is_closed:
        return None
    return positions if len(positions) > 2 else None
