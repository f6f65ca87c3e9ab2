"""Settings: what the program remembers of its user, apart from projects."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import TypeVar

from platformdirs import user_config_path
from PySide6.QtCore import QByteArray, QSettings

from app.layout.view_area import AreaLayout
from app.settings.language import system_language
from app.settings.theme import ThemeChoice
from processing.core.stored_json import json_of
from processing.core.text import Language
from processing.image.search.corridor import CorridorExtent
from widgets.parts.recent_project import RecentProject
from widgets.section_view.picture.settings import SectionSettings
from widgets.shared.image_orientation import ImageOrientation

_Kept = TypeVar("_Kept")

_MOST_RECENT = 10
_MOST_USED = 30
_RECENT, _OPENED_AT = "recent", "recent_opened_at"
_KEYS = "shortcuts"
_BETWEEN_KEYS = "\n"  # keys hold commas and blanks


@dataclass(frozen=True)
class WindowLayout:
    """How a window stands, in Qt's own words.

    Attributes
    ----------
    geometry : QByteArray
        Its place on the screen.
    docks : QByteArray
        Docks and toolbar as they are while a project is open.
    views : AreaLayout
        How the views share the middle.
    """

    geometry: QByteArray
    docks: QByteArray
    views: AreaLayout


class Settings:
    """Language, theme, keys, recent projects and the window's layout, kept in one file.

    Parameters
    ----------
    file : Path or None
        The settings file; None for the user's own.
    """

    def __init__(self, file: Path | None = None) -> None:
        path = file or user_config_path("zuka", appauthor=False) / "zuka.ini"
        self._store = QSettings(str(path), QSettings.Format.IniFormat)

    @property
    def language(self) -> Language:
        """The language chosen, or the system's."""
        chosen = str(self._store.value("language", ""))
        return chosen if chosen in ("en", "ja") else system_language()  # type: ignore[return-value]

    def choose_language(self, language: Language) -> None:
        """Speak this language from now on."""
        self._store.setValue("language", language)

    @property
    def theme(self) -> ThemeChoice:
        """Light, dark, or as the system is."""
        chosen = str(self._store.value("theme", ""))
        known = {choice.value: choice for choice in ThemeChoice}
        return known.get(chosen, ThemeChoice.SYSTEM)

    def choose_theme(self, theme: ThemeChoice) -> None:
        """Look like this from now on."""
        self._store.setValue("theme", theme.value)

    @property
    def shortcuts(self) -> dict[str, tuple[str, ...]]:
        """Keys that the user chose, by action; no keys for one that is to have none."""
        self._store.beginGroup(_KEYS)
        ids = self._store.childKeys()
        self._store.endGroup()
        stored = {id_: str(self._store.value(f"{_KEYS}/{id_}", "")) for id_ in ids}
        return {
            id_: tuple(keys.split(_BETWEEN_KEYS)) if keys else () for id_, keys in stored.items()
        }

    def keep_shortcuts(self, shortcuts: Mapping[str, tuple[str, ...]]) -> None:
        """Keep exactly these keys as the user's own."""
        self._store.remove(_KEYS)
        for id_, keys in shortcuts.items():
            self._store.setValue(f"{_KEYS}/{id_}", _BETWEEN_KEYS.join(keys))

    @property
    def last_used(self) -> tuple[str, ...]:
        """Ids of the actions last chosen by name, the newest first."""
        return tuple(self._strings("last_used"))

    def remember_use(self, action: str) -> None:
        """Put an action first among those chosen by name."""
        others = [id_ for id_ in self.last_used if id_ != action]
        self._store.setValue("last_used", [action, *others][:_MOST_USED])

    @property
    def recent_projects(self) -> tuple[RecentProject, ...]:
        """Projects opened last, newest first; those that are no longer there as well."""
        names, times = self._strings(_RECENT), self._strings(_OPENED_AT)
        times += [""] * (len(names) - len(times))
        return tuple(
            RecentProject(Path(name), _time_of(time), is_missing=not Path(name).is_dir())
            for name, time in zip(names, times, strict=False)
        )

    def remember_project(self, folder: Path) -> None:
        """Put a project first among the recent ones, as opened now."""
        others = [project for project in self.recent_projects if project.folder != folder]
        now = RecentProject(folder, datetime.now().astimezone(), is_missing=False)
        self._keep_recent([now, *others][:_MOST_RECENT])

    def forget_project(self, folder: Path) -> None:
        """Take a project off the recent ones."""
        self._keep_recent([one for one in self.recent_projects if one.folder != folder])

    @property
    def section(self) -> SectionSettings:
        """How sections were cut last."""
        return self._value("section", SectionSettings)

    def remember_section(self, section: SectionSettings) -> None:
        """Cut sections like this the next time."""
        self._store.setValue("section", json.dumps(asdict(section)))

    @property
    def image_orientation(self) -> ImageOrientation:
        """Which way images ran last."""
        return self._value("image_orientation", ImageOrientation)

    def remember_image_orientation(self, orientation: ImageOrientation) -> None:
        """Let images run like this the next time."""
        self._store.setValue("image_orientation", json.dumps(asdict(orientation)))

    @property
    def slab(self) -> CorridorExtent:
        """How far the 3D view showed points around the drive last."""
        return self._value("slab", CorridorExtent)

    def remember_slab(self, slab: CorridorExtent) -> None:
        """Show points so far around the drive the next time."""
        self._store.setValue("slab", json.dumps(asdict(slab)))

    @property
    def layout(self) -> WindowLayout | None:
        """The window's layout as it was left; None before it was left once."""
        geometry, docks = self._store.value("geometry"), self._store.value("state")
        if isinstance(geometry, QByteArray) and isinstance(docks, QByteArray):
            views = AreaLayout(
                self._bytes("views"),
                self._bytes("view_docks"),
                self._says("views_apart"),
                self._says("image_hidden"),
            )
            return WindowLayout(geometry, docks, views)
        return None

    def remember_layout(self, layout: WindowLayout) -> None:
        """Keep the window's layout for the next start."""
        self._store.setValue("geometry", layout.geometry)
        self._store.setValue("state", layout.docks)
        self._store.setValue("views", layout.views.shares)
        self._store.setValue("view_docks", layout.views.docks)
        self._store.setValue("views_apart", layout.views.is_apart)
        self._store.setValue("image_hidden", layout.views.is_image_hidden)

    def _keep_recent(self, projects: list[RecentProject]) -> None:
        self._store.setValue(_RECENT, [str(project.folder) for project in projects])
        times = ["" if one.opened_at is None else one.opened_at.isoformat() for one in projects]
        self._store.setValue(_OPENED_AT, times)

    def _value(self, name: str, kind: type[_Kept]) -> _Kept:
        """A value that was kept as JSON; the usual one where that is of another version."""
        stored = str(self._store.value(name, ""))
        try:
            return kind(**json_of(stored)) if stored else kind()
        except (ValueError, TypeError):
            return kind()

    def _bytes(self, name: str) -> QByteArray:
        stored = self._store.value(name)
        return stored if isinstance(stored, QByteArray) else QByteArray()

    def _says(self, name: str) -> bool:
        # In the file it is a word.
        return str(self._store.value(name, "")).lower() == "true"

    def _strings(self, name: str) -> list[str]:
        stored = self._store.value(name, [])
        if isinstance(stored, list):
            return [str(one) for one in stored]
        # A list of one comes back as its only string.
        return [str(stored)] if stored else []


def _time_of(text: str) -> datetime | None:
    try:
        return datetime.fromisoformat(text) if text else None
    except ValueError:
        return None
