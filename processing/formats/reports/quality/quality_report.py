"""The quality report of a map that is handed in: ``qa.pdf``, ``qa.html`` and ``qa.json``."""

from __future__ import annotations

import json
from importlib.metadata import version
from typing import Any

from processing.core.monitor import Monitor
from processing.formats.map_delivery import MapDelivery, Position
from processing.formats.reports.quality.quality_html import write_quality_html
from processing.formats.reports.quality.quality_pdf import write_quality_pdf
from processing.formats.reports.quality.quality_rows import QualityFacts
from processing.map.quality.findings import RULES
from processing.map.quality.map_check import MapCheck, check_map


def write_quality_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Look a map through and write what was found.

    Raises
    ------
    UserError
        What stands against writing; `Cancelled`.
    """
    check = check_map(delivery.every_feature, delivery.catalogue, monitor)
    facts = QualityFacts(check, delivery.catalogue, delivery.crs, f"Zuka {version('zuka')}")
    language = delivery.language or "en"
    write_quality_pdf(position("qa.pdf"), facts, language, monitor)
    write_quality_html(position("qa.html"), facts, language)
    words = json.dumps(_numbers(check, delivery.crs), ensure_ascii=False, indent=1)
    position("qa.json").write_text(words + "\n", encoding="utf-8")


def _numbers(check: MapCheck, crs: str) -> dict[str, Any]:
    return {
        "crs": crs or None,
        "errors": check.errors,
        "decided_share": round(check.decided_share, 4),
        "rules": {
            id_: {"found": check.count(id_), "is_error": rule.is_error, "name": rule.name.en}
            for id_, rule in RULES.items()
        },
        "kinds": [
            {
                "kind": one.kind,
                "accepted": one.accepted,
                "by_tools": one.by_tools,
                "candidates": one.candidates,
                "rejected": one.rejected,
            }
            for one in check.kinds
        ],
        "findings": [
            {
                "rule": one.rule,
                "features": list(one.features),
                "kind": one.kind,
                "easting_m": one.position[0],
                "northing_m": one.position[1],
                "height_m": one.position[2],
                "extent": one.extent_m,
            }
            for one in check.findings
        ],
    }
