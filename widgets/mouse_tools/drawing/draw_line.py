"""DrawLine: lines and rings, click by click: straight, as arcs, as splines or along the cloud."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QObject, Qt
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.heights import set_on_ground
from processing.map.feature import Feature, Vertex
from widgets.mouse_tools.drawing.drawing_tool import LEAST_VERTICES, TOO_FEW, DrawingTool
from widgets.mouse_tools.drawing.legs import (
    DrawnPath,
    InterruptedDrawing,
    Leg,
    LegMode,
    arc_leg,
    spline_leg,
    square_to,
    straight_leg,
)
from widgets.mouse_tools.drawing.path_bend import PathBend, bend_at
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.tracing import BackgroundRunner, TracedLine, tracing_work
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing

CONTINUE = Text("Continue a line", "線の延長")
CROSSES = Text(
    "The area crosses itself near E {east:.2f}, N {north:.2f}; take vertices back (Backspace).",
    "面の境界が E {east:.2f}、N {north:.2f} 付近で交差しています。"
    "頂点を戻してください（Backspace）。",
)
GO_ON = Text(
    "{reason} Click beyond to bridge the gap.",
    "{reason}その先をクリックすると間をつないで続けます。",
)
RESTORED = Text("The drawing is back.", "作図を復元しました。")
DROPPED = Text(
    "The drawing was dropped; Backspace brings it back.",
    "作図を中止しました。Backspaceで元に戻せます。",
)
FOLLOWING = Text("Following the recording…", "点群を追跡しています…")
_LOST = Text("The line could not be followed.", "線を追跡できませんでした。")


class DrawLine(DrawingTool):
    """Every click adds a piece in the way that is set; ways may change from piece to piece.

    Shift holds the direction of the last piece or the one across it. A press near a traced piece
    drags it to where it should pass.

    Parameters
    ----------
    geometry : Geometry
        A line or an area.
    in_background : BackgroundRunner
        Follows the recording in the background.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        geometry: Geometry,
        in_background: BackgroundRunner,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, frozenset({geometry}), parent)
        self._geometry = geometry
        self._in_background = in_background
        self._mode = LegMode.STRAIGHT
        self._path = DrawnPath()
        self._base: Feature | None = None
        self._is_turned = False
        self._dropped: InterruptedDrawing | None = None
        self._asked_for: InterruptedDrawing | None = None
        self._preview: Vertex | None = None
        self._bend: PathBend | None = None
        self._token = 0
        self._is_following = False
        self._bridges = False
        self._completes = False

    @property
    def mode(self) -> LegMode:
        """How the next piece is drawn."""
        return self._mode

    @property
    def is_following(self) -> bool:
        """Whether a piece is just being followed."""
        return self._is_following

    @property
    @override
    def last_vertex(self) -> Vertex | None:
        return self._path.end

    @property
    @override
    def is_busy(self) -> bool:
        return self._path.end is not None

    def set_mode(self, mode: LegMode) -> None:
        """Draw the next pieces in this way."""
        if mode is not self._mode:
            self._mode = mode
            self._path = replace(self._path, pending=())
            self._show()

    def continue_line(self, line: Feature, *, at_start: bool) -> None:
        """Go on drawing a line that is there."""
        self.settle()
        self._base, self._is_turned = line, at_start
        start = line.vertices[::-1] if at_start else line.vertices
        self._path = DrawnPath(start=start)
        self._show()

    @override
    def press(self, hit: Hit) -> None:
        vertex = self._vertex_of(hit)
        if vertex is None or self._is_following:
            return
        if self._path.end is None:
            self._begin(hit, vertex)
            return
        if self._mode is LegMode.TRACE:
            self._bend = bend_at(self._path, vertex, hit.reach_m)
            if self._bend is not None:
                return
        self._add(self._square_vertex(hit, vertex))

    @override
    def move(self, hit: Hit) -> None:
        vertex = hit.as_vertex()
        if self._bend is not None and vertex is not None:
            self._bend = self._bend.moved_to(vertex)
        elif self._path.end is not None:
            self._preview = (
                None if vertex is None else self._square_vertex(hit, vertex, is_final=False)
            )
        self._show()

    @override
    def release(self, hit: Hit) -> None:
        bend, self._bend = self._bend, None
        if bend is None or bend.via is None:
            return
        leg = self._path.legs[bend.leg]
        start = DrawnPath(self._path.start, self._path.legs[: bend.leg]).end
        clicked = bend.clicked_of(leg)
        if start is not None:
            self._follow((start, *clicked), bend.leg)

    @override
    def complete(self) -> None:
        if self._is_following:
            self._completes = True
            return
        vertices = self._path.vertices
        if not vertices:
            return
        if len(vertices) < LEAST_VERTICES[self._geometry]:
            self.reported.emit(TOO_FEW[self._geometry])
            return
        crossing = None
        if self._geometry is Geometry.AREA:
            crossing = crosses_itself([vertex.xyz for vertex in vertices], is_closed=True)
        if crossing is not None:
            self.reported.emit(CROSSES.filled(east=crossing[0], north=crossing[1]))
            return
        self._asked_for = self._interrupted_drawing()
        self._path, self._dropped = DrawnPath(), None
        self._ask_for(vertices)
        self._asked_for = None

    def _ask_for(self, vertices: tuple[Vertex, ...]) -> None:
        base = self._base
        if base is None:
            self._finish(vertices)
            return
        longer = base.with_vertices(vertices[::-1] if self._is_turned else vertices)
        self.put_down()
        if longer != base:
            self.change_requested.emit(CONTINUE, Change(replaced=(Replacement(base, longer),)))

    @override
    def take_back(self) -> None:
        if self._asked_for is not None:
            self._take_up(self._asked_for)
            self._show()

    @override
    def forget(self) -> None:
        super().forget()
        self._dropped = None

    def close(self) -> None:
        """Lead the drawing back to its first vertex and complete it."""
        vertices = self._path.vertices
        if self._geometry is Geometry.LINE and not self._is_following:
            if len(vertices) < LEAST_VERTICES[Geometry.AREA]:
                self.reported.emit(TOO_FEW[Geometry.AREA])
                return
            self._path = self._path.with_leg(straight_leg(vertices[0]))
        self.complete()

    @override
    def step_back(self) -> None:
        if self._is_following:
            self._stop_following()
        elif self._path.end is None and self._dropped is not None:
            self._take_up(self._dropped)
            self.reported.emit(RESTORED)
        elif self._base is None or self._path.legs or self._path.pending:
            self._path = self._path.without_last()
        self._bridges = False
        self._show()

    @override
    def leave(self) -> None:
        was_busy = self.is_busy
        super().leave()
        if was_busy and self._dropped is not None:
            self.reported.emit(DROPPED)

    @override
    def settle(self) -> None:
        if self._is_following:
            self._stop_following()
        if len(self._path.vertices) >= LEAST_VERTICES[self._geometry]:
            self.complete()
        self.put_down()

    @override
    def put_down(self) -> None:
        self._stop_following()
        if len(self._path.vertices) > 1 and (self._base is None or self._path.legs):
            self._dropped = self._interrupted_drawing()
        self._path, self._preview, self._bend, self._base = DrawnPath(), None, None, None
        self._is_turned = self._bridges = self._completes = False
        self._show()

    def _interrupted_drawing(self) -> InterruptedDrawing:
        return InterruptedDrawing(self._path, self._base, self._is_turned)

    def _take_up(self, drawn: InterruptedDrawing) -> None:
        path, base, is_turned = drawn.path, drawn.base, drawn.is_turned
        if base is not None and self._source.feature(base.id) != base:
            # The line it continued is another one now: what was added is a line of its own.
            path, base, is_turned = replace(path, start=path.start[-1:]), None, False
        self._path, self._base, self._is_turned = path, base, is_turned
        self._dropped = None

    # How pieces come about.

    def _begin(self, hit: Hit, vertex: Vertex) -> None:
        line = self._source.feature(hit.feature) if hit.feature else None
        if (
            line is not None
            and line.id in self._shared.selection.features
            and self._geometry is Geometry.LINE
            and line.geometry is Geometry.LINE
            and hit.vertex in (0, len(line.vertices) - 1)
        ):
            self.continue_line(line, at_start=hit.vertex == 0)
            return
        self._path, self._dropped = DrawnPath(start=(vertex,)), None
        self._show()

    def _add(self, vertex: Vertex) -> None:
        path, start = self._path, self._path.end
        # Where a view sends both presses of a double click, the second one adds nothing.
        if start is None or vertex.xyz in (start.xyz, *(one.xyz for one in path.pending)):
            return
        if vertex.xyz == path.start[0].xyz and len(path.vertices) > 2:
            self.close()
            return
        if self._mode is LegMode.TRACE:
            self._follow((start, vertex), len(path.legs))
            return
        if self._mode is LegMode.ARC and not path.pending:
            self._path = path.with_pending(vertex)
        else:
            self._path = self._extend_path(path, start, vertex, is_final=True)
        self._show()

    def _extend_path(
        self, path: DrawnPath, start: Vertex, vertex: Vertex, *, is_final: bool
    ) -> DrawnPath:
        """The path with one more click; curves get their heights from the points at last."""
        if self._mode is LegMode.ARC and path.pending:
            leg = arc_leg(start, path.pending[-1], vertex)
        elif self._mode is LegMode.SPLINE:
            clicked: tuple[Vertex, ...] = (vertex,)
            if path.legs and path.legs[-1].mode is LegMode.SPLINE:
                clicked = (*path.legs[-1].clicked, vertex)
                path = replace(path, legs=path.legs[:-1])
                start = path.end or start
            leg = spline_leg(start, clicked)
        else:
            leg = straight_leg(vertex)
        return path.with_leg(self._on_ground(leg) if is_final else leg)

    def _on_ground(self, leg: Leg) -> Leg:
        clicked = set(leg.clicked)
        between = [vertex for vertex in leg.vertices if vertex not in clicked]
        if not between:
            return leg
        ground = iter(set_on_ground([one.xyz for one in between], self._source.drives()))
        vertices = tuple(one if one in clicked else next(ground) for one in leg.vertices)
        return replace(leg, vertices=vertices)

    def _square_vertex(self, hit: Hit, vertex: Vertex, *, is_final: bool = True) -> Vertex:
        """The vertex, or with Shift the place straight on or across."""
        vertices = self._path.vertices
        if not hit.modifiers & Qt.KeyboardModifier.ShiftModifier or len(vertices) < 2:
            return vertex
        position = square_to(vertices[-2], vertices[-1], vertex.xyz)
        return (
            set_on_ground((position,), self._source.drives())[0] if is_final else Vertex(position)
        )

    # Following the recording.

    def _follow(self, through: tuple[Vertex, ...], leg: int) -> None:
        work = tracing_work(self._source, through, across_gaps=self._bridges)
        if work is None:
            self._path = self._path.with_leg(straight_leg(through[-1]))
            self._show()
            return
        self._token += 1
        self._is_following = True
        self.reported.emit(FOLLOWING)
        self._in_background(
            work, self._taker(self._token, leg, through[1:], must_arrive=self._bridges)
        )
        self._show()

    def _taker(
        self, token: int, leg: int, clicked: tuple[Vertex, ...], *, must_arrive: bool
    ) -> Callable[[object | None], None]:
        def take(result: object | None) -> None:
            if token != self._token or not self._is_following:
                return
            self._is_following = False
            if isinstance(result, TracedLine):
                arrived = result.going_straight_to(clicked[-1]) if must_arrive else result
                self._on_followed(leg, clicked, arrived)
            else:
                self.reported.emit(_LOST)
                self._show()

        return take

    def _on_followed(self, leg: int, clicked: tuple[Vertex, ...], result: TracedLine) -> None:
        self._bridges = not result.is_complete
        if result.vertices:
            last = clicked[-1] if result.is_complete else result.vertices[-1]
            vertices = (*result.vertices[:-1], last)
            traced = Leg(LegMode.TRACE, (*clicked[:-1], last), vertices)
            self._path = replace(self._path, legs=(*self._path.legs[:leg], traced))
        self.reported.emit(
            result.reason if result.is_complete else GO_ON.filled(reason=result.reason)
        )
        self._preview = None
        self._show()
        if self._completes:
            self._completes = False
            if result.is_complete:
                self.complete()

    def _stop_following(self) -> None:
        self._token += 1
        self._is_following = False

    @override
    def _show(self) -> None:
        path, kind, end = self._path, self._kind, self._path.end
        if end is None or kind is None:
            self._sketch.show(None)
            return
        if self._bend is not None and self._bend.via is not None:
            path = self._bend.shown_in(path)
        shown, preview = path.vertices, self._preview
        coming: tuple[Vertex, ...] = ()
        if preview is not None and self._bend is None and not self._is_following:
            grown = self._extend_path(path, end, preview, is_final=False)
            kept = len(path.vertices)
            if self._mode is LegMode.SPLINE and path.legs and path.legs[-1].mode is LegMode.SPLINE:
                kept -= len(path.legs[-1].vertices)
            shown, coming = grown.vertices[:kept], grown.vertices[kept:]
        shown += path.pending if not coming else ()
        replaced = "" if self._base is None else self._base.id
        self._sketch.show(Drawing(kind.id, self._geometry, shown, coming, replaced))
