"""Translation: the words of the window, and of Qt's own forms, in the language chosen."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QObject, QTranslator

from processing.core.text import Language
from resources import path_of


class Translation(QObject):
    """Speaks one language at a time; what was installed before is taken out first."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._installed: list[QTranslator] = []

    def speak(self, language: Language) -> None:
        """Translate into this language what is made from now on."""
        for old in self._installed:
            QCoreApplication.removeTranslator(old)
            old.deleteLater()
        self._installed.clear()
        qt = QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)
        own = str(path_of("translations"))
        # English is what the sources say, but for plurals.
        for name, folder in ((f"qtbase_{language}", qt), (f"zuka_{language}", own)):
            translator = QTranslator(self)
            if translator.load(name, folder):
                QCoreApplication.installTranslator(translator)
                self._installed.append(translator)
