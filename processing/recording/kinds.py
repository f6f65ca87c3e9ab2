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

    @property
    def explanation(self) -> Text:
        """What it shows, and what it is good for."""
        return _EXPLANATIONS[self]


_TITLES = {
    ImageKind.TRAJECTORY_CENTER: Text("Trajectory centre", "軌跡中心"),
    ImageKind.FEATURE_CENTER: Text("Feature centre", "地物中心"),
    ImageKind.REVERSIBLE: Text("Reversible", "可逆"),
    ImageKind.TRAJECTORY_REVERSIBLE: Text("Trajectory-based reversible", "軌跡ベースの可逆"),
    ImageKind.TOP_VIEW: Text("Top view", "上面"),
    ImageKind.SCAN: Text("The scan's own image", "スキャン画像"),
}

_EXPLANATIONS = {
    ImageKind.TRAJECTORY_CENTER: Text(
        "The vehicle's path runs through the middle: the road is whole, for curbs and markings.",
        "走行軌跡が中央を通り、道路全体が見えます。縁石や区画線の作図に適します。",
    ),
    ImageKind.FEATURE_CENTER: Text(
        "The path runs along both edges: poles, trees, signs and façades are whole.",
        "走行軌跡が両端を通り、柱・樹木・標識・建物が途切れずに見えます。",
    ),
    ImageKind.REVERSIBLE: Text(
        "Every pulse has a pixel of its own; rows have one length, so the picture drifts.",
        "全パルスが1画素ずつ並びます。行の長さが一定のため、画像は横にずれていきます。",
    ),
    ImageKind.TRAJECTORY_REVERSIBLE: Text(
        "Every pulse has a pixel of its own; rows begin under the vehicle and differ in length.",
        "全パルスが1画素ずつ並びます。行は車両の真下から始まり、長さは行ごとに異なります。",
    ),
    ImageKind.TOP_VIEW: Text(
        "Seen from above, north up: for clouds without turns of a scanner.",
        "北を上にした上面図です。スキャナの回転がない点群に使います。",
    ),
    ImageKind.SCAN: Text(
        "What a standing scanner saw around it, in its own grid.",
        "据え置きスキャナの周囲を、計測時の格子のまま表示します。",
    ),
}
