"""XML from anywhere, element by element: in any encoding, in bounded memory, without entities.

Entities that a document declares itself can grow without end or name other files: no survey file
needs them, so a document that declares a type is refused.
"""

from __future__ import annotations

import codecs
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO
from xml.parsers import expat

from processing.core.errors import BadFile, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text

_CHUNK_BYTES = 1 << 18
_HEAD_BYTES = 400
_ENCODING = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z0-9._:-]+)["']""")
_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
_WITHOUT_MARK = {b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
_SHIFT_JIS = {"shift_jis", "shift-jis", "sjis", "x-sjis", "ms_kanji", "windows-31j", "cp932"}
_ENDS_EARLY = (
    expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS],
    expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_TOKEN],
    expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION],
    expat.errors.codes[expat.errors.XML_ERROR_PARTIAL_CHAR],
)
COPY_AGAIN = Text(
    "Copy the file again from the delivery, or export it again.",
    "納品データからコピーし直すか、書き出し直してください。",
)

StartHandler = Callable[[str, dict[str, str]], None]
EndHandler = Callable[[str], None]


class CheckedXml:
    """One reading of a document.

    Parameters
    ----------
    path : Path
    root : str
        Name that the outermost element must have, without namespace.
    """

    def __init__(self, path: Path, root: str) -> None:
        self.path = path
        self._root = root
        self._is_in = False
        self._start: StartHandler
        # What is read is decoded before: expat itself knows few encodings.
        self._parser = expat.ParserCreate("utf-8")
        self._parser.buffer_text = True
        self._parser.buffer_size = 1 << 16
        self._parser.StartElementHandler = self._on_root
        self._parser.StartDoctypeDeclHandler = self._on_doctype

    @property
    def line(self) -> int:
        """Where the reading is, from 1."""
        return self._parser.CurrentLineNumber

    def refused(self, what: Text, line: int = 0, remedy: Text = COPY_AGAIN) -> BadFile:
        """The error for what stands at a line; 0 for where the reading is."""
        line = line or self.line
        where = Text(f"{self.path}, line {line:,}", f"{self.path}、{line:,}行目")
        return BadFile(what, where, remedy)

    def listen_to_text(self, listener: Callable[[str], None] | None) -> None:
        """Give the text that follows to a listener, in pieces; to nobody for None."""
        self._parser.CharacterDataHandler = listener

    def read(self, start: StartHandler, end: EndHandler, monitor: Monitor) -> None:
        """Go through the whole document.

        Parameters
        ----------
        start, end : callable
            Called with an element's name without its namespace, ``start`` with its attributes too.

        Raises
        ------
        MissingInput, NoSpace
            The file can't be read.
        BadFile
            It is no XML, ends early, has another root, declares a type, or is not in the encoding
            that it names.
        Cancelled
        """
        self._start = start
        self._parser.EndElementHandler = lambda name: end(name.rpartition(":")[2])
        with report_as_user_error(self.path), self.path.open("rb") as file:
            encoding = self._encoding(file)
            decoder = codecs.getincrementaldecoder(encoding)()
            size = max(os.fstat(file.fileno()).st_size, 1)
            is_last = False
            while not is_last:
                monitor.check()
                data = file.read(_CHUNK_BYTES)
                is_last = not data
                try:
                    text = decoder.decode(data, is_last)
                    self._parser.Parse(text.encode(), is_last)
                except UnicodeError as error:
                    raise self._not_encoded(encoding) from error
                except expat.ExpatError as error:
                    raise self._not_xml(error) from error
                monitor.report(file.tell() / size)

    def _encoding(self, file: BinaryIO) -> str:
        head = file.read(_HEAD_BYTES)
        file.seek(0)
        for mark, encoding in (_MARKS | _WITHOUT_MARK).items():
            if head.startswith(mark):
                return encoding
        named = _ENCODING.search(head)
        name = named[1].decode().lower() if named else "utf-8"
        if name.startswith(("utf-16", "utf16", "unicode")):
            return "utf-8"  # or its own declaration could not have been read byte by byte
        if name in _SHIFT_JIS:
            return "cp932"  # with the characters of Windows, which its programs write
        try:
            b"    ".decode(name)  # unlike a look-up, it refuses codecs that are none of text
        except (LookupError, UnicodeError) as error:
            raise self._not_encoded(name) from error
        return name

    def _on_root(self, name: str, attributes: dict[str, str]) -> None:
        local = name.rpartition(":")[2]
        if local != self._root:
            raise self.refused(
                Text("The file is XML, but no {root}.", "XMLですが、{root}ではありません。").filled(
                    root=self._root
                ),
                remedy=Text("Choose another file.", "別のファイルを選んでください。"),
            )
        self._is_in = True
        start = self._start
        self._parser.StartElementHandler = lambda name, attributes: start(
            name.rpartition(":")[2], attributes
        )
        start(local, attributes)

    # Any: expat's signature; none of it is looked at.
    def _on_doctype(self, *_: object) -> None:
        raise self.refused(
            Text(
                "The file declares a document type, which is not read for safety's sake.",
                "文書型宣言（DOCTYPE）を含むXMLは、安全のため読み込めません。",
            ),
            remedy=Text(
                "Remove the DOCTYPE line, or export the file again.",
                "DOCTYPEの行を削除するか、書き出し直してください。",
            ),
        )

    def _not_xml(self, error: expat.ExpatError) -> BadFile:
        line = max(error.lineno, 1)
        if not self._is_in:
            what = Text("The file is no {root}.", "{root}ではありません。").filled(root=self._root)
        elif error.code in _ENDS_EARLY:
            what = Text("The file ends early.", "ファイルが途中で終わっています。")
        else:
            reason = expat.ErrorString(error.code)
            what = Text("The file is damaged: {reason}.", "ファイルが壊れています（{reason}）。")
            what = what.filled(reason=reason)
        return self.refused(what, line)

    def _not_encoded(self, encoding: str) -> BadFile:
        return self.refused(
            Text(
                "The file is not in the encoding that it names ({encoding}).",
                "ファイルの文字コードが宣言（{encoding}）と異なります。",
            ).filled(encoding=encoding),
            remedy=Text(
                "Save it again as UTF-8, with that encoding in its first line.",
                "UTF-8で保存し直し、先頭行の文字コードの宣言も合わせてください。",
            ),
        )
