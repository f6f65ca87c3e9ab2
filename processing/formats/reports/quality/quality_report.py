"""The quality report of a map that is handed in: ``qa.pdf``, ``qa.html`` and ``qa.json``."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from processing.core.monitor import Monitor
from processing.formats.map_delivery import MapDelivery, Position, QualityOptions
from processing.formats.reports.quality.check_point_file import read_check_points
from processing.formats.reports.quality.quality_html import write_quality_html
from processing.formats.reports.quality.quality_pdf import write_quality_pdf
from processing.formats.reports.quality.quality_rows import HandCheck, QualityFacts
from processing.formats.vectors.delivered_maps import features_of_map
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.formats.work_facts import WorkFacts
from processing.map.catalogue import CHANGE_KIND
from processing.map.feature import Status
from processing.map.map_extent import extent_of
from processing.map.quality.check_points import LEVEL_LIMITS, PointCheck, check_points
from processing.map.quality.findings import RULES
from processing.map.quality.map_check import MapCheck, check_map
from processing.map.renewal.map_agreement import agreement

_HAND = "hand"


def write_quality_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Look a map through and write what was found.

    Raises
    ------
    OutOfRange, MissingInput, BadFile
        As :func:`read_check_points`.
    UserError
        What stands against writing; `Cancelled`.
    """
    points = checked_points(delivery)
    software = f"Zuka {version('zuka')}"
    facts = quality_facts(delivery, points, monitor, software=software, work=delivery.work)
    language = delivery.language or "en"
    write_quality_pdf(position("qa.pdf"), facts, language, monitor)
    write_quality_html(position("qa.html"), facts, language)
    words = json.dumps(
        {**_numbers(facts.check, delivery.crs), **_accuracy(points), **_hand(facts.hand)},
        ensure_ascii=False,
        indent=1,
    )
    position("qa.json").write_text(words + "\n", encoding="utf-8")


def quality_facts(
    delivery: MapDelivery,
    points: PointCheck | None,
    monitor: Monitor,
    *,
    software: str,
    work: WorkFacts,
) -> QualityFacts:
    """Look a map through for a report.

    Parameters
    ----------
    points : PointCheck or None
        As :func:`checked_points` gives it.
    software : str
        What the report says made it.
    work : WorkFacts
        What the report says the map was made for.

    Raises
    ------
    UserError
        As :func:`hand_check`; `Cancelled`.
    """
    check = check_map(
        delivery.every_feature,
        delivery.catalogue,
        monitor,
        crs=delivery.crs,
        drives={drive.id for drive in delivery.drives},
    )
    return QualityFacts(
        check,
        delivery.catalogue,
        delivery.crs,
        software,
        points,
        work=work,
        hand=hand_check(delivery, monitor),
    )


def checked_points(delivery: MapDelivery) -> PointCheck | None:
    """The map against the check points that were given; None without any.

    Raises
    ------
    OutOfRange, MissingInput, BadFile
        As :func:`read_check_points`.
    """
    options = delivery.options_of(QualityOptions)
    if not options.check_points:
        return None
    points = read_check_points(Path(options.check_points), delivery.catalogue)
    return check_points(points, delivery.every_feature, int(options.map_level))


def hand_check(delivery: MapDelivery, monitor: Monitor) -> HandCheck | None:
    """The map and what tools found, by a map that was drawn separately; None without any.

    Twice the standard deviation of the map level lies between two places of one thing at most.

    Raises
    ------
    OutOfRange, MissingInput, BadFile, Unsuitable
        It can't be read, lies elsewhere, or has nothing of the catalogue's kinds; `Cancelled`.
    """
    options = delivery.options_of(QualityOptions)
    if not options.check_map:
        return None
    mapped = read_mapped(Path(options.check_map))
    if not mapped.crs:
        mapped = replace(mapped, crs=delivery.crs)
    read = features_of_map(
        mapped,
        delivery.catalogue,
        crs=delivery.crs,
        known=frozenset(),
        around=extent_of(delivery.every_feature),
    )
    tolerance = 2 * LEVEL_LIMITS[int(options.map_level)].plan_m
    own = [one for one in delivery.every_feature if one.kind != CHANGE_KIND]
    accepted = [one for one in own if one.status is Status.ACCEPTED]
    by_tools = [one for one in own if one.provenance.tool != _HAND]
    return HandCheck(
        agreement(read.features, accepted, tolerance, monitor),
        agreement(read.features, by_tools, tolerance, monitor),
    )


def _hand(hand: HandCheck | None) -> dict[str, Any]:
    if hand is None:
        return {}
    return {
        "hand_check": [
            {
                "kind": one.kind,
                "unit": "m" if one.is_line else "count",
                "amount": round(one.truth, 3),
                "map": {"precision": _rounded(one.precision), "recall": _rounded(one.recall)},
                "tools": {
                    "precision": _rounded(tools.precision),
                    "recall": _rounded(tools.recall),
                },
            }
            for one, tools in zip(hand.map, hand.tools, strict=True)
        ]
    }


def _accuracy(points: PointCheck | None) -> dict[str, Any]:
    if points is None:
        return {}
    return {
        "check_points": {
            "level": points.level,
            "missing": [one.point.id for one in points.missing],
            **{
                name: {
                    "count": one.count,
                    "rmse_m": _rounded(one.rmse_m),
                    "max_m": _rounded(one.most_m),
                    "limit_m": one.limit_m,
                    "passes": one.passes,
                }
                for name, one in (("plan", points.plan), ("height", points.height))
            },
            "points": [
                {
                    "id": one.point.id,
                    "feature": one.feature or None,
                    "plan_m": _rounded(one.plan_m),
                    "height_m": _rounded(one.height_m),
                }
                for one in points.points
            ],
        }
    }


def _rounded(value: float) -> float | None:
    return None if math.isnan(value) else round(value, 4)


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
                "unseen": one.unseen,
                "candidates": one.candidates,
                "rejected": one.rejected,
                "precision": _rounded(one.precision),
                "recall": _rounded(one.recall),
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
