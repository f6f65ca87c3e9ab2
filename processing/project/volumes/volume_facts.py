"""A kept volume as JSON: everything but its map."""

from __future__ import annotations

from dataclasses import fields
from datetime import date, datetime
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.methods.earthwork.volumes.volume_result import Registration, Volumes
from processing.methods.ground.filters.cells import CellGrid
from processing.project.volumes.volume import ChosenSide, KeptVolume, SideKind, VolumeRequest

VolumeRecord = dict[str, Any]  # what JSON holds


def values_of(kept: KeptVolume, grid: CellGrid) -> VolumeRecord:
    """What JSON is to hold of a volume, and of the cells of its map."""
    request, shift = kept.request, kept.registration
    return {
        "made": kept.made.isoformat(),
        "version": kept.version,
        "crs": kept.crs,
        "before": _side_values(request.before),
        "after": _side_values(request.after),
        "parameters": dict(request.parameters),
        "boundary": _words_of(request.boundary),
        "boundary_name": request.boundary_name,
        "line": _words_of(request.line),
        "break_lines": [_words_of(one) for one in request.break_lines],
        "others": [_side_values(one) for one in request.others],
        "volumes": _field_values(kept.volumes),
        "method": kept.method,
        "grid_m": kept.grid_m,
        "registration": None if shift is None else _field_values(shift),
        "notes": [{"en": one.en, "ja": one.ja} for one in kept.notes],
        "grid": {
            "origin": [float(one) for one in grid.origin],
            "size_m": grid.size_m,
            "rows": grid.rows,
            "columns": grid.columns,
        },
    }


def kept_of(facts: VolumeRecord, folder: Path) -> KeptVolume:
    """The volume that was written so; its folder's name is its id.

    Raises
    ------
    BadFile
        Something is missing, or is not what it should be.
    """
    try:
        shift = facts["registration"]
        return KeptVolume(
            id=folder.name,
            made=datetime.fromisoformat(facts["made"]),
            version=int(facts["version"]),
            crs=str(facts["crs"]),
            request=VolumeRequest(
                _side_of(facts["before"]),
                _side_of(facts["after"]),
                dict(facts["parameters"]),
                _shape_of(facts["boundary"]),
                _shape_of(facts["line"]),
                tuple(filter(None, map(_shape_of, facts["break_lines"]))),
                tuple(map(_side_of, facts["others"])),
                str(facts.get("boundary_name", "")),
            ),
            volumes=Volumes(**facts["volumes"]),
            method=str(facts["method"]),
            grid_m=float(facts["grid_m"]),
            registration=None if shift is None else _registration_of(shift),
            notes=tuple(Text(one["en"], one["ja"]) for one in facts["notes"]),
        )
    except (KeyError, TypeError, ValueError, shapely.errors.ShapelyError) as error:
        raise damaged(folder) from error


def _field_values(of: Volumes | Registration) -> VolumeRecord:
    return {one.name: _plain(getattr(of, one.name)) for one in fields(of)}


def _plain(value: object) -> Any:
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    return value.item() if isinstance(value, np.generic) else value


def _registration_of(values: VolumeRecord) -> Registration:
    east, north, up = values.pop("shift_m")
    sure = values.pop("sure_m")
    return Registration((east, north, up), (sure[0], sure[1], sure[2]), **values)


def _side_values(side: ChosenSide) -> VolumeRecord:
    day = side.measured_on
    return {
        "kind": side.kind.value,
        "name": side.name,
        "drives": list(side.drives),
        "path": side.path,
        "surface": side.surface,
        "measured_on": None if day is None else day.isoformat(),
        "height_m": side.height_m,
    }


def _side_of(values: VolumeRecord) -> ChosenSide:
    day = values["measured_on"]
    return ChosenSide(
        SideKind(values["kind"]),
        str(values["name"]),
        tuple(map(str, values["drives"])),
        str(values["path"]),
        str(values["surface"]),
        None if day is None else date.fromisoformat(day),
        float(values["height_m"]),
    )


def grid_of(values: VolumeRecord) -> CellGrid:
    """The cells of a map; raises what Python does where they are none."""
    origin = np.array(values["origin"], np.float64)
    return CellGrid(origin, float(values["size_m"]), int(values["rows"]), int(values["columns"]))


def _words_of(shape: BaseGeometry | None) -> str | None:
    return None if shape is None else shapely.to_wkt(shape, rounding_precision=-1)


def _shape_of(words: str | None) -> BaseGeometry | None:
    return None if words is None else shapely.from_wkt(words)


def damaged(path: Path) -> BadFile:
    """What is said of a volume that can't be read."""
    return BadFile(
        Text("A stored volume is damaged.", "保存された土量計算の結果が壊れています。"),
        Text.same(str(path)),
        Text(
            "Remove it from the list and run the comparison again.",
            "一覧から削除して、もう一度計算してください。",
        ),
    )
