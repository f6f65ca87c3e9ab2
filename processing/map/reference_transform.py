"""Coordinates from one reference system to another, where that is exact enough for a map."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, OutOfRange, Unsuitable
from processing.core.text import Text

if TYPE_CHECKING:
    from pyproj import CRS, Transformer

MOST_ERROR_M = 0.05
"""The worst accuracy of a transformation between two systems that positions may take."""

_DECIMALS_OF_ACCURACY = 2


@dataclass(frozen=True)
class ReferenceTransform:
    """The best transformation of one reference system to another, in plan; heights are kept.

    Attributes
    ----------
    source, target : str
        As they were asked for.
    note : Text
        What became of positions: the accuracy of the transformation as PROJ states it, and the
        heights.
    """

    source: str
    target: str
    note: Text
    _transformer: Transformer

    def apply(self, xyz: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places in the target system; a copy.

        Parameters
        ----------
        xyz : (n, 3) float64
            Easting, northing, height, m, in the source system; degrees east and north in plan
            where that is geographic.

        Returns
        -------
        (n, 3) float64
            Easting, northing in the target system, m; the same heights.

        Raises
        ------
        OutOfRange
            A place has no coordinates in the target system.
        """
        moved = xyz.copy()
        moved[:, 0], moved[:, 1] = self._transformer.transform(xyz[:, 0], xyz[:, 1])
        is_lost = ~np.isfinite(moved).all(axis=1)
        if is_lost.any():
            easting, northing, _ = xyz[int(np.argmax(is_lost))]
            raise OutOfRange(
                Text(
                    "A place lies outside of what {target} can express.",
                    "{target} で表せない位置の点があります。",
                ).filled(target=self.target),
                Text.same(f"{self.source}: {easting:.3f}, {northing:.3f}"),
                Text(
                    "Check the reference system of the source. {unchanged}",
                    "元データの座標参照系を確認してください。{unchanged}",
                ).filled(unchanged=UNCHANGED),
            )
        return moved


def reference_transform(source: str, target: str) -> ReferenceTransform:
    """The best transformation from one reference system to another.

    Parameters
    ----------
    source, target : str
        ``EPSG:n``, ``OGC:CRS84``; of a compound system its horizontal part counts.

    Raises
    ------
    OutOfRange
        There is no such reference system.
    Unsuitable
        No transformation is known to :data:`MOST_ERROR_M`: between datums without the official grid
        of shifts; names the accuracy of the best one.
    """
    from pyproj.transformer import TransformerGroup

    systems = (_system(source), _system(target))
    with warnings.catch_warnings():
        # PROJ warns of grids that are not installed; the accuracy below says it to the user.
        warnings.simplefilter("ignore", UserWarning)
        group = TransformerGroup(
            _plan(systems[0]), _plan(systems[1]), always_xy=True, allow_ballpark=False
        )
    known = [one for one in group.transformers if one.accuracy >= 0]
    best = min(known, key=lambda one: one.accuracy, default=None)
    if best is None or best.accuracy > MOST_ERROR_M:
        grids = {grid.short_name for one in group.unavailable_operations for grid in one.grids}
        raise _too_inexact(systems, None if best is None else best.accuracy, sorted(grids))
    note = Text(
        "Coordinates were transformed from {source} to {target} (accuracy {accuracy} m as PROJ "
        "states it); heights were kept.",
        "座標を {source} から {target} に変換しました（PROJによる精度 {accuracy} m）。"
        "標高は変換していません。",
    ).filled(
        source=_name_system(source, systems[0]),
        target=_name_system(target, systems[1]),
        accuracy=f"{best.accuracy:.{_DECIMALS_OF_ACCURACY}f}",
    )
    return ReferenceTransform(source, target, note, best)


def _system(code: str) -> CRS:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        return CRS.from_user_input(code)
    except CRSError as error:
        raise OutOfRange(
            Text("There is no such reference system.", "そのような座標参照系はありません。"),
            Text.same(code),
            Text(
                "Copy from a map whose reference system is an EPSG code. {unchanged}",
                "座標参照系がEPSGコードで示された地図からコピーしてください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        ) from error


def _plan(system: CRS) -> CRS:
    return system.sub_crs_list[0] if system.is_compound else system


def _name_system(code: str, system: CRS) -> str:
    return f"{code} {system.name}"


def _too_inexact(systems: tuple[CRS, CRS], accuracy: float | None, grids: list[str]) -> Unsuitable:
    if accuracy is None:
        what = Text(
            "No transformation between the two reference systems has a known accuracy.",
            "2つの座標参照系の間には、精度のわかる変換方法がありません。",
        )
    else:
        what = Text(
            "The best transformation between the two reference systems is only exact to "
            "{accuracy} m; a map needs {needed} m.",
            "2つの座標参照系の間の変換精度は最良でも {accuracy} m で、"
            "地図に必要な {needed} m に足りません。",
        ).filled(accuracy=f"{accuracy:.{_DECIMALS_OF_ACCURACY}f}", needed=MOST_ERROR_M)
    if grids:
        remedy = Text(
            "The grid {grids} is missing: transform the map with a program that has it. "
            "{unchanged}",
            "変換パラメータ {grids} がありません。これを備えたプログラムで変換してください。"
            "{unchanged}",
        )
    else:
        remedy = Text(
            "Transform the map with a program that knows both systems. {unchanged}",
            "両方の座標参照系に対応したプログラムで変換してください。{unchanged}",
        )
    where = Text.same(f"{systems[0].name} → {systems[1].name}")
    return Unsuitable(what, where, remedy.filled(grids=", ".join(grids), unchanged=UNCHANGED))
