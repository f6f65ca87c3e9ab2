"""Pictures of features, kept in the project: a folder for each run that cut them out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

from processing.formats.pictures.png import write_png
from processing.map.feature import Feature

PHOTOS = "results/photos"
"""Folder of a project."""

HANDED_IN = "photos"
"""Folder beside the files of an exported map."""

FIELD = "photo"
"""Attribute that names a feature's picture: its way from the project's folder, with slashes."""


def photo_folder(run: str) -> str:
    """Where the pictures of a run lie in its project's folder, with slashes."""
    return f"{PHOTOS}/{run}"


def photo_name(run: str, number: int) -> str:
    """Where the picture of a run's candidate lies in its project's folder, with slashes."""
    return f"{photo_folder(run)}/{number:05d}.png"


def write_photos(pictures: Mapping[str, NDArray[np.uint8]], folder: Path) -> None:
    """Write pictures by their names into a folder that is there.

    Parameters
    ----------
    pictures : mapping of str to (h, w, 3) uint8
        By their way from the project's folder; only the last part of it counts here.

    Raises
    ------
    NoSpace
    """
    for name, picture in pictures.items():
        height, width = picture.shape[:2]
        write_png(folder / PurePosixPath(name).name, (height, width), [picture])


def photo_of(feature: Feature, project: Path) -> Path | None:
    """The file of a feature's picture; None without one, or where somebody wrote something else."""
    name = feature.attributes.get(FIELD)
    if not isinstance(name, str) or not name.startswith(f"{PHOTOS}/"):
        return None
    way = PurePosixPath(name)
    path = project.joinpath(*way.parts)
    return path if ".." not in way.parts and path.is_file() else None


def photos_to_hand_in(
    features: Iterable[Feature], project: Path
) -> tuple[tuple[Feature, ...], dict[str, Path]]:
    """Features that name their pictures as they lie beside an exported map, and those pictures.

    A picture is called by its feature's id. What a person wrote in place of a picture stays as it
    is; the name of a picture that the project no longer has goes.

    Returns
    -------
    features : tuple of Feature
        In their order.
    pictures : dict of str to Path
        Files of the project by their names beside the map, with slashes.
    """
    named: list[Feature] = []
    pictures: dict[str, Path] = {}
    for feature in features:
        photo, attributes = photo_of(feature, project), dict(feature.attributes)
        if photo is not None:
            name = f"{HANDED_IN}/{feature.id}{photo.suffix}"
            attributes[FIELD], pictures[name] = name, photo
        elif str(attributes.get(FIELD, "")).startswith(f"{PHOTOS}/"):
            del attributes[FIELD]
        named.append(replace(feature, attributes=attributes))
    return tuple(named), pictures
