"""The camera images of a drive, as they are noted in its folder; the image files stay in place."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

from processing.core.block_sums import refuse_damaged, write_with_sums
from processing.core.errors import BadFile, report_as_user_error
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.recording.camera_images.image_list import CameraImage, ImageList

IMAGES = "images.json"
"""File of a drive's folder."""


def write_images(folder: Path, images: ImageList) -> None:
    """Note a drive's images in its folder, whole or not at all."""
    noted = [{**dataclasses.asdict(image), "path": str(image.path.absolute())} for image in images]
    path = folder / IMAGES
    with report_as_user_error(path):
        text = json.dumps(noted, ensure_ascii=False)
        # Names of files may be no text; JSON reads them back.
        write_with_sums(path, text.encode("utf-8", errors="backslashreplace"))


def read_images(folder: Path) -> ImageList | None:
    """The images noted in a drive's folder; None when it has none.

    Raises
    ------
    BadFile
        The note is damaged.
    """
    path = folder / IMAGES
    if not path.is_file():
        return None
    refuse_damaged(path)
    with report_as_user_error(path):
        text = path.read_bytes()
    try:
        noted = json_of(text)
        images = tuple(
            CameraImage(
                **{
                    **image,
                    "path": Path(image["path"]),
                    "xyz": tuple(image["xyz"]),
                    "distortion": tuple(image["distortion"]),
                }
            )
            for image in noted
        )
    except (ValueError, TypeError, KeyError) as error:
        raise BadFile(
            Text(
                "The list of a drive's camera images is damaged.",
                "走行データのカメラ画像一覧が壊れています。",
            ),
            Text.same(f"{path}: {error}"),
            Text("Import the drive again.", "走行データを再インポートしてください。"),
        ) from error
    return ImageList(images)
