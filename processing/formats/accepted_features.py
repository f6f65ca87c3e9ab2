"""What of a map goes into formats that can't say whether a person agreed to a feature."""

from __future__ import annotations

from processing.core.text import Text
from processing.formats.map_delivery import MapDelivery
from processing.map.feature import Feature, Status


def accepted_features(delivery: MapDelivery, format_name: Text) -> tuple[Feature, ...]:
    """The features that were accepted; that candidates are left out is told.

    DXF has layers of their own for candidates, GIS formats and tables a column: in others they
    would look like what was accepted.
    """
    accepted = tuple(one for one in delivery.features if one.status is Status.ACCEPTED)
    left_out = len(delivery.features) - len(accepted)
    if left_out:
        delivery.tell(
            Text(
                "Not in the {format}, which can't mark candidates: {count} that nobody has judged.",
                "{format}では候補を区別できないため、未確認の候補{count}個は含まれていません。",
            ).filled(format=format_name, count=f"{left_out:,}")
        )
    return accepted
