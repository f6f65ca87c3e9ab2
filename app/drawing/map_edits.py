"""Edits of what is chosen, asked for by the menu: each becomes one change of the map."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from PySide6.QtGui import QGuiApplication

from app.document.document import Document
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.vectors.feature_clips import clip_of, features_of_clip
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.drafting.line_edits import reverse_line, simplify_line
from processing.map.drafting.line_joins import join
from processing.map.drafting.measuring import Width, width_between
from processing.map.feature import Feature, Status, Vertex, new_feature_id
from processing.map.routes.centre_lines import centre_lines
from processing.map.routes.numbering import number_along_routes
from processing.map.routes.route import PITCH_M, routes_of
from processing.map.routes.width_lines import width_lines
from processing.methods.road.surface.road_frame import driven_lines
from processing.operations.map_steps import (
    ALL_NUMBERED,
    CENTRE_LINES_DRAWN,
    CENTRE_LINES_LABEL,
    NO_CENTRE_LINE,
    NO_EDGES,
    NO_WIDTHS,
    NUMBER_LABEL,
    NUMBERED,
    WIDTHS_DRAWN,
    WIDTHS_LABEL,
)
from widgets.mouse_tools.drawing.measure import KEEP, MEASUREMENT, NO_SUCH_KIND
from widgets.mouse_tools.removal import removal_of

NOTHING_CHOSEN = Text("Choose features first.", "先に地物を選択してください。")
NO_LINES = Text("Choose lines or areas first.", "先に線または面を選択してください。")
COPIED = Text("Copied {count} features.", "{count}個の地物をコピーしました。")
PASTE = Text("Paste {count} features", "{count}個の地物の貼り付け")

TWO_LINES = Text("Choose two lines first.", "先に線を2本選択してください。")
WIDTH = Text(
    "Width {mean:.3f} m on average, from {least:.3f} to {greatest:.3f} m",
    "幅 平均{mean:.3f} m（最小{least:.3f} m、最大{greatest:.3f} m）",
)
_FEWEST_OF_RING = 3
_NO_PASTE = Text("There is nothing to paste.", "貼り付けるものがありません。")


class MapEdits:
    """What the edit menu does with the chosen features of a document.

    Parameters
    ----------
    document : Document
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._selection = document.shared.selection

    @property
    def chosen(self) -> tuple[Feature, ...]:
        """The chosen features in the order of the map."""
        ids = self._selection.features
        return tuple(feature for feature in self._document.features() if feature.id in ids)

    def delete(self) -> None:
        """Remove what is chosen."""
        chosen = self._need_selection()
        if chosen:
            self._document.apply(*removal_of(chosen))

    def reverse(self) -> None:
        """Turn lines round."""
        self._each(
            Text("Reverse {count} lines", "{count}本の線の向きを反転"), reverse_line, Geometry.LINE
        )

    def simplify(self, tolerance_m: float) -> None:
        """Take out vertices that a straight line replaces within a tolerance."""
        label = Text("Simplify to {tolerance} m", "単純化（許容値{tolerance} m）").filled(
            tolerance=tolerance_m
        )
        self._each(
            label, lambda feature: simplify_line(feature, tolerance_m), Geometry.LINE, Geometry.AREA
        )

    def close(self) -> None:
        """Lead lines back to their first vertex."""
        self._each(Text("Close {count} lines", "{count}本の線を閉合"), _close_line, Geometry.LINE)

    def open(self) -> None:
        """Open closed lines at their first vertex."""
        self._each(Text("Open {count} lines", "{count}本の線を開く"), _open_line, Geometry.LINE)

    def join(self) -> None:
        """Make one line of the chosen ones."""
        lines = [feature for feature in self.chosen if feature.geometry is Geometry.LINE]
        if len(lines) < 2:
            self._document.reported.emit(
                Text("Choose at least two lines.", "線を2本以上選択してください。")
            )
            return
        try:
            joined = join(lines)
        except UserError as refusal:
            self._document.refused.emit(refusal)
            return
        first = next(line for line in lines if line.id == joined.id)
        rest = tuple(line for line in lines if line.id != joined.id)
        label = Text("Join {count} lines", "{count}本の線を結合").filled(count=len(lines))
        self._document.apply(label, Change(replaced=(Replacement(first, joined),), removed=rest))

    def set_status(self, status: Status, name: Text) -> None:
        """Accept, reject or doubt what is chosen."""
        self._each(
            # How many they are is known, and filled in, once they are changed.
            Text("{name}: {count} features", "{name}: {count}個の地物").filled(
                name=name, count="{count}"
            ),
            lambda feature: feature.with_status(status),
            *Geometry,
        )

    def number_along_routes(self) -> None:
        """Fill in numbers, routes, stations and sides of what ledgers list."""
        document = self._document
        features, catalogue = tuple(document.features()), document.catalogue()
        if not routes_of(features, catalogue):
            document.reported.emit(NO_CENTRE_LINE)
            return
        change = number_along_routes(features, catalogue)
        if change.is_empty:
            document.reported.emit(ALL_NUMBERED)
            return
        count = len(change.replaced)
        document.apply(NUMBER_LABEL.filled(count=f"{count:,}"), change)
        document.reported.emit(NUMBERED.filled(count=f"{count:,}"))

    def draw_widths(self) -> None:
        """Draw how wide roads are across them, at their stations and where it changes."""
        document = self._document
        features, catalogue = tuple(document.features()), document.catalogue()
        if not routes_of(features, catalogue):
            document.reported.emit(NO_CENTRE_LINE)
            return
        change = width_lines(features, catalogue, PITCH_M)
        if change.is_empty:
            document.reported.emit(NO_WIDTHS)
            return
        count = f"{len(change.added):,}"
        document.apply(WIDTHS_LABEL.filled(count=count), change)
        document.reported.emit(WIDTHS_DRAWN.filled(count=count))

    def draw_centre_lines(self) -> None:
        """Draw centre lines midway between the edges of the roads that were driven."""
        document = self._document
        ways = driven_lines(document.drives())
        change = centre_lines(tuple(document.features()), document.catalogue(), ways)
        if change.is_empty:
            document.reported.emit(NO_EDGES)
            return
        count = f"{len(change.added):,}"
        document.apply(CENTRE_LINES_LABEL.filled(count=count), change)
        document.reported.emit(CENTRE_LINES_DRAWN.filled(count=count))

    def copy(self) -> None:
        """Put what is chosen on the clipboard, for this or any other project."""
        chosen = self._need_selection()
        if chosen:
            text = clip_of(chosen, self._document.crs(), self._document.catalogue())
            QGuiApplication.clipboard().setText(text)
            self._document.reported.emit(COPIED.filled(count=len(chosen)))

    def cut(self) -> None:
        """Copy what is chosen, then remove it."""
        if self.chosen:
            self.copy()
            self.delete()

    def paste(self) -> None:
        """Add what is on the clipboard; it is chosen then."""
        text = QGuiApplication.clipboard().text()
        if not text.strip():
            self._document.reported.emit(_NO_PASTE)
            return
        document = self._document
        drives = [drive.id for drive in document.drives()]
        try:
            pasted = features_of_clip(
                text, document.crs(), document.catalogue(), drives, kind_for=self._kind_for()
            )
        except UserError as refusal:
            document.refused.emit(refusal)
            return
        label = PASTE.filled(count=len(pasted.features))
        if document.apply(label, Change(added=pasted.features)):
            self._selection.choose_features(frozenset(one.id for one in pasted.features))
            for note in pasted.notes:
                document.reported.emit(note)

    def report_width(self) -> tuple[list[Feature], Width] | None:
        """Say how wide it is between the two chosen lines; gives both, None where it can't."""
        lines = [feature for feature in self.chosen if feature.geometry is Geometry.LINE]
        if len(lines) != 2:
            self._document.reported.emit(TWO_LINES)
            return None
        one, other = ([vertex.xyz for vertex in line.vertices] for line in lines)
        try:
            width = width_between(one, other)
        except UserError as refusal:
            self._document.refused.emit(refusal)
            return None
        said = WIDTH.filled(least=width.least_m, mean=width.mean_m, greatest=width.greatest_m)
        self._document.reported.emit(said)
        return lines, width

    def keep_width(self) -> None:
        """Keep the mean width between the two chosen lines as a measurement across them."""
        found = self.report_width()
        catalogue = self._document.catalogue()
        if found is None:
            return
        if MEASUREMENT not in catalogue:
            self._document.reported.emit(NO_SUCH_KIND.filled(name=MEASUREMENT))
            return
        (one, other), width = found
        across = _nearest_vertices(one, other)
        attributes = {"width_m": round(width.mean_m, 3)}
        feature = Feature(new_feature_id(), MEASUREMENT, Geometry.LINE, across, attributes)
        self._document.apply(KEEP, Change(added=(feature,)))

    def select_like(self, alike: Callable[[Feature, Feature], bool]) -> None:
        """Choose all shown features that are like one of the chosen."""
        chosen = self._need_selection()
        hidden = self._document.shared.view_settings.hidden_kinds
        # Few kinds of likeness among many chosen: each one is compared once.
        samples: list[Feature] = []
        for one in chosen:
            if not any(alike(one, sample) for sample in samples):
                samples.append(one)
        self._choose(
            feature
            for feature in self._document.features()
            if feature.kind not in hidden and any(alike(feature, sample) for sample in samples)
        )

    def select_all(self) -> None:
        """Choose all shown features."""
        hidden = self._document.shared.view_settings.hidden_kinds
        self._choose(one for one in self._document.features() if one.kind not in hidden)

    def select_occluded(self) -> None:
        """Choose the features that have vertices without a measured point."""
        self._choose(
            feature
            for feature in self._document.features()
            if any(vertex.is_occluded for vertex in feature.vertices)
        )

    def _kind_for(self) -> dict[Geometry, str]:
        """As what plain geometries are pasted: the first kind of each shape."""
        kinds: dict[Geometry, str] = {}
        for kind in self._document.catalogue():
            kinds.setdefault(kind.geometry, kind.id)
        return kinds

    def _choose(self, features: Iterable[Feature]) -> None:
        self._selection.choose_features(frozenset(feature.id for feature in features))

    def _need_selection(self) -> tuple[Feature, ...]:
        chosen = self.chosen
        if not chosen:
            self._document.reported.emit(NOTHING_CHOSEN)
        return chosen

    def _each(self, label: Text, edit: Callable[[Feature], Feature], *geometries: Geometry) -> None:
        """Do the same with all chosen features of some shapes, as one step."""
        chosen = [feature for feature in self.chosen if feature.geometry in geometries]
        if not chosen:
            self._document.reported.emit(NO_LINES if self.chosen else NOTHING_CHOSEN)
            return
        try:
            pairs = [Replacement(feature, edit(feature)) for feature in chosen]
        except UserError as refusal:
            self._document.refused.emit(refusal)
            return
        changed = tuple(pair for pair in pairs if pair.before != pair.after)
        if not changed:
            self._document.reported.emit(Text("Nothing changes.", "変更はありません。"))
            return
        self._document.apply(label.filled(count=len(changed)), Change(replaced=changed))


def _nearest_vertices(one: Feature, other: Feature) -> tuple[Vertex, Vertex]:
    """The vertex in the middle of a line, and the one of the other line nearest to it."""
    middle = one.vertices[len(one.vertices) // 2]
    return middle, min(other.vertices, key=lambda vertex: math.dist(vertex.xyz, middle.xyz))


def _close_line(line: Feature) -> Feature:
    """The line led back to its first vertex; one of two vertices stays as it is."""
    is_open = line.vertices[-1].xyz != line.vertices[0].xyz
    if not is_open or len(line.vertices) < _FEWEST_OF_RING:
        return line
    return line.with_vertices((*line.vertices, line.vertices[0]))


def _open_line(line: Feature) -> Feature:
    """The line without the piece that leads back."""
    is_closed = line.vertices[-1].xyz == line.vertices[0].xyz
    if not is_closed or len(line.vertices) <= _FEWEST_OF_RING:
        return line
    return line.with_vertices(line.vertices[:-1])
