"""ImportForm: what is to be imported, from which files, into which project."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.dialogs.delivery_map import DeliveryMap, DeliveryShapes
from widgets.dialogs.delivery_table import DeliveredRow, DeliveryTable
from widgets.dialogs.reference_systems import ReferenceSystemBox
from widgets.parts.plain_buttons import remove_icons


@dataclass(frozen=True)
class ImportOptions:
    """What the form asks for.

    Attributes
    ----------
    files : tuple of Path
        Points, trajectories and image lists; their content tells which is which.
    project : Path
        The project's folder; made if there is none.
    crs : str
        ``EPSG:n``, or empty for the files' own.
    classes_as_labels : bool
        Whether the delivered classes become labels that can be corrected by hand.
    """

    files: tuple[Path, ...]
    project: Path
    crs: str
    classes_as_labels: bool = False


class ImportForm(QDialog):
    """A form beside the window; the window stays usable while it is open."""

    import_requested = Signal(object)  # ImportOptions
    files_changed = Signal(object)  # tuple[Path, ...]

    def __init__(
        self,
        project: Path,
        files: tuple[Path, ...] = (),
        parent: QWidget | None = None,
        *,
        kinds: str = "",
    ) -> None:
        """Show files to be imported; ``kinds`` is the filter under which more are looked for."""
        super().__init__(parent)
        self._kinds = kinds
        self.setWindowTitle(self.tr("Import a drive"))
        self.resize(940, 560)
        self._files = DeliveryTable(self)
        self._map = DeliveryMap(self)
        self._summary = QLabel(self)
        self._summary.setWordWrap(True)
        self._summary.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._project = QLineEdit(str(project), self)
        self._crs = ReferenceSystemBox(self)
        self._as_labels = QCheckBox(self.tr("Take the delivered classes as labels"), self)
        self._as_labels.setToolTip(
            self.tr("Labels can be corrected by hand and are exported to LAS again.")
        )
        self._beside, self._images, self._into = QCheckBox(self), QCheckBox(self), QCheckBox(self)
        for offer in (self._beside, self._images, self._into):
            offer.hide()
        self._offered: tuple[Path, ...] = ()
        self._offered_images: tuple[Path, ...] = ()
        self._offered_project: Path | None = None
        self._lacking = QLabel(self)
        self._lacking.setWordWrap(True)
        self._lacking.hide()
        self._trouble = QLabel(self)
        self._trouble.setWordWrap(True)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self._import = self._buttons.addButton(
            self.tr("Import"), QDialogButtonBox.ButtonRole.AcceptRole
        )
        remove_icons(self._buttons)
        self._lay_out()
        self._buttons.accepted.connect(self._on_buttons_accepted)
        self._buttons.rejected.connect(self.close)
        self.add_files(files)

    def add_files(self, files: tuple[Path, ...]) -> None:
        """Add files to the list; those that are there already stay once."""
        self._files.add_files(files)
        self._tell_files()

    def use_options(self, options: ImportOptions) -> None:
        """Stand as when these options were asked for."""
        self._project.setText(str(options.project))
        self._crs.choose(options.crs)
        self._as_labels.setChecked(options.classes_as_labels)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files in the list."""
        return self._files.files

    @property
    def crs(self) -> str:
        """``EPSG:n`` as far as it is entered; empty for the files' own."""
        return self._crs.code or ""

    def offer(self, beside: tuple[Path, ...], *, is_lacking: bool) -> None:
        """Offer trajectories that lie beside the files and cover them; they are ticked at first.

        Parameters
        ----------
        is_lacking : bool
            Whether the files want a trajectory and none is among them.
        """
        self._offered = beside
        names = ", ".join(path.name for path in beside)
        words = self.tr("Take the trajectory beside them: {name} covers their times")
        self._beside.setText(words.format(name=names))
        self._beside.setToolTip("\n".join(str(path) for path in beside))
        self._beside.setChecked(bool(beside))
        self._beside.setVisible(bool(beside))
        self._lacking.setText(
            self.tr(
                "No trajectory is among the files. Curbs and covered gutters can't be found "
                "without one; it can be added to the drive later."
            )
        )
        self._lacking.setVisible(is_lacking and not beside)

    def offer_images(self, beside: tuple[Path, ...]) -> None:
        """Offer image lists that lie beside the files; they are ticked at first."""
        self._offered_images = beside
        names = ", ".join(path.name for path in beside)
        words = self.tr("Take the list of camera images beside them: {name}")
        self._images.setText(words.format(name=names))
        self._images.setChecked(bool(beside))
        self._images.setVisible(bool(beside))

    def offer_project(self, project: Path | None) -> None:
        """Offer to import into a project that lies beside the files instead of a new one."""
        self._offered_project = project
        name = "" if project is None else project.name
        self._into.setText(self.tr("Add to the project beside them: {name}").format(name=name))
        self._into.setChecked(False)
        self._into.setVisible(project is not None)

    def show_delivery(
        self, rows: Sequence[DeliveredRow], shapes: DeliveryShapes, summary: str
    ) -> None:
        """Show what the files hold, where they lie and what of them belongs together."""
        self._files.show_rows(rows)
        self._map.show_shapes(shapes)
        self._summary.setText(summary)

    def _tell_files(self) -> None:
        self._import.setEnabled(bool(self.files))
        self._summary.setText(self.tr("Looking at the files…") if self.files else "")
        self.files_changed.emit(self.files)

    def ask_for_files(self) -> None:
        """Ask for files to add; the list shows those that a delivery may have."""
        names, _ = QFileDialog.getOpenFileNames(self, self.tr("Add files"), "", self._kinds)
        self.add_files(tuple(Path(name) for name in names))

    def _lay_out(self) -> None:
        add = QPushButton(self.tr("Add files…"), self)
        remove = QPushButton(self.tr("Remove"), self)
        position = QPushButton(self.tr("Choose…"), self)
        add.clicked.connect(self.ask_for_files)
        remove.clicked.connect(self._on_remove_clicked)
        position.clicked.connect(self._on_position_clicked)
        beside = QVBoxLayout()
        beside.addWidget(add)
        beside.addWidget(remove)
        beside.addStretch(1)
        files = QHBoxLayout()
        files.addWidget(self._files, 1)
        files.addLayout(beside)
        folder = QHBoxLayout()
        folder.addWidget(self._project, 1)
        folder.addWidget(position)
        hint = QLabel(
            self.tr(
                "Point files of all scanners, the trajectory, and image lists if there are any."
            ),
            self,
        )
        hint.setWordWrap(True)
        form = QFormLayout()
        form.addRow(self.tr("Project"), folder)
        form.addRow(self.tr("Reference system"), self._crs)
        form.addRow("", self._as_labels)
        layout = QVBoxLayout(self)
        layout.addWidget(hint)
        layout.addLayout(files, 1)
        below = QHBoxLayout()
        below.addWidget(self._map)
        said = QVBoxLayout()
        said.addWidget(self._summary, 1)
        for offer in (self._beside, self._images, self._lacking, self._into):
            said.addWidget(offer)
        below.addLayout(said, 1)
        layout.addLayout(below)
        layout.addLayout(form)
        layout.addWidget(self._trouble)
        layout.addWidget(self._buttons)

    def _on_remove_clicked(self) -> None:
        self._files.remove_selected()
        self._tell_files()

    def _on_position_clicked(self) -> None:
        name, _ = QFileDialog.getSaveFileName(
            self, self.tr("Project"), self._project.text(), self.tr("Zuka projects (*.zuka)")
        )
        if name:
            self._project.setText(name)

    def _on_buttons_accepted(self) -> None:
        code = self._crs.code
        if code is None:
            self._trouble.setText(
                self.tr("The reference system must be a code such as EPSG:6677, or be left empty.")
            )
            return
        files = self.files
        if self._beside.isVisible() and self._beside.isChecked():
            files += self._offered
        if self._images.isVisible() and self._images.isChecked():
            files += self._offered_images
        project = Path(self._project.text().strip())
        if self._into.isChecked() and self._offered_project is not None:
            project = self._offered_project
        if project.suffix != ".zuka":
            project = project.with_name(project.name + ".zuka")
        request = ImportOptions(files, project, code, self._as_labels.isChecked())
        self.import_requested.emit(request)
        self.close()
