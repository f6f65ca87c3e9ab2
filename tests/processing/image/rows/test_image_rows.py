"""The rows of an image are the same kept, found piece by piece and found at once."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from processing.image.rows import image_rows as module
from processing.image.rows.image_rows import ImageRows, image_rows
from processing.recording.columns.columns import ColumnWriter
from processing.recording.kinds import ImageKind
from processing.recording.revolutions.revolutions import Revolutions
from tests.processing.image.recordings import PulsedRecording, random_recording

WITH_REVOLUTIONS = [kind for kind in ImageKind if kind.follows_path]


@pytest.fixture
def street(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> PulsedRecording:
    """A recording whose pulses are in the folder, and which is worth keeping rows of."""
    monkeypatch.setattr(module, "_FEW_POINTS", 0)
    monkeypatch.setattr(module, "_POINTS_AT_ONCE", 97)
    street = random_recording(4, pulses_per_revolution=40, revolutions=60)
    with ColumnWriter(tmp_path) as writer:
        writer.append({"pulse": street.pulses})
    return street


def same(one: ImageRows, other: ImageRows) -> bool:
    return all(np.array_equal(vars(one)[name], vars(other)[name]) for name in vars(one))


def kept_files(folder: Path) -> list[Path]:
    return sorted(folder.glob("image_rows_*"))


@pytest.mark.parametrize("kind", WITH_REVOLUTIONS)
def test_rows_found_in_pieces_and_rows_read_again_are_those_of_the_whole(
    street: PulsedRecording, tmp_path: Path, kind: ImageKind
) -> None:
    pulses, revolutions = street.pulses, street.revolutions
    whole = image_rows(kind, pulses, revolutions)
    assert not kept_files(tmp_path)
    np.testing.assert_array_equal(whole.row_starts[[0, -1]], [0, pulses.size])
    assert same(image_rows(kind, pulses, revolutions, tmp_path), whole)
    assert [path.name for path in kept_files(tmp_path)] == [f"image_rows_{kind.value}.npz"]
    # The next time nothing but the rows is read; a column written since would be.
    column = tmp_path / "pulse.bin"
    written_ns = column.stat().st_mtime_ns
    column.write_bytes(b"")
    os.utime(column, ns=(written_ns, written_ns))
    assert same(image_rows(kind, pulses, revolutions, tmp_path), whole)


def test_a_row_begins_at_the_first_point_of_its_pulses(street: PulsedRecording) -> None:
    rows = image_rows(ImageKind.FEATURE_CENTER, street.pulses, street.revolutions)
    for row in range(rows.origins.size):
        own = street.pulses[rows.row_starts[row] : rows.row_starts[row + 1]]
        assert (2 * own >= rows.origins[row]).all()
        assert (2 * own < rows.origins[row] + rows.spans[row]).all()


def test_cells_have_rows_too(street: PulsedRecording, tmp_path: Path) -> None:
    whole = image_rows(ImageKind.TOP_VIEW, street.pulses, 33)
    np.testing.assert_array_equal(
        whole.row_starts[:-1], np.searchsorted(street.pulses, 33 * np.arange(whole.origins.size))
    )
    assert same(image_rows(ImageKind.TOP_VIEW, street.pulses, 33, tmp_path), whole)
    other = image_rows(ImageKind.TOP_VIEW, street.pulses, 34, tmp_path)
    assert same(other, image_rows(ImageKind.TOP_VIEW, street.pulses, 34))


def test_rows_of_other_turns_or_a_damaged_file_are_found_anew(
    street: PulsedRecording, tmp_path: Path
) -> None:
    kind = ImageKind.TRAJECTORY_REVERSIBLE
    pulses, revolutions = street.pulses, street.revolutions
    first = image_rows(kind, pulses, revolutions, tmp_path)
    (path,) = kept_files(tmp_path)
    for damage in (b"", b"nonsense", path.read_bytes()[:300]):
        path.write_bytes(damage)
        assert same(image_rows(kind, pulses, revolutions, tmp_path), first)
        assert len(path.read_bytes()) > 300
    moved = Revolutions(**{**vars(revolutions), "fold_pulses": revolutions.fold_pulses + 3})
    assert not same(image_rows(kind, pulses, moved, tmp_path), first)
    assert kept_files(tmp_path) == [path]


def test_a_folder_that_takes_no_files_still_has_rows(
    street: PulsedRecording, tmp_path: Path
) -> None:
    # A folder in the way stands for a disk that refuses to write.
    (tmp_path / "image_rows_top-view.npz").mkdir()
    rows = image_rows(ImageKind.TOP_VIEW, street.pulses, 33, tmp_path)
    assert same(rows, image_rows(ImageKind.TOP_VIEW, street.pulses, 33))
    assert not list(tmp_path.glob("*.part"))


def test_a_recording_without_points_has_no_rows(tmp_path: Path) -> None:
    rows = image_rows(ImageKind.TOP_VIEW, np.empty(0, np.int64), 33, tmp_path)
    np.testing.assert_array_equal(rows.row_starts, [0])
