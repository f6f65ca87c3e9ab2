"""Measurements that are kept are features like all others: whole, or refused in a sentence."""

from __future__ import annotations

from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from tests.widgets.builders import OpenMap
from widgets.mouse_tools.drawing.draw_line import CROSSES
from widgets.mouse_tools.drawing.measure import MEASURED_AREA, MeasureTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import PickedPosition

A, B, C, D = ((0.0, 0.0, 1.0), (10.0, 0.0, 1.0), (10.0, 10.0, 1.0), (0.0, 10.0, 1.0))


class AreasToo(OpenMap):
    """A map whose catalogue has the kind of measured areas."""

    def catalogue(self) -> Catalogue:
        area = next(kind for kind in super().catalogue() if kind.geometry is Geometry.AREA)
        name = Text.same(MEASURED_AREA)
        kind = FeatureKind(**{**vars(area), "id": MEASURED_AREA, "name": name, "key": ""})
        return Catalogue((*super().catalogue().kinds, kind))


def test_a_measured_area_that_crosses_itself_is_not_kept_and_goes_on_once_it_does_not():
    source = AreasToo()
    tool = source.listen_to(MeasureTool(source, source.shared, is_closed=True))
    for position in (A, C, B, D):
        tool.press(Hit(PickedPosition(position)))
    tool.keep()
    assert not source.stored
    assert source.reported[-1].en.startswith(CROSSES.en.split("{", maxsplit=1)[0])
    for _ in range(3):
        tool.step_back()
    for position in (B, C, D):
        tool.press(Hit(PickedPosition(position)))
    tool.keep()
    (kept,) = source.stored.values()
    assert [vertex.xyz for vertex in kept.vertices] == [A, B, C, D]
