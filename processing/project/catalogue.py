"""Catalogue: the list of feature kinds that a map may hold."""

from __future__ import annotations

from enum import Enum


class Geometry(Enum):
    """The shape of a feature."""

    POINT = "point"
    LINE = "line"
    AREA = "area"
