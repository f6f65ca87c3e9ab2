"""WindowParts: everything that one window consists of, handed over together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TypeVar

from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.layout.view_docks import ViewDocks
from app.settings.settings import Settings
from app.settings.theme import Theme
from app.window.main_window import MainWindow
from processing.core.text import Language
from widgets.camera_view.panel import CameraPanel
from widgets.camera_view.view import CameraView
from widgets.image_view.side_by_side import ImageViews
from widgets.image_view.view import ImageView
from widgets.map_view.view import MapView
from widgets.mouse_tools.drawing.toolbox import MouseToolbox
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.class_evaluation.class_panel import ClassPanel
from widgets.panels.class_evaluation.study_panel import StudyPanel
from widgets.panels.jobs_panel import JobsPanel
from widgets.panels.processing.processing_panel import ProcessingPanel
from widgets.panels.project.label_panel import LabelPanel
from widgets.panels.project.layers_panel import LayersPanel
from widgets.panels.project.project_tree import ProjectTree
from widgets.panels.quality.quality_panel import QualityPanel
from widgets.panels.review.evaluation_panel import EvaluationPanel
from widgets.panels.review.review_panel import ReviewPanel
from widgets.panels.table.feature_table import FeatureTable
from widgets.panels.templates.template_panel import TemplatePanel
from widgets.panels.volume.volume_panel import VolumePanel
from widgets.panels.waveform.pulse_panel import PulsePanel
from widgets.parts.drawing_bar import DrawingBar
from widgets.parts.image_bar import ImageBar
from widgets.parts.message_bar import MessageBar
from widgets.parts.start_page import StartPage
from widgets.parts.status_line import StatusLine
from widgets.scene_view.view import SceneView
from widgets.section_view.view import SectionView

_Owner = TypeVar("_Owner")


@dataclass(frozen=True)
class LastingParts:
    """What stays when the widgets are made anew in another language.

    Attributes
    ----------
    owners : mapping
        What each subject of the program keeps of its own (the review, the volumes), by its type.
    """

    settings: Settings
    theme: Theme
    jobs: JobQueue
    document: Document
    toolbox: MouseToolbox
    window: MainWindow
    owners: Mapping[type, object]


@dataclass
class WindowParts:
    """The parts of a window as it is now; :mod:`app.wiring` connects them.

    Who keeps this finds the new widgets in it after a change of language.
    """

    language: Language
    settings: Settings
    theme: Theme
    jobs: JobQueue
    document: Document
    toolbox: MouseToolbox
    image_views: ImageViews
    scene_view: SceneView
    section_view: SectionView
    camera_panel: CameraPanel
    map_view: MapView
    view_docks: ViewDocks
    image_bar: ImageBar
    drawing_bar: DrawingBar
    message_bar: MessageBar
    start_page: StartPage
    status_line: StatusLine
    project_tree: ProjectTree
    layers_panel: LayersPanel
    processing_panel: ProcessingPanel
    attribute_panel: AttributePanel
    review_panel: ReviewPanel
    evaluation_panel: EvaluationPanel
    class_panel: ClassPanel
    quality_panel: QualityPanel
    study_panel: StudyPanel
    label_panel: LabelPanel
    template_panel: TemplatePanel
    volume_panel: VolumePanel
    pulse_panel: PulsePanel
    feature_table: FeatureTable
    jobs_panel: JobsPanel
    window: MainWindow
    owners: Mapping[type, object]

    def of(self, owner: type[_Owner]) -> _Owner:
        """What a subject of the program keeps of its own: ``parts.of(Review)``."""
        found = self.owners[owner]
        if not isinstance(found, owner):
            message = f"{owner.__name__} is kept as {type(found).__name__}"
            raise TypeError(message)
        return found

    @property
    def image_view(self) -> ImageView:
        """The main image; others may stand beside it."""
        return self.image_views.main

    @property
    def camera_view(self) -> CameraView:
        """The picture in the camera's dock."""
        return self.camera_panel.view

    @property
    def views(self) -> tuple[ImageViews | SceneView | SectionView | CameraView | MapView, ...]:
        """All views of the map."""
        return (
            self.image_views,
            self.scene_view,
            self.section_view,
            self.camera_view,
            self.map_view,
        )

    def close_views(self) -> None:
        """Stop the views' loaders and give back their graphics; may be called again."""
        self.scene_view.close()
        self.section_view.close()
        self.camera_view.close()
        self.map_view.close()

    def replace_by(self, parts: WindowParts) -> None:
        """Hold these parts from now on."""
        for part in fields(WindowParts):
            setattr(self, part.name, getattr(parts, part.name))


def take_down(parts: WindowParts) -> None:
    """Stop jobs and loaders, close the project and the 3D view; may be called again."""
    parts.jobs.close()
    parts.document.close()
    parts.close_views()
    parts.document.tiles.close()
