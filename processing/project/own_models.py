"""The models of classes that a project learnt: which there are, and which one a run uses."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any

OWN_MODELS = "models/classes"
"""Folder of a project: a folder for each model, named by when it was made."""

_FOLDER = "model_folder"


def model_name(id_: str) -> str:
    """Where a model lies in its project's folder, with slashes."""
    return f"{OWN_MODELS}/{id_}"


def model_id(made: datetime) -> str:
    """The name of a model: names are in the order in which models were made."""
    return f"{made:%Y%m%dT%H%M%S%f}"


def newest_model(project: Path) -> Path | None:
    """The folder of the model that a project learnt last; None without one."""
    home = project / OWN_MODELS
    folders = [one for one in home.iterdir() if one.is_dir()] if home.is_dir() else []
    return max(folders, key=lambda one: one.name, default=None)


# Each tool has parameters of its own.
def with_own_model(parameters: Any, project: Path | None) -> Any:
    """Parameters of a tool that asks for a learnt model and names none, with the newest one."""
    if project is None or getattr(parameters, _FOLDER, None) != "":
        return parameters
    newest = newest_model(project)
    return parameters if newest is None else replace(parameters, **{_FOLDER: str(newest)})
