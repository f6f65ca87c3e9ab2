"""PDF pages as a reader sees them: their words, and their picture."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import numpy as np
import pypdfium2
from numpy.typing import NDArray


def words_of(path: Path) -> list[str]:
    """The text of each page as it is copied out of a reader, without spaces."""
    document = pypdfium2.PdfDocument(str(path))
    try:
        pages = [page.get_textpage().get_text_bounded() for page in document]
    finally:
        document.close()
    return ["".join(unicodedata.normalize("NFKC", page).split()) for page in pages]


def plain(words: str) -> str:
    """Words as :func:`words_of` gives them."""
    return "".join(unicodedata.normalize("NFKC", words).split())


def picture_of(path: Path, page: int = 0) -> NDArray[np.uint8]:
    """A page at 72 dots an inch: (rows, columns, 3) uint8."""
    document = pypdfium2.PdfDocument(str(path))
    try:
        return np.asarray(document[page].render(scale=1.0).to_pil().convert("RGB"))
    finally:
        document.close()


def fonts_of(path: Path) -> set[str]:
    """Names of the fonts that a PDF carries."""
    document = pypdfium2.PdfDocument(str(path))
    try:
        return {
            found.get_font().get_base_name()
            for page in document
            for found in page.get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_TEXT])
        }
    finally:
        document.close()
