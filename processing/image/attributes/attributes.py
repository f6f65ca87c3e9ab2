"""What a pixel shows: the eight attributes of Takahashi 2022, figure 3-8, and judgements."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Colours
from processing.core.errors import Unsuitable, UserError
from processing.core.text import Text
from processing.image.attributes.colour_maps import (
    EMPTY_COLOUR,
    SHAPE_COLOURS,
    UNKNOWN_COLOUR,
    class_colours,
    confidence_ramp,
    error_map_colours,
    grey_ramp,
    height_ramp,
    normal_ramp,
    segment_colours,
    stretch_values,
)
from processing.image.attributes.drive_sample import value_at_percent
from processing.image.attributes.toned_intensity import toned_intensity
from processing.image.attributes.waveform_values import (
    BACKSCATTER,
    WAVEFORM_ATTRIBUTES,
    waveform_ends,
    waveform_values,
)
from processing.image.images_of_drives import image_of
from processing.image.neighbourhoods.normals import RowLayout, SurfaceShapes, surface_shapes
from processing.recording.camera_images.colouring import colours_from_images
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.error_map import ERROR_MAP
from processing.recording.columns.ordering import read_chunk
from processing.recording.columns.point_features import POINT_FEATURES
from processing.recording.kinds import ImageKind
from processing.recording.waveform_packets.descriptors import WAVE_COLUMNS

if TYPE_CHECKING:  # Drive makes its images, so importing it here would be a circle
    from processing.recording.drive import Drive

SHOWN_RADIUS_M = 0.2
"""Neighbourhood of normals and shapes that are made for the screen: wider than rows are apart,
narrower than a kerb is wide."""

CONFIDENCE = "confidence"
"""The column that the tool “Classes” makes beside the classes."""

_UNLABELLED_GREYS = 64, 191
"""The darkest and the brightest point without a label: black and white are left to classes."""

_Points = NDArray[np.int64]


@dataclass(frozen=True)
class Attribute:
    """One way to colour points.

    Attributes
    ----------
    needs : tuple of str
        Columns that a drive must have to be shown so.
    missing : Text
        What to do where they are missing.
    """

    id: str
    title: Text
    needs: tuple[str, ...] = ()
    missing: Text = Text("", "")


_NO_FEATURE = Text(
    "Run the tool “Features of points” on this drive first.",
    "先にこの走行データで「点群特徴量」を実行してください。",
)

_NO_WAVEFORMS = Text(
    "Import point files with waveforms (LAS point formats 4, 5, 9 and 10).",
    "波形付きの点群ファイル（LAS点フォーマット4・5・9・10）をインポートしてください。",
)
_NO_RANGE = Text(
    "Add the flight's trajectory: the range to each point is needed.",
    "各点までの距離が必要です。走行軌跡ファイルを追加してください。",
)

ATTRIBUTES: Mapping[str, Attribute] = {
    attribute.id: attribute
    for attribute in (
        Attribute("intensity", Text("Intensity", "反射強度"), ("intensity",)),
        Attribute("toned", Text("Intensity, toned", "反射強度（階調補正）"), ("intensity", "xyz")),
        Attribute("height", Text("Height", "高さ"), ("xyz",)),
        Attribute("relief", Text("Height and intensity", "高さと反射強度"), ("xyz", "intensity")),
        Attribute("normal", Text("Normal direction", "法線方向"), ("xyz",)),
        Attribute("shape", Text("Shape", "形状"), ("xyz",)),
        Attribute(
            "segment",
            Text("Segment", "セグメント"),
            ("segment",),
            Text(
                "Run the tool “Segments” on this drive first.",
                "先にこの走行データで「セグメント分割」を実行してください。",
            ),
        ),
        Attribute("color", Text("Colour", "色")),
        Attribute(
            "label",
            Text("Label by hand", "手動ラベル"),
            ("intensity",),
        ),
        Attribute("class", Text("Class", "クラス"), ("classification",)),
        Attribute(
            CONFIDENCE,
            Text("Confidence of the class", "クラスの信頼度"),
            (CONFIDENCE,),
            Text(
                "Run the tool “Classes” on this drive first.",
                "先にこの走行データで「点群の分類」を実行してください。",
            ),
        ),
        Attribute(
            "judged",
            Text("Right and wrong", "正誤"),
            (ERROR_MAP,),
            Text(
                "Show the points of a run in the evaluation first.",
                "先に評価パネルで実行結果の正誤を表示してください。",
            ),
        ),
        *(
            Attribute(column.id, column.title, (column.id,), _NO_FEATURE)
            for column in POINT_FEATURES.values()
        ),
        *(
            Attribute(one.id, one.title, WAVE_COLUMNS, _NO_WAVEFORMS)
            for one in WAVEFORM_ATTRIBUTES.values()
        ),
    )
}
"""By id, those of the thesis first, in its order; then features of points, then waveforms."""

SHOWS_LABELS = frozenset({"label", "class", "judged"})
"""Attributes that show what was painted, or found by a tool that classifies."""

SHOWS_INTENSITY = frozenset({"intensity", "toned"})
"""Attributes that show how bright points are, in greys."""


def colours(
    drive: Drive, points: _Points, attribute: str, low_percent: float, high_percent: float
) -> Colours:
    """Colours of points.

    Parameters
    ----------
    points : (…) int64
        Of any shape; −1 is an empty pixel.
    attribute : str
        A key of `ATTRIBUTES`.
    low_percent, high_percent : float
        Percentiles of the drive at the dark and the bright end; of intensity, which labels lie on
        too, of height, of features and of waveforms only.

    Returns
    -------
    (…, 3) uint8

    Raises
    ------
    Unsuitable
        The drive lacks what the attribute needs.
    KeyError
        There is no such attribute.
    """
    _check(drive, ATTRIBUTES[attribute])
    flat = points.ravel()
    is_filled = flat >= 0
    shown = np.empty((flat.size, 3), np.uint8)
    shown[~is_filled] = EMPTY_COLOUR
    filled = flat[is_filled]
    if attribute in POINT_FEATURES or attribute in WAVEFORM_ATTRIBUTES:
        shown[is_filled] = _feature(drive, attribute, filled, (low_percent, high_percent))
    elif attribute in _STRETCHED:
        shown[is_filled] = _STRETCHED[attribute](drive, filled, low_percent, high_percent)
    else:
        shown[is_filled] = _PLAIN[attribute](drive, filled)
    return shown.reshape(*points.shape, 3)


def available(drive: Drive) -> tuple[str, ...]:
    """Ids of the attributes that a drive can be shown by."""
    return tuple(
        name
        for name, attribute in ATTRIBUTES.items()
        if not (_lacks(drive, attribute) or (name == "class" and not _is_classified(drive)))
    )


def most_telling_attribute(drive: Drive, wanted: str) -> str:
    """What a drive is shown by: what is wanted, unless it lacks that or is the same everywhere.

    Colour-only clouds have an intensity of 0 throughout; others have nothing but their shape.
    """
    ways = (wanted, *(name for name in _TELLING if name != wanted))
    names = available(drive)
    return next((name for name in ways if name in names and _varies(drive, name)), "height")


_TELLING = ("intensity", "color", "height")
_LEAST_LIGHT = 0.35
"""Of a colour of heights where nothing came back: its hue can still be told."""

_PIECES, _PIECE_POINTS = 16, 512
"""Pieces of a column that are looked at for whether it says anything: spread over the drive, read
in a moment."""

_CHUNK_POINTS = 8_000_000
"""Points whose classes are all read: 8 MB of codes, some milliseconds."""

_UNCLASSIFIED = 1
_CLASS_PIECES, _CLASS_PIECE_POINTS = 512, 8_192
"""Pieces of longer recordings: four million points in all. A class that one point in a hundred
thousand has, wherever they lie, is met by some forty of them."""
"""Codes up to this say nothing: 0 never classified, 1 unclassified (LAS 1.4)."""


def _varies(drive: Drive, attribute: str) -> bool:
    """Whether a column as delivered holds more than one value; others are taken to."""
    column = "intensity" if attribute in SHOWS_INTENSITY else attribute
    if column not in ("intensity", "color") or not drive.columns.has(column):
        return True
    try:
        return _varies_in(drive.folder, column, drive.count)
    except UserError:  # said where its points are shown
        return True


@lru_cache(maxsize=256)
def _varies_in(folder: Path, attribute: str, count: int) -> bool:
    first = read_chunk(folder, attribute, 0, 1)
    starts = np.linspace(0, max(0, count - _PIECE_POINTS), _PIECES).astype(np.int64)
    pieces = (
        read_chunk(folder, attribute, start, start + _PIECE_POINTS) for start in starts.tolist()
    )
    return any((piece != first).any() for piece in pieces)


def _is_classified(drive: Drive) -> bool:
    """Whether a point has a class, by hand, by a tool or as delivered; 0 and 1 are none."""
    try:
        return drive.columns.has("label") or _has_classes(drive.folder, drive.count)
    except UserError:  # said where its points are shown
        return True


@lru_cache(maxsize=256)
def _has_classes(folder: Path, count: int) -> bool:
    """Whether a delivered class is above 1; as delivered, a column never changes.

    Of long recordings pieces are looked at, spread evenly, since a window waits for the answer.
    """
    length = min(count, _CHUNK_POINTS if count <= _CHUNK_POINTS else _CLASS_PIECE_POINTS)
    pieces = 1 if length == count else _CLASS_PIECES
    starts = np.linspace(0, count - length, pieces).astype(np.int64)
    return any(
        (read_chunk(folder, "classification", start, start + length) > _UNCLASSIFIED).any()
        for start in starts.tolist()
    )


def _lacks(drive: Drive, attribute: Attribute) -> bool:
    if attribute.id == "color":
        has_colours = drive.columns.has("color") or drive.columns.has("seen_color")
        return not has_colours and not drive.images
    if attribute.id == BACKSCATTER and drive.trajectory is None:
        return True
    return not all(drive.columns.has(name) for name in attribute.needs)


def _check(drive: Drive, attribute: Attribute) -> None:
    if not _lacks(drive, attribute):
        return
    remedy = attribute.missing
    if attribute.id == BACKSCATTER and drive.columns.has(WAVE_COLUMNS[0]):
        remedy = _NO_RANGE
    if attribute.id == "color":
        remedy = Text(
            "Import camera images with this drive, or points that have colours.",
            "この走行データと一緒にカメラ画像を、または色付きの点群をインポートしてください。",
        )
    raise Unsuitable(
        Text("The points have no “{title}” yet.", "点に「{title}」の情報がありません。").filled(
            title=attribute.title
        ),
        Text.same(drive.info.name),
        remedy,
    )


def _intensity(drive: Drive, points: _Points, low: float, high: float) -> Colours:
    ends = [
        value_at_percent(drive.folder, "intensity", drive.count, None, percent)
        for percent in (low, high)
    ]
    values = np.asarray(drive.columns["intensity"][points], np.float32)
    return grey_ramp()[stretch_values(values, *ends)]


def _toned(drive: Drive, points: _Points, low: float, high: float) -> Colours:
    return grey_ramp()[toned_intensity(drive, points, low, high)]


def _relief(drive: Drive, points: _Points, low: float, high: float) -> Colours:
    """The colours of heights, lighter and darker by intensity."""
    light = toned_intensity(drive, points, low, high).astype(np.float32) / np.float32(255)
    share = _LEAST_LIGHT + (1 - _LEAST_LIGHT) * light
    return np.asarray(_height(drive, points, low, high) * share[..., None], dtype=np.uint8)


def _height(drive: Drive, points: _Points, low: float, high: float) -> Colours:
    ends = _height_ends(drive, (low, high))
    values = np.asarray(drive.coordinates.integers(points)[..., 2], np.float64)
    return height_ramp()[stretch_values(values, *ends)]


def height_ends_m(drive: Drive, percents: tuple[float, float]) -> tuple[float, float]:
    """The heights, m, at the ends of the colours of heights."""
    low, high = _height_ends(drive, percents)
    scale, offset = drive.info.scale[2], drive.info.offset[2]
    return low * scale + offset, high * scale + offset


def _height_ends(drive: Drive, percents: tuple[float, float]) -> tuple[float, float]:
    low, high = (
        value_at_percent(drive.folder, "xyz", drive.count, 2, percent) for percent in percents
    )
    return low, high


def _feature(drive: Drive, name: str, points: _Points, percents: tuple[float, float]) -> Colours:
    """From low to high as heights are; grey where it isn't known."""
    if name in WAVEFORM_ATTRIBUTES:
        ends = list(waveform_ends(drive, name, percents))
        values = waveform_values(drive, name, points)
    else:
        ends = [value_at_percent(drive.folder, name, drive.count, None, one) for one in percents]
        values = np.asarray(drive.columns[name][points], np.float64)
    is_known = np.isfinite(values)
    shown = np.array(height_ramp()[stretch_values(np.where(is_known, values, ends[0]), *ends)])
    shown[~is_known] = UNKNOWN_COLOUR
    return shown


