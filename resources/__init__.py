"""What comes with the program besides code: :func:`path_of` is the one way to a bundled file."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


class UnknownResource(KeyError):
    """A name that no bundled file or folder has: a defect of the program, not of its input."""


def path_of(name: str) -> Path:
    """Give the path of a bundled file or folder.

    Parameters
    ----------
    name : str
        The path below ``resources`` with slashes: ``catalogue/level500.toml``.

    Raises
    ------
    UnknownResource
        When there is no such file or folder, or the name leads out of the resources.
    """
    folder = Path(str(files("resources")))
    path = folder.joinpath(name)
    if not name or ".." in path.parts or not path.is_relative_to(folder) or not path.exists():
        raise UnknownResource(f"resources has no {name!r}")
    return path
