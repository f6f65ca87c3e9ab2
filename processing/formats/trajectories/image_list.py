"""Lists of camera images as delivered: one line an image, with its orientation."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text
from processing.formats.trajectories.text_table import TextTable, read_table
from processing.recording.camera_images.image_list import CameraImage, ImageList, ProjectionName

_NUMBERS: dict[str, tuple[float, float]] = {
    "time_s": (-1e11, 1e11),
    "easting_m": (-1e8, 1e8),
    "northing_m": (-1e8, 1e8),
    "height_m": (-1e5, 1e5),
    "omega_deg": (-360.0, 360.0),
    "phi_deg": (-360.0, 360.0),
    "kappa_deg": (-360.0, 360.0),
    "focal_px": (1e-3, 1e7),
    "cx_px": (-1e6, 1e6),
    "cy_px": (-1e6, 1e6),
    "width_px": (1, 1e6),
    "height_px": (1, 1e6),
}
_DISTORTION = ("k1", "k2", "p1", "p2", "k3")
_PROJECTIONS = ("perspective", "equirectangular")
_SAYS_SO = b"omega_deg"


def is_image_list(start: bytes) -> bool:
    """Whether a file's first line is the header of an image list."""
    return _SAYS_SO in start.partition(b"\n")[0].lower()


def read_image_list(path: Path) -> ImageList:
    """Read the list of a drive's camera images.

    Parameters
    ----------
    path : Path
        CSV with columns ``path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,
        focal_px,cx_px,cy_px,width_px,height_px`` and, if wanted, ``k1,k2,p1,p2,k3`` and
        ``projection``, in any order, among any others. Image paths are relative to its folder.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; a column is missing; a cell holds what it can't: names the line.
    """
    table = read_table(path)
    table.require(("path", *_NUMBERS))
    numbers = {name: table.numbers(name, low, high) for name, (low, high) in _NUMBERS.items()}
    distortion = np.column_stack([_optional_numbers(table, name) for name in _DISTORTION])
    projections = _projections(table)
    images = []
    for i, name in enumerate(table.words("path")):
        if not name or "\0" in name:
            raise table.damage(i, Text("The image's path is missing.", "画像のパスがありません。"))
        row = {key: float(values[i]) for key, values in numbers.items()}
        k1, k2, p1, p2, k3 = (float(value) for value in distortion[i])
        images.append(
            CameraImage(
                path=path.parent / name.replace("\\", "/"),
                time_s=row["time_s"],
                xyz=(row["easting_m"], row["northing_m"], row["height_m"]),
                omega_deg=row["omega_deg"],
                phi_deg=row["phi_deg"],
                kappa_deg=row["kappa_deg"],
                focal_px=row["focal_px"],
                cx_px=row["cx_px"],
                cy_px=row["cy_px"],
                width_px=round(row["width_px"]),
                height_px=round(row["height_px"]),
                distortion=(k1, k2, p1, p2, k3),
                projection=projections[i],
            )
        )
    return ImageList(tuple(images))


def _optional_numbers(table: TextTable, name: str) -> NDArray[np.float64]:
    return table.numbers(name, -1e6, 1e6) if table.has(name) else np.zeros(len(table.rows))


def _projections(table: TextTable) -> list[ProjectionName]:
    if not table.has("projection"):
        return ["perspective"] * len(table.rows)
    words = [word.lower() or "perspective" for word in table.words("projection")]
    for i, word in enumerate(words):
        if word not in _PROJECTIONS:
            what = Text(
                "The projection “{word}” is unknown; perspective and equirectangular are known.",
                "投影「{word}」は使えません（perspective または equirectangular）。",
            )
            raise table.damage(i, what.filled(word=word[:40]))
    return [cast("ProjectionName", word) for word in words]
