"""Review actions: the queue of candidates, judged by one key each."""

from __future__ import annotations

from app.actions.action import Action
from app.window_parts import WindowParts
from processing.project.feature import Status
from processing.project.review_state import ReviewOrder
from processing.text import Text

QUEUE_KEYS = ("review-accept", "review-reject", "review-edit", "review-next", "review-back")
"""Actions whose keys work over the views and the review panel only, while a queue is open."""

_NOTHING_TO_REVIEW = Text(
    "There are no candidates to review: run a tool first.",
    "確認する候補がありません。先に処理を実行してください。",
)
_NO_QUEUE = Text("Start a review first.", "先に確認を開始してください。")


def review_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The review menu, from top to bottom."""
    review, document = parts.review, parts.document

    def start() -> None:
        features = document.features()
        runs = {one.provenance.run for one in features if one.status is Status.CANDIDATE} - {""}
        if not runs:
            document.told.emit(_NOTHING_TO_REVIEW)
            return
        parts.window.show_panel("review")
        if not review.is_open:
            review.open(sorted(runs), ReviewOrder.CONFIDENCE)

    def show_rejected() -> None:
        action = parts.window.actions_by_id["show-rejected"]
        document.shared.view_settings.set_shows_rejected(action.isChecked())

    def evaluate() -> None:
        parts.window.show_panel("evaluation")

    def in_order(order: ReviewOrder) -> None:
        review.put_in_order(order)

    return (
        Action(
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
        ),
        *_judgements(parts),
        Action(
            "review-worst",
            Text("Order: least sure first", "順序: 信頼度の低い順"),
            lambda: in_order(ReviewOrder.CONFIDENCE),
            "review",
            needs_project=True,
            why_disabled=_NO_QUEUE,
        ),
        Action(
            "review-along",
            Text("Order: along the street", "順序: 道路に沿って"),
            lambda: in_order(ReviewOrder.STREET),
            "review",
            needs_project=True,
            why_disabled=_NO_QUEUE,
        ),
        Action(
            "review-end",
            Text("End the review", "確認を終了"),
            review.close,
            "review",
            needs_project=True,
            why_disabled=_NO_QUEUE,
        ),
        Action(
            "show-rejected",
            Text("Show rejected features", "却下した地物を表示"),
            show_rejected,
            "review",
            is_checkable=True,
            is_checked=document.shared.view_settings.shows_rejected,
            hint=Text(
                "Draws what was rejected, thin and grey, in every view.",
                "却下した地物をすべてのビューに細い灰色で表示します。",
            ),
            needs_project=True,
        ),
        Action(
            "evaluation",
            Text("Evaluate the tools", "ツールの評価"),
            evaluate,
            "review",
            hint=Text(
                "How often each tool was right, by what you accepted, rejected and drew yourself.",
                "採用・却下・手作図の結果から、ツールごとの精度を表示します。",
            ),
            needs_project=True,
        ),
    )


def _judgements(parts: WindowParts) -> tuple[Action, ...]:
    """What the keys of the queue do."""
    review = parts.review

    def judged(id_: str, text: Text, keys: tuple[str, ...], hint: Text) -> Action:
        act = {
            "review-accept": review.accept,
            "review-reject": review.reject,
            "review-edit": review.edit,
            "review-next": review.next,
            "review-back": review.back,
        }[id_]
        return Action(
            id_,
            text,
            act,
            "review",
            keys,
            hint=hint,
            needs_project=True,
            why_disabled=_NO_QUEUE,
        )

    return (
        judged(
            "review-accept",
            Text("Accept and go on", "採用して次へ"),
            ("Return", "Enter"),
            Text("The candidate becomes part of the map.", "候補を地図に採用します。"),
        ),
        judged(
            "review-reject",
            Text("Reject and go on", "却下して次へ"),
            ("Del",),
            Text(
                "The candidate is kept as rejected, to judge the tool by.",
                "候補を却下します（ツールの評価のために記録は残ります）。",
            ),
        ),
        judged(
            "review-edit",
            Text("Correct the candidate", "候補を修正"),
            ("E",),
            Text(
                "Takes the tool that moves vertices; accept when it is right.",
                "頂点編集ツールに切り替えます。直したら採用してください。",
            ),
        ),
        judged(
            "review-next",
            Text("Leave for later", "保留して次へ"),
            ("N",),
            Text("Goes on; the candidate stays undecided.", "未判定のまま次へ進みます。"),
        ),
        judged(
            "review-back",
            Text("Back", "前へ戻る"),
            ("B",),
            Text("Shows the candidate before.", "前の候補を表示します。"),
        ),
    )
