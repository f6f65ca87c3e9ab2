"""The offsets of a drive's cameras, kept in its folder; the delivered files stay as they are."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from pathlib import Path

from processing.core.block_sums import refuse_damaged, write_with_sums
from processing.core.errors import BadFile, report_as_user_error
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.recording.camera_images.calibration import CameraOffset

_FILE_NAME = "camera_offsets.json"


def write_offsets(folder: Path, offsets: Mapping[str, CameraOffset]) -> None:
    """Keep offsets by camera, whole or not at all; those that change nothing are left out.

    Raises
    ------
    NoSpace
        The disk is full or refuses the write.
    """
    path = folder / _FILE_NAME
    noted = {
        camera: dataclasses.asdict(offset)
        for camera, offset in offsets.items()
        if not offset.is_zero
    }
    with report_as_user_error(path):
        write_with_sums(path, json.dumps(noted, ensure_ascii=False).encode())


def read_offsets(folder: Path) -> dict[str, CameraOffset]:
    """The offsets kept in a drive's folder, by camera.

    Raises
    ------
    BadFile
        The note is damaged.
    """
    path = folder / _FILE_NAME
    if not path.is_file():
        return {}
    refuse_damaged(path)
    with report_as_user_error(path):
        text = path.read_bytes()
    try:
        noted = json_of(text)
        offsets = {
            str(camera): CameraOffset(**{name: _number(v) for name, v in values.items()})
            for camera, values in noted.items()
        }
    except (ValueError, TypeError, AttributeError) as error:
        raise BadFile(
            Text(
                "The offsets of a drive's cameras are damaged.",
                "走行データのカメラオフセットが壊れています。",
            ),
            Text.same(f"{path}: {error}"),
            Text(
                "Delete this file; the cameras are then used as delivered.",
                "このファイルを削除してください。カメラは納品時の標定値で使われます。",
            ),
        ) from error
    return offsets


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        message = f"{value!r} is no number"
        raise ValueError(message)
    return float(value)
