"""VertexDrag: a vertex on its way from one measured point to another."""

from __future__ import annotations

from dataclasses import dataclass, replace

from processing.map.feature import Feature, Vertex
from widgets.shared.sketch import Drawing


@dataclass(frozen=True)
class VertexDrag:
    """A feature of which one vertex follows the mouse.

    Attributes
    ----------
    before : Feature
        As stored.
    vertices : tuple of Vertex
        As they are now.
    index : int
        The vertex that follows.
    """

    before: Feature
    vertices: tuple[Vertex, ...]
    index: int

    @staticmethod
    def of_vertex(feature: Feature, index: int) -> VertexDrag:
        """Take hold of a vertex."""
        return VertexDrag(feature, feature.vertices, index)

    @staticmethod
    def of_segment(feature: Feature, segment: int, vertex: Vertex) -> VertexDrag:
        """Put a new vertex into a segment and take hold of it."""
        index = segment + 1
        vertices = (*feature.vertices[:index], vertex, *feature.vertices[index:])
        return VertexDrag(feature, vertices, index)

    def moved_to(self, vertex: Vertex) -> VertexDrag:
        """The same drag with the vertex elsewhere."""
        vertices = (*self.vertices[: self.index], vertex, *self.vertices[self.index + 1 :])
        return replace(self, vertices=vertices)

    @property
    def drawing(self) -> Drawing:
        """What views paint in place of the feature."""
        return Drawing(
            self.before.kind, self.before.geometry, self.vertices, replaces=self.before.id
        )

    @property
    def after(self) -> Feature:
        """What becomes of the feature; equal to ``before`` when nothing moved."""
        return self.before.with_vertices(self.vertices)
