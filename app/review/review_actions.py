"""Review actions: the queue of candidates, judged by one key each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.review.review import Review
from app.window.action import NOTHING, Action, grouped
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.map.feature import Status
from processing.project.review.review_state import ReviewOrder

QUEUE_KEYS = (
    "review-accept",
    "review-reject",
    "review-accept-line",
    "review-reject-line",
    "review-edit",
    "review-next",
    "review-back",
)
"""Actions whose keys work over the views and the review panel only, while a queue is open."""

_NOTHING_TO_REVIEW = Text(
    "There are no candidates to review: run a tool first.",
    "確認する候補がありません。先に処理を実行してください。",
)
_NO_QUEUE = Text("Start a review first.", "先に確認を開始してください。")


def review_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The review menu, from top to bottom."""
    return grouped(
        (_start(parts),),
        _judgements(parts),
        _line_judgements(parts),
        _orders(parts),
        _hindsight(parts),
    )


def _start(parts: WindowParts) -> Action:
    review, document = parts.of(Review), parts.document

    def start() -> None:
        features = document.features()
        runs = {one.provenance.run for one in features if one.status is Status.CANDIDATE} - {""}
        if not runs:
            document.reported.emit(_NOTHING_TO_REVIEW)
            return
        parts.window.show_panel("review")
        if not review.is_open:
            review.open(sorted(runs), ReviewOrder.CONFIDENCE)
        elif review.is_outrun:
            for run in sorted(runs):
                review.add(run)
        if not any(view.hasFocus() for view in parts.views):
            parts.review_panel.setFocus()  # its keys judge from now on, wherever the hand was

    return Action(
        "review-start",
        Text("Review candidates", "候補を確認"),
        start,
        "review",
        ("F8",),
        hint=Text(
            "Shows the candidates of all runs one after the other, the least sure first.",
            "すべての実行結果の候補を、信頼度の低い順に1つずつ表示します。",
        ),
        needs_project=True,
    )


def _of_queue(
    id_: str, text: Text, run: Callable[[], object], hint: Text = NOTHING, *keys: str
) -> Action:
    return Action(
        id_, text, run, "review", keys, hint=hint, needs_project=True, why_disabled=_NO_QUEUE
    )


def _judgements(parts: WindowParts) -> tuple[Action, ...]:
    """What the keys of the queue do."""
    review = parts.of(Review)
    return (
        _of_queue(
            "review-accept",
            Text("Accept and go on", "採用して次へ"),
            review.accept,
            Text("The candidate becomes part of the map.", "候補を地図に採用します。"),
            "Return",
            "Enter",
        ),
        _of_queue(
            "review-reject",
            Text("Reject and go on", "却下して次へ"),
            review.reject,
            Text(
                "The candidate is kept as rejected, to judge the tool by.",
                "候補を却下します（ツールの評価のために記録は残ります）。",
            ),
            "Del",
        ),
        _of_queue(
            "review-edit",
            Text("Correct the candidate", "候補を修正"),
            review.edit,
            Text(
                "Takes the tool that moves vertices; accept when it is right.",
                "頂点編集ツールに切り替えます。直したら採用してください。",
            ),
            "E",
        ),
        _of_queue(
            "review-next",
            Text("Leave for later", "保留して次へ"),
            review.next,
            Text("Goes on; the candidate stays undecided.", "未判定のまま次へ進みます。"),
            "N",
        ),
        _of_queue(
            "review-back",
            Text("Back", "前へ戻る"),
            review.back,
            Text("Shows the candidate before.", "前の候補を表示します。"),
            "B",
        ),
    )


def _line_judgements(parts: WindowParts) -> tuple[Action, ...]:
    """What they do with all that a tool gave as one line."""
    review = parts.of(Review)
    return (
        _of_queue(
            "review-accept-line",
            Text("Accept the whole line", "一連の候補をすべて採用"),
            review.accept_line,
            Text(
                "All lids of one gutter, or both edges of one curb, as far as undecided.",
                "同じ側溝の蓋、または同じ縁石の上端・下端のうち、未判定の候補をまとめて採用します。",
            ),
            "Shift+Return",
            "Shift+Enter",
        ),
        _of_queue(
            "review-reject-line",
            Text("Reject the whole line", "一連の候補をすべて却下"),
            review.reject_line,
            Text(
                "What was taken for a gutter or a curb and is none.",
                "側溝や縁石と誤って抽出された一連の候補をまとめて却下します。",
            ),
            "Shift+Del",
        ),
    )


def _orders(parts: WindowParts) -> tuple[Action, ...]:
    put = parts.of(Review).put_in_order
    return (
        _of_queue(
            "review-worst",
            Text("Order: least sure first", "順序: 信頼度の低い順"),
            partial(put, ReviewOrder.CONFIDENCE),
        ),
        _of_queue(
            "review-along",
            Text("Order: along the street", "順序: 道路に沿って"),
            partial(put, ReviewOrder.STREET),
        ),
        _of_queue("review-end", Text("End the review", "確認を終了"), parts.of(Review).close),
    )


def _hindsight(parts: WindowParts) -> tuple[Action, ...]:
    """What was decided, and what it says of the tools."""
    settings = parts.document.shared.view_settings

    def show_rejected() -> None:
        settings.set_shows_rejected(parts.window.actions_by_id["show-rejected"].isChecked())

    return (
        Action(
            "show-rejected",
            Text("Show rejected features", "却下した地物を表示"),
            show_rejected,
            "review",
            is_checkable=True,
            is_checked=settings.shows_rejected,
            hint=Text(
                "Draws what was rejected, thin and grey, in every view.",
                "却下した地物をすべてのビューに細い灰色で表示します。",
            ),
            needs_project=True,
        ),
        Action(
            "evaluation",
            Text("Evaluate the tools", "ツールの評価"),
            partial(parts.window.show_panel, "evaluation"),
            "review",
            hint=Text(
                "How often each tool was right, by what you accepted, rejected and drew yourself.",
                "採用・却下・手作図の結果から、ツールごとの精度を表示します。",
            ),
            needs_project=True,
        ),
    )
