"""What a user should know about a drive's camera images before they are trusted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text
from processing.recording.camera_images.image_list import ImageList
from processing.recording.vehicle_path.trajectory import Trajectory

FAR_M = 500.0
"""Images taken farther from the recorded points than this don't belong to them: a wrong list or
another zone of coordinates."""


def far_away(
    images: ImageList, lowest: NDArray[np.float64], highest: NDArray[np.float64]
) -> Text | None:
    """One sentence when no image was taken anywhere near the points; None when all is well.

    Parameters
    ----------
    lowest, highest : (3,) float64
        Extent of the points, m, project CRS.
    """
    if not len(images):
        return None
    centres = np.array([image.xyz for image in images])[:, :2]
    outside = np.maximum(0, np.maximum(lowest[:2] - centres, centres - highest[:2]))
    nearest = float(np.hypot(outside[:, 0], outside[:, 1]).min())
    if nearest <= FAR_M:
        return None
    return Text(
        "The camera images were taken {away:,.1f} km from the points: their list is in another "
        "reference system, or belongs to another drive.",
        "カメラ画像の撮影位置が点群から {away:,.1f} km 離れています。"
        "画像一覧の座標系が異なるか、別の走行データのものです。",
    ).filled(away=nearest / 1000)


def outside_trajectory(images: ImageList, trajectory: Trajectory | None) -> Text | None:
    """One sentence when images were taken while the vehicle's place isn't known."""
    if trajectory is None or not len(images):
        return None
    covered = trajectory.covers(np.array([image.time_s for image in images]))
    missing = int((~covered).sum())
    if not missing:
        return None
    return Text(
        "{missing} of {all} camera images were taken outside the trajectory's time; a time offset "
        "has no effect on them.",
        "{all} 枚中 {missing} 枚のカメラ画像が走行軌跡の時間範囲外です。"
        "これらには時刻オフセットが効きません。",
    ).filled(missing=missing, all=len(images))
