"""What an operator does to the views, and to candidates."""

from __future__ import annotations

import random

from app.review.review import Review
from processing.laboratory.bench.street_candidates import street_candidates
from processing.project.review.review_state import ReviewOrder
from tests.processing.project.candidates import found
from tests.properties.operator_input import Operator

_STANDINGS = (
    *("layout-drawing", "layout-checking", "layout-earthwork", "layout-two-screens"),
    *("section-back", "section-forward", "section-far-forward", "section-pin"),
    *("clip-everything", "clip-drive", "clip-selection", "clip-section"),
    *("image-upwards", "image-mirrored", "image-reversed", "another-image", "lock-scrolling"),
    "show-rejected",
)
_JUDGEMENTS = ("review-accept", "review-reject", "review-next", "review-back", "review-edit")


def stand_otherwise(operator: Operator, choice: random.Random) -> None:
    """Other layouts, sections, images, parts of the street."""
    operator.trigger(choice.choice(_STANDINGS))
    operator.settle()


def review(operator: Operator, choice: random.Random) -> None:
    """Judge some candidates; find some first where there are none."""
    parts = operator.parts
    document, drive_id = parts.document, parts.document.shared.view_settings.drive_id
    if not parts.of(Review).is_open or parts.of(Review).current is None:
        result = street_candidates(document.drive(drive_id), 4, choice.randrange(100))
        made = found(result, drive=drive_id)
        document.store_run(made)
        parts.of(Review).open((made.run.id,), choice.choice(list(ReviewOrder)))
    for _ in range(3):
        operator.trigger(choice.choice(_JUDGEMENTS))