def _normal(drive: Drive, points: _Points) -> Colours:
    if drive.columns.has("normal"):
        normals = np.asarray(drive.columns["normal"][points], np.float32) / np.float32(127)
    else:
        normals = _surfaces(drive, points).normals
    shown = normal_ramp()[stretch_values(np.abs(normals[:, 2]), 0.0, 1.0)]
    shown[~normals.any(axis=1)] = UNKNOWN_COLOUR
    return shown


def _shape(drive: Drive, points: _Points) -> Colours:
    if drive.columns.has("shape"):
        shapes = np.asarray(drive.columns["shape"][points], dtype=np.uint8)
    else:
        shapes = np.rint(_surfaces(drive, points).shapes * 255).astype(np.uint8)
    shares = shapes / np.maximum(shapes.sum(axis=1, dtype=np.float32), 1.0)[:, None]
    shown: Colours = np.rint(shares @ np.array(SHAPE_COLOURS, np.float32)).astype(np.uint8)
    shown[~shapes.any(axis=1)] = UNKNOWN_COLOUR
    return shown


def _surfaces(drive: Drive, points: _Points) -> SurfaceShapes:
    image = image_of(drive, drive.pixel_kind)
    pulses, row_starts, doubled_origins = image.layout[:3]
    layout = RowLayout(
        pulses,
        row_starts,
        doubled_origins // 2,
        image.segments,
        is_regular=image.kind is not ImageKind.TOP_VIEW,
    )
    coordinates = drive.coordinates
    return surface_shapes(
        coordinates.delivered, coordinates.quantisation.scale, layout, points, SHOWN_RADIUS_M
    )


