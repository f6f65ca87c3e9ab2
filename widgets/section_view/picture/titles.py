"""What a section is called: the line it stands on, where, how wide, how much exaggerated."""

from __future__ import annotations

from processing.core.text import Language, Text
from widgets.section_view.picture.frame import FrameWords
from widgets.section_view.picture.section_position import SectionPosition
from widgets.shared.map_source import MapSource

_ACROSS = Text("Across {line}", "{line}の横断")
_ALONG = Text("Along {line}", "{line}の縦断")
_TRAJECTORY = Text("the trajectory", "走行軌跡")
_SITE = Text("the site", "現場")
_DRAWN = Text("“{kind}”", "「{kind}」")
_STATION = Text("{m:.2f} m", "{m:.2f} m")
_BEFORE = Text("{m:.2f} m before its beginning", "始点の{m:.2f} m手前")
_BEYOND = Text("{m:.2f} m beyond its end", "終点の{m:.2f} m先")
_WIDTH = Text("{m:g} m wide", "幅 {m:g} m")
_HEIGHTS = Text("heights {factor:g}×", "高さ {factor:g}倍")
_PINNED = Text("Pinned", "固定中")
_EMPTY = Text("no points here", "点がありません")
_LEFT, _RIGHT = Text("◂ left", "◂ 左"), Text("right ▸", "右 ▸")
_BACK, _AHEAD = Text("◂ back", "◂ 手前"), Text("ahead ▸", "前方 ▸")


def line_title(source: MapSource, standing: SectionPosition) -> Text:
    """Across or along which line."""
    named = _ALONG if standing.is_along else _ACROSS
    if standing.line.is_axis:
        return named.filled(line=_SITE)
    feature = source.feature(standing.line.feature) if standing.line.feature else None
    if feature is None:
        return named.filled(line=_TRAJECTORY)
    catalogue = source.catalogue()
    kind = Text.same(feature.kind)
    if feature.kind in catalogue:
        kind = catalogue[feature.kind].name
    return named.filled(line=_DRAWN.filled(kind=kind))


def station_text(standing: SectionPosition) -> Text:
    """Where on the line."""
    beyond_m = standing.beyond_m
    if beyond_m < 0:
        return _BEFORE.filled(m=-beyond_m)
    if beyond_m > 0:
        return _BEYOND.filled(m=beyond_m)
    return _STATION.filled(m=standing.station_m)


def frame_words(
    source: MapSource,
    standing: SectionPosition,
    language: Language,
    *,
    exaggeration: float,
    is_pinned: bool,
    is_empty: bool,
) -> FrameWords:
    """What is written round a section."""
    parts = [
        line_title(source, standing),
        station_text(standing),
        *([_EMPTY] if is_empty else []),
        *([_HEIGHTS.filled(factor=exaggeration)] if exaggeration != 1.0 else []),
        *([_PINNED] if is_pinned else []),
        _WIDTH.filled(m=round(standing.width_m, 2)),
    ]
    left, right = (_BACK, _AHEAD) if standing.is_along else (_LEFT, _RIGHT)
    return FrameWords(
        tuple(part.in_language(language) for part in parts),
        left.in_language(language),
        right.in_language(language),
    )
