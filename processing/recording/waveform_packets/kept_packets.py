"""The delivered packets in a drive folder: files taken over byte for byte, and what codes them.

A drive keeps the packets themselves and not only where they were delivered: its points open
without their delivery, and a flight's waveforms must not be lost because a folder moved. They stay
as they came, so what a point says of its packet needs no change and exports give the same bytes.
"""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from processing.core.errors import BadFile, report_as_user_error
from processing.core.owned_files import new_file
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.recording.waveform_packets.descriptors import PacketFile, WaveformDescriptor

FILE_NAME = "waveforms.json"


def packets_path(folder: Path, number: int) -> Path:
    """Where the packets of a delivered file lie in a drive folder."""
    return folder / f"packets{number}.wdp"


def write_packet_files(folder: Path, files: Iterable[PacketFile]) -> None:
    """Note what packets a drive has, whole or not at all.

    Raises
    ------
    NoSpace
    """
    path = folder / FILE_NAME
    temporary = path.with_suffix(".part")
    with report_as_user_error(path):
        text = json.dumps([dataclasses.asdict(file) for file in files], indent=1)
        with new_file(temporary) as part:
            part.write(text.encode("utf-8", errors="backslashreplace"))
        temporary.replace(path)


def read_packet_files(folder: Path) -> tuple[PacketFile, ...]:
    """What packets a drive has; nothing where it has none.

    Raises
    ------
    BadFile
        It isn't what was written.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        return ()
    with report_as_user_error(path):
        text = path.read_bytes()
    try:
        return tuple(_file_from(one) for one in json_of(text))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise BadFile(
            Text(
                "The description of the waveforms of a drive is damaged.",
                "走行データの波形の記述ファイルが壊れています。",
            ),
            Text.same(f"{path}: {error}"),
            Text(
                "Import the drive again from the delivered files.",
                "納品ファイルから走行データを再インポートしてください。",
            ),
        ) from error


def link_packets(source: Path, into: Path) -> None:
    """Let another drive folder have the same packets, without a second copy where that is possible.

    Raises
    ------
    NoSpace, MissingInput
    """
    for file in read_packet_files(source):
        if file.reason.en:
            continue
        link_file(packets_path(source, file.number), packets_path(into, file.number))
    if (source / FILE_NAME).is_file():
        with report_as_user_error(into):
            shutil.copyfile(source / FILE_NAME, into / FILE_NAME)


def link_file(source: Path, target: Path) -> None:
    """Let a file have a second name, or a copy where the disk can't do that."""
    with report_as_user_error(target):
        target.unlink(missing_ok=True)
        try:
            os.link(source, target)
        except FileNotFoundError:
            raise
        except OSError:
            shutil.copyfile(source, target)


# The values come from JSON, whose types only the field names tell.
def _file_from(values: Mapping[str, Any]) -> PacketFile:
    descriptors = {
        int(number): WaveformDescriptor(**one) for number, one in values["descriptors"].items()
    }
    # Projects of before have no remarks.
    texts = {name: Text(**values.get(name, _NOTHING)) for name in ("reason", "remark")}
    return PacketFile(**{**values, "descriptors": descriptors, **texts})


_NOTHING = {"en": "", "ja": ""}
