"""Settings: what the program remembers of its user, apart from projects."""

from __future__ import annotations

from pathlib import Path

from platformdirs import user_config_path
from PySide6.QtCore import QByteArray, QSettings

from app.language import system_language
from processing.text import Language

_MOST_RECENT = 10


class Settings:
    """Language, recent projects and the window's layout, kept in one file.

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
        """Speak this language from the next start on."""
        self._store.setValue("language", language)

    @property
    def recent_projects(self) -> tuple[Path, ...]:
        """Projects opened last that still exist, newest first."""
        stored = self._store.value("recent", [])
        names = stored if isinstance(stored, list) else [stored] if stored else []
        return tuple(Path(str(name)) for name in names if Path(str(name)).is_dir())

    def remember_project(self, folder: Path) -> None:
        """Put a project first among the recent ones."""
        others = [str(path) for path in self.recent_projects if path != folder]
        self._store.setValue("recent", [str(folder), *others][:_MOST_RECENT])

    @property
    def layout(self) -> tuple[QByteArray, QByteArray] | None:
        """The window's geometry and the state of its docks, as they were left."""
        geometry, state = self._store.value("geometry"), self._store.value("state")
        if isinstance(geometry, QByteArray) and isinstance(state, QByteArray):
            return geometry, state
        return None

    def remember_layout(self, geometry: QByteArray, state: QByteArray) -> None:
        """Keep the window's layout for the next start."""
        self._store.setValue("geometry", geometry)
        self._store.setValue("state", state)
