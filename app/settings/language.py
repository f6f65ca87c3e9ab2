"""Which of the two languages to speak, before any setting is known."""

from __future__ import annotations

import locale
import os

from processing.core.text import Language


def system_language() -> Language:
    """Japanese where the system or ``ZUKA_LANGUAGE`` says so, English elsewhere."""
    chosen = os.environ.get("ZUKA_LANGUAGE") or os.environ.get("LC_ALL")
    words = chosen or os.environ.get("LC_MESSAGES") or os.environ.get("LANG") or _of_locale()
    return "ja" if words.lower().startswith("ja") else "en"


def _of_locale() -> str:
    return locale.getlocale()[0] or ""
