"""Layers of a PDF: what a reader of drawings shows and hides by name.

reportlab knows none. A layer is an optional content group of the catalogue; what belongs to it
stands in the pages between two marks that name it.

References
----------
ISO 32000-1, 8.11: optional content.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from reportlab.pdfbase.pdfdoc import PDFObjectReference
    from reportlab.pdfgen.canvas import Canvas

VERSION = (1, 5)
"""The first version of PDF that has layers."""


class PdfLayers:
    """The layers of a document being written.

    Parameters
    ----------
    canvas : Canvas
        Of version :data:`VERSION`, with words and lines alone: its pages' other resources would
        be lost.
    """

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._groups: dict[str, PDFObjectReference] = {}
        self._open = ""

    def begin(self, name: str) -> None:
        """Let what follows belong to a layer, after what belonged to another."""
        if name == self._open:
            return
        self.end()
        if name not in self._groups:
            self._groups[name] = self._group(name)
        mark = self._mark(name)
        self._write(f"/OC /{mark} BDC")
        self._open = name

    def end(self) -> None:
        """Let what follows belong to no layer; before each page ends."""
        if self._open:
            self._write("EMC")
            self._open = ""

    def finish(self) -> None:
        """Name the layers to the document; before it is saved, after its last page."""
        if not self._groups:
            return
        from reportlab.pdfbase.pdfdoc import PDFArray, PDFDictionary, PDFResourceDictionary

        document = self._canvas._doc  # noqa: SLF001 (reportlab has no other door to it)
        groups = list(self._groups.values())
        shown = PDFDictionary({"Order": PDFArray(groups), "ON": PDFArray(groups)})
        catalogue = document.Catalog
        catalogue.OCProperties = PDFDictionary({"OCGs": PDFArray(groups), "D": shown})
        catalogue.__NoDefault__ = [*catalogue.__NoDefault__, "OCProperties"]
        marks = {self._mark(name): group for name, group in self._groups.items()}
        for page in document.Pages.pages:
            resources = PDFResourceDictionary(Properties=marks)
            resources.basicFonts()
            page.Resources = resources

    def _group(self, name: str) -> PDFObjectReference:
        from reportlab.pdfbase.pdfdoc import PDFDictionary, PDFName, PDFString

        group = PDFDictionary({"Type": PDFName("OCG"), "Name": PDFString(name)})
        group.__RefOnly__ = 1
        return self._canvas._doc.Reference(group)  # noqa: SLF001 (as above)

    def _mark(self, name: str) -> str:
        return f"Layer{list(self._groups).index(name)}"

    def _write(self, operator: str) -> None:
        self._canvas._code.append(operator)  # noqa: SLF001 (as above)
