"""The tool COLOUR: the colour of every point in the camera image that sees it best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.cameras.seen_colours import PointColouring
from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import Monitor
from processing.core.parameters import length, switch
from processing.core.text import Text
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_remarks import far_away
from processing.recording.drive import Drive
from processing.tools.tool import (
    Needs,
    OutputColumn,
    PerPointOfDrive,
    PointBlock,
    PointComputer,
    PointResult,
    Tool,
)


@dataclass(frozen=True)
class ColourParameters:
    """How far cameras are trusted, and whether surfaces hide what lies behind them."""

    reach_m: float = length(
        40.0,
        low=2.0,
        high=200.0,
        name=Text("Farthest camera", "カメラからの最大距離"),
        explanation=Text(
            "Points farther from every camera keep the colour they were delivered with, or none.",
            "どのカメラからもこれより遠い点には、画像の色を付けません。",
        ),
    )
    regards_hidden: bool = switch(
        default=True,
        name=Text("Regard what is hidden", "隠れた点を除外"),
        explanation=Text(
            "A point behind a surface doesn't get the surface's colour. Off is faster.",
            "手前の面に隠れた点には、その画像の色を付けません。オフにすると速くなります。",
        ),
    )


def colouring_of(
    drive: Drive, beside: tuple[Drive, ...], parameters: ColourParameters, monitor: Monitor
) -> PointComputer:
    """Colours a drive's blocks; all drives of the street may hide a point from a camera.

    Raises
    ------
    Unsuitable
        The images were taken far from the points.
    MissingInput
        Not one of the image files is there.
    """
    images = drive.images or ImageList(())
    remark = far_away(images, np.array(drive.info.lowest), np.array(drive.info.highest))
    if remark is not None:
        raise Unsuitable(remark, Text.same(drive.info.name), _RIGHT_LIST)
    _check_files(images, monitor)
    hiding = (drive, *beside) if parameters.regards_hidden else ()
    colouring = PointColouring(images, hiding, parameters.reach_m)

    def compute(block: PointBlock, _parameters: ColourParameters, monitor: Monitor) -> PointResult:
        """``seen_color``: (n, 3) uint8, black where not seen; ``is_seen``: (n,) uint8, 0 or 1."""
        seen = colouring.colours_of(block.xyz, monitor.check)
        return PointResult({"seen_color": seen.colours, "is_seen": seen.is_seen.astype(np.uint8)})

    return compute


def _check_files(images: ImageList, monitor: Monitor) -> None:
    """Say which image files are missing; the others are used."""
    missing = [image.path for image in images if not image.path.is_file()]
    facts = {"missing": len(missing), "all": len(images)}
    if len(missing) == len(images):
        raise MissingInput(_ALL_MISSING.filled(**facts), Text.same(str(missing[0])), _PUT_BACK)
    if missing:
        monitor.report(0.0, _SOME_MISSING.filled(**facts, name=missing[0].name))


_ALL_MISSING = Text(
    "None of the {all} camera images is where it was.",
    "{all} 枚のカメラ画像がどれも元の場所にありません。",
)
_SOME_MISSING = Text(
    "{missing} of {all} camera images are missing ({name} …); the others are used",
    "{all} 枚中 {missing} 枚のカメラ画像（{name} など）が見つからないため、残りの画像を使用します",
)
_PUT_BACK = Text(
    "Put the image files back where they were, or import the drive again with them.",
    "画像ファイルを元の場所に戻すか、画像と一緒に走行データをインポートし直してください。",
)
_RIGHT_LIST = Text(
    "Import the drive again with the list of images in the points' reference system.",
    "点群と同じ座標系の画像一覧と一緒に、走行データをインポートし直してください。",
)

COLOUR = Tool(
    id="colour",
    name=Text("Colours from images", "画像による色付け"),
    explanation=Text(
        "Gives every point its colour in the camera image that sees it best. Delivered colours "
        "are kept beside them.",
        "各点に、最もよく写っているカメラ画像の色を付けます。納品時の色は別に残ります。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.IMAGES,
    parameters=ColourParameters,
    method=PerPointOfDrive(
        colouring_of,
        outputs=(
            OutputColumn("seen_color", "uint8", 3, Text("Colour from images", "画像の色")),
            OutputColumn("is_seen", "uint8", 1, Text("Seen by a camera", "画像に写った点")),
        ),
    ),
)
