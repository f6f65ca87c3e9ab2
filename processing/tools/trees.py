"""The tool TREES: street trees with girth, height and crown, as a ledger of trees asks for them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from processing.core.monitor import Monitor
from processing.core.parameters import least_confidence, length
from processing.core.text import Text
from processing.methods.road.coarse.coarse_uprights import (
    CoarseUpright,
    coarse_uprights,
    sparse_note,
)
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.trees.street_trees import StreetTree, TreeSettings, street_trees
from processing.methods.road.trees.trunk_diagnostics import trunk_diagnostics
from processing.recording.density import are_sparse
from processing.recording.drive import Drive
from processing.scoring.scorers import TREE_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)


@dataclass(frozen=True)
class TreeParameters:
    """How thick trunks may be, and how sure a tree must be to be shown."""

    thickest_m: float = length(
        1.2,
        low=0.1,
        high=5.0,
        name=Text("Thickest trunk", "幹の最大直径"),
        explanation=Text(
            "What is wider 1.2 m above the ground is no trunk of a street tree.",
            "地上1.2 mでこれより太いものは、街路樹の幹とみなしません。",
        ),
        picture="trunk/thickest",
    )
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a tree is left out.",
            "樹木である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_trees(
    drives: tuple[Drive, ...], parameters: TreeParameters, monitor: Monitor
) -> CandidateResult:
    """Street trees of a survey: one result for all heads and passes."""
    if are_sparse(drives):
        return _of_sparse_drives(drives, parameters, monitor)
    found = street_trees(drives, TreeSettings(parameters.thickest_m), monitor)
    trees = [one for one in found if one.confidence >= parameters.least_confidence]
    return CandidateResult(tuple(_candidate(one) for one in trees), _note(drives, found, trees))


def diagnose_trees(asked: RequestedPosition, parameters: TreeParameters) -> tuple[Diagnostic, ...]:
    """The circles about a place that a trunk is measured by, and those that are left out."""
    return trunk_diagnostics(asked, parameters.thickest_m)


def _note(
    drives: Sequence[Drive], found: Sequence[StreetTree], trees: Sequence[StreetTree]
) -> Text:
    if trees:
        return Text("", "")
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    if not found:
        return Text(
            "Nothing upright and round was measured beside the road.",
            "道路沿いに、幹とみなせる円柱状の物は計測されていません。",
        )
    return Text(
        f"None of {len(found)} upright things carries a crown of its own.",
        f"円柱状の物{len(found)}件のうち、樹冠のあるものはありませんでした。",
    )


def _candidate(tree: StreetTree) -> Candidate:
    trunk, crown = tree.trunk, tree.crown
    attributes: dict[str, CandidateValue] = {
        "girth_m": round(trunk.girth_m, 3),
        "dbh_m": round(trunk.diameter_m, 4),
        "dbh_within_m": round(trunk.diameter_within_m, 3),
        "stems": len(trunk.stems),
        "height_m": round(crown.height_m, 2),
        "crown_m": round(sum(crown.spread_m) / 2, 2),
        "crown_across_m": round(crown.spread_m[1], 2),
        "lean_deg": round(trunk.lean_deg, 1),
    }
    heights = {
        "lowest_branch_m": crown.lowest_m,
        "road_clearance_m": tree.clearances.road_m,
        "walk_clearance_m": tree.clearances.walk_m,
    }
    attributes |= {name: round(high, 2) for name, high in heights.items() if math.isfinite(high)}
    return Candidate.at_foot(
        "street_tree",
        tree.foot,
        tree.confidence,
        attributes,
        own_points=tree.points,
        own_drives=tree.drives,
    )


def _of_sparse_drives(
    drives: tuple[Drive, ...], parameters: TreeParameters, monitor: Monitor
) -> CandidateResult:
    found = coarse_uprights(drives, monitor)
    likely = [
        one for one in found if one.tree >= parameters.least_confidence and one.tree > one.pole
    ]
    candidates = tuple(_coarse_candidate(one) for one in likely)
    return CandidateResult(candidates, sparse_note(len(likely), len(found)))


def _coarse_candidate(upright: CoarseUpright) -> Candidate:
    attributes: dict[str, CandidateValue] = {
        "height_m": round(upright.highest_m, 2),
        "lean_deg": round(upright.lean_deg, 1),
    }
    return Candidate.at_foot(
        "street_tree",
        upright.foot,
        upright.tree,
        attributes,
        own_points=upright.points,
        own_drives=upright.drives,
    )


TREES = Tool(
    id="trees",
    name=Text("Street trees", "街路樹の抽出"),
    explanation=Text(
        "Finds the trees along the streets and measures girth 1.2 m above the ground, height and "
        "crown, stakes told apart, from all heads and passes of a survey.",
        "道路沿いの樹木を全スキャナー・全走行のデータから抽出し、"
        "支柱を区別して地上1.2 mの幹周・樹高・枝張りを計測します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=TreeParameters,
    method=SurveyFinder(find_trees),
    makes=("street_tree",),
    button=ToolButton(Text("Find street trees", "街路樹を抽出"), "Ctrl+Shift+F8", "mdi6.tree"),
    diagnostics=diagnose_trees,
    scorer=TREE_SCORER,
)