def _segment(drive: Drive, points: _Points) -> Colours:
    return segment_colours(drive.columns["segment"][points])


def _color(drive: Drive, points: _Points) -> Colours:
    """What the tool “colour” saw; elsewhere the delivered colours, or those of the images."""
    if not (drive.columns.has("seen_color") and drive.columns.has("is_seen")):
        return _other_color(drive, points)
    shown = np.array(drive.columns["seen_color"][points], dtype=np.uint8)
    is_seen = drive.columns["is_seen"][points] > 0
    if is_seen.all():
        return shown
    has_delivered = drive.columns.has("color")
    unseen = points[~is_seen]
    shown[~is_seen] = _other_color(drive, unseen) if has_delivered else UNKNOWN_COLOUR
    return shown


def _other_color(drive: Drive, points: _Points) -> Colours:
    if drive.columns.has("color"):
        # Some deliveries fill only the lower eight of the sixteen bits.
        brightest = max(
            value_at_percent(drive.folder, "color", drive.count, axis, 100.0) for axis in range(3)
        )
        return (drive.columns["color"][points] >> (8 if brightest > 255 else 0)).astype(np.uint8)
    if drive.images is None:
        message = "a drive without images was not refused"
        raise RuntimeError(message)
    seen = colours_from_images(drive.xyz(points), drive.columns["time"][points], drive.images)
    seen.colours[~seen.is_seen] = UNKNOWN_COLOUR
    return seen.colours


