"""A recording of raw pulses was delivered as a folder, and is looked for as one."""

import shutil

from processing.project.importing.file_recorder import checksum_of
from processing.project.sources.source_check import FileState, state_of
from processing.recording.drive_info import SourceFile


def test_a_delivered_folder_is_there_changed_or_missing(tmp_path):
    folder = tmp_path / "pulses"
    (folder / "echo-float32-range").mkdir(parents=True)
    values = folder / "echo-float32-range" / "1.bin"
    values.write_bytes(b"12345678")
    status = folder.stat()
    source = SourceFile(str(folder), status.st_size, 0, checksum_of(folder), points=2)
    assert state_of(source, folder, lambda: None) is FileState.AS_DELIVERED
    values.write_bytes(b"12345679")
    assert state_of(source, folder, lambda: None) is FileState.CHANGED
    shutil.rmtree(folder)
    assert state_of(source, folder, lambda: None) is FileState.MISSING
