"""The images of a drive: made once each, kept with it."""

from __future__ import annotations

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind


def image_of(drive: Drive, kind: ImageKind) -> PointCloudImage:
    """The recording as an image of one kind; made once, then kept with the drive.

    Raises
    ------
    Unsuitable
        The drive has no revolutions and the kind needs them, or the reverse.
    """
    if kind not in drive.image_kinds:
        raise Unsuitable(
            Text(
                "This drive has no image of the kind “{kind}”.",
                "この走行データでは「{kind}」の画像を作成できません。",
            ).filled(kind=kind.title),
            Text.same(drive.info.name),
            drive.info.rows_reason
            if drive.revolutions is None
            else Text("Choose one of the other kinds.", "ほかの種類を選んでください。"),
        )
    return drive.kept(kind, lambda: PointCloudImage.of_drive(drive, kind))