def _label(drive: Drive, points: _Points, low: float, high: float) -> Colours:
    """Colours of classes over the intensity, so that one sees the street while painting."""
    dark, bright = _UNLABELLED_GREYS
    grey = _intensity(drive, points, low, high).astype(np.uint16)
    shown = (dark + grey * (bright - dark) // 255).astype(np.uint8)
    if drive.columns.has("label"):
        labels = drive.columns["label"][points]
        is_labelled = labels > 0
        shown[is_labelled] = class_colours()[labels[is_labelled]]
    return shown


def _colour_judged(drive: Drive, points: _Points) -> Colours:
    return np.asarray(error_map_colours()[drive.columns[ERROR_MAP][points]])


def _confidence(drive: Drive, points: _Points) -> Colours:
    """How sure the class is; grey where no class was asked for, as for noise."""
    confidence = np.asarray(drive.columns[CONFIDENCE][points], np.float32)
    shown = np.array(confidence_ramp()[stretch_values(confidence, 0.0, 1.0)])
    shown[confidence <= 0.0] = UNKNOWN_COLOUR
    return shown


def _class(drive: Drive, points: _Points) -> Colours:
    """What counts: labels, by hand or by a tool, over the delivered classes."""
    return np.asarray(class_colours()[class_columns(drive.columns).codes_of(points)])


_STRETCHED: Mapping[str, Callable[[Drive, _Points, float, float], Colours]] = {
    "intensity": _intensity,
    "toned": _toned,
    "relief": _relief,
    "height": _height,
    "label": _label,
}
_PLAIN: Mapping[str, Callable[[Drive, _Points], Colours]] = {
    "normal": _normal,
    "shape": _shape,
    "segment": _segment,
    "color": _color,
    "class": _class,
    CONFIDENCE: _confidence,
    "judged": _colour_judged,
}
