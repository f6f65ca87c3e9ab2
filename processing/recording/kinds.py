"""The kinds of point-cloud image."""

from __future__ import annotations

from enum import Enum

from processing.core.text import Text


class ImageKind(Enum):
    """How a recording is folded into rows (Takahashi 2022, 3.3 to 3.6).

    Clouds without revolutions have cells for pulses: of a grid seen from above, or of the grid of
    a standing scanner, one sweep to a row.
    """

    TRAJECTORY_CENTER = "trajectory-center"
    FEATURE_CENTER = "feature-center"
    REVERSIBLE = "reversible"
    TRAJECTORY_REVERSIBLE = "trajectory-reversible"
    TOP_VIEW = "top-view"
    SCAN = "scan"

    @property
    def follows_path(self) -> bool:
        """Whether its rows follow one another along the vehicle's path of a vehicle."""
        return self not in (ImageKind.TOP_VIEW, ImageKind.SCAN)

    @property
    def title(self) -> Text:
        """Name for people."""
        return _TITLES[self]


_TITLES = {
    ImageKind.TRAJECTORY_CENTER: Text("Trajectory centre", "軌跡中心"),
    ImageKind.FEATURE_CENTER: Text("Feature centre", "地物中心"),
    ImageKind.REVERSIBLE: Text("Reversible", "可逆"),
    ImageKind.TRAJECTORY_REVERSIBLE: Text("Trajectory-based reversible", "軌跡ベースの可逆"),
    ImageKind.TOP_VIEW: Text("Top view", "上面"),
    ImageKind.SCAN: Text("The scan's own image", "スキャン画像"),
}
