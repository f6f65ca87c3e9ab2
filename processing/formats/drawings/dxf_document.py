"""How every drawing here begins and ends: version and code page, text style, extent, bytes.

R2007 and later are UTF-8 by definition; R12 and R2000 have a code page, which is cp932 here, as the
CAD programs of Japanese offices expect.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from io import TextIOWrapper
from pathlib import Path
from typing import Any, Literal, get_args

from typing_extensions import override

from processing.core.errors import OutOfRange, Unsuitable, use_one_of
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.formats.drawings.dxf_text import dxf_text, label_text
from processing.map.catalogue import LINE_TYPES

DxfVersion = Literal["R12", "R2000", "R2007", "R2010", "R2018"]

ENCODINGS: Mapping[DxfVersion, str] = {
    "R12": "cp932",
    "R2000": "cp932",
    "R2007": "utf-8",
    "R2010": "utf-8",
    "R2018": "utf-8",
}
"""By version."""

PlanVersion = Literal["R2000", "R2007", "R2018"]
"""Those that have fills and light polylines."""

_TRUE_COLOURS: frozenset[DxfVersion] = frozenset({"R2007", "R2010", "R2018"})

APP_ID = "ZUKA"
"""Application id of the extended data."""

SHEET_MARK = "sheet"
"""What the extended data of frames, legends and other paper around the map says."""

_STYLE, _FONT, _FONT_FAMILY = "JAPANESE", "msgothic.ttc", "MS Gothic"
_CHECK_WRITES = 4096
_SILENT = logging.NullHandler()

DxfPoint = tuple[float, ...]


class DxfDocument:
    """A drawing in metres that is being filled.

    Parameters
    ----------
    version : {"R12", "R2000", "R2007", "R2010", "R2018"}
        AC1009, AC1015, AC1021, AC1024 or AC1032.

    Attributes
    ----------
    doc : ezdxf drawing
    space : its model space
    encoding : str
        Of the bytes.
    has_true_colours : bool
        Older versions take the index of a colour alone.
    has_light_polylines : bool
        R12 takes polylines with vertices of their own alone.

    Raises
    ------
    OutOfRange
        There is no such version.
    """

    def __init__(self, version: DxfVersion) -> None:
        from ezdxf import units
        from ezdxf.filemanagement import new

        check_one_of(version, ENCODINGS)
        # That R12 carries no units is no line on a terminal.
        logging.getLogger("ezdxf").addHandler(_SILENT)
        self.has_true_colours = version in _TRUE_COLOURS
        self.has_light_polylines = version != "R12"
        self.encoding = ENCODINGS[version]
        # Any: ezdxf is not typed here.
        self.doc: Any = new(version)
        self.doc.encoding = "cp932"  # the code page that even UTF-8 files name
        if version != "R12":  # carries no units
            self.doc.units = units.M
        self.doc.header["$MEASUREMENT"] = 1
        style = self.doc.styles.add(_STYLE, font=_FONT)
        style.set_extended_font_data(_FONT_FAMILY)
        self.space: Any = self.doc.modelspace()

    @classmethod
    def of_plan(cls, version: PlanVersion) -> DxfDocument:
        """A drawing with fills and light polylines.

        Raises
        ------
        OutOfRange
            The version has none.
        """
        check_one_of(version, get_args(PlanVersion))
        return cls(version)

    def tell_system(self, crs: str) -> None:
        """Write ``EPSG:n``, or that it is not known, where drawings of this program are asked."""
        reported = crs or "unknown"
        self.doc.appids.add(APP_ID)
        self.doc.header.custom_vars.append("CRS", reported)
        # R12 and R2000 have no properties of their own.
        self.doc.layers.get("0").set_xdata(APP_ID, [(1000, "CRS"), (1000, reported)])

    def add_layer(self, name: str, aci: int, rgb: tuple[int, int, int] | None = None) -> None:
        """Add a layer of a colour; older versions take the index alone."""
        layer = self.doc.layers.add(name, color=aci)
        if rgb is not None and self.has_true_colours:
            layer.rgb = rgb

    def add_line_types(self) -> None:
        """Add the patterns of the catalogue, in metres on the ground at 1:500."""
        for name, pattern in LINE_TYPES.items():
            if pattern:
                total = sum(abs(length) for length in pattern)
                self.doc.linetypes.add(name.upper(), pattern=[total, *pattern], description=name)

    def require_encodable(self, layer: str) -> None:
        """Refuse a layer's name that the version's bytes can't hold.

        Raises
        ------
        Unsuitable
            It has characters that cp932 lacks.
        """
        if dxf_text(layer, self.encoding) != layer:
            raise Unsuitable(
                Text(
                    "The layer's name has characters that Shift_JIS (cp932) lacks.",
                    "画層名にShift_JIS（cp932）で表せない文字があります。",
                ),
                Text.same(layer),
                Text(
                    "Export as DXF 2007 or 2018, or change the layer in the catalogue.",
                    "DXF 2007か2018で書き出すか、カタログの画層名を変更してください。",
                ),
            )

    def write_text(
        self, words: str, position: DxfPoint, align: str, attributes: Mapping[str, Any]
    ) -> None:
        """Write words at a place, unless nothing of them is left.

        Parameters
        ----------
        align : str
            Name of an ezdxf ``TextEntityAlignment``: which part of the words is at ``position``.
        attributes : mapping
            Of DXF: layer, height, rotation.
        """
        from ezdxf.enums import TextEntityAlignment

        written = label_text(words, self.encoding)
        if written:
            text = self.space.add_text(written, dxfattribs={"style": _STYLE, **attributes})
            text.set_placement(position, align=TextEntityAlignment[align])

    def show(self, low: DxfPoint, high: DxfPoint) -> None:
        """Set the extent and what is seen when the file is opened: all of it."""
        lowest, highest = ((*corner, 0.0)[:3] for corner in (low, high))
        self.space.reset_extents(lowest, highest)
        self.doc.header["$EXTMIN"] = lowest
        self.doc.header["$EXTMAX"] = highest
        width, depth = (highest[axis] - lowest[axis] for axis in (0, 1))
        middle = tuple((highest[axis] + lowest[axis]) / 2 for axis in (0, 1))
        # Windows are about twice as wide as high.
        self.doc.set_modelspace_vport(max(depth, width / 2, 10.0) * 1.1, middle)

    def write(self, path: Path, monitor: Monitor) -> None:
        """Write the file with the line ends of Windows, where its readers are."""
        with (
            path.open("wb") as file,
            _Watched(file, self.encoding, "dxfreplace", "\r\n") as text,
        ):
            text.monitor = monitor
            self.doc.write(text)


def check_one_of(value: str, allowed: Iterable[str]) -> None:
    """Refuse a version or encoding that is not written.

    Raises
    ------
    OutOfRange
        It is none of those allowed.
    """
    if value not in allowed:
        raise OutOfRange(
            Text("DXF files are not written like this.", "このようなDXFは書き出せません。"),
            Text.same(value),
            use_one_of(allowed),
        )


class _Watched(TextIOWrapper):
    """A text file whose writing the user can stop."""

    monitor: Monitor = SilentMonitor()
    _writes = 0

    @override
    def write(self, text: str, /) -> int:
        """Write, and now and then ask whether to go on."""
        self._writes += 1
        if self._writes % _CHECK_WRITES == 0:
            self.monitor.check()
        return super().write(text)
