"""The tool SIGNS: road signs with shape, size and facing, found or by positions that are given."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.cameras.cut_outs import Face, cut_outs
from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import file, least_confidence
from processing.core.text import Text
from processing.image.attributes.plate_points import PlatePlace, colours_on, has_colours
from processing.map.plate_colours import ground_colour
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.signs.asked_signs import (
    asked_signs,
    doubtful_numbers,
    is_about,
    sought_about,
    with_given_shapes,
    with_other_heights,
)
from processing.methods.road.signs.image_positions import sighted_positions
from processing.methods.road.signs.initial_positions import (
    InitialPosition,
    SignPixel,
    misplaced,
    read_positions,
)
from processing.methods.road.signs.road_signs import RoadSign, SoughtShapes, any_shape, road_signs
from processing.methods.road.signs.sign_diagnostics import sign_diagnostics
from processing.recording.drive import Drive
from processing.scoring.scorers import SIGN_SCORER
from processing.tools.tool import (
    Candidate,
    CandidateResult,
    CandidateValue,
    Needs,
    SurveyFinder,
    Tool,
    ToolButton,
)

_ONE_POST_M = 0.8
"""Between middles of plates that hang on one post, in plan: side by side, or back to back."""

_FOUND = 0.9
"""Of the progress: the rest is for pictures out of camera images."""

_FIRST = 0.6
"""Of the same: what is left is for plates that aren't as was given of them."""


@dataclass(frozen=True)
class SignParameters:
    """Where signs are known to be, and how sure one must be to be shown."""

    positions: str = file(
        name=Text("Initial positions", "初期位置"),
        explanation=Text(
            "A CSV file of rough positions (easting_m, northing_m, and where known height_m, "
            "shape, size_m), or of pixels of camera images (image, column_px, row_px; the same "
            "sign for one in several images): only these signs are measured. Without it all "
            "signs are looked for.",
            "概略位置（easting_m, northing_m、分かればheight_m, shape, size_m）または"
            "カメラ画像上の位置（image, column_px, row_px、複数の画像に写る標識はsignを共通にする）"
            "のCSVファイル。指定すると、その標識だけを計測します。指定しない場合は全ての標識を"
            "探します。",
        ),
        picture="sign/positions",
    )
    # Half of the F that can be reached is the limit that reaches it (Lipton et al. 2014). Of 377
    # signs of streets that were left out in turn 13 are false and 20 missed from 0.5 on, 8 and 23
    # from 0.6 on; a false one costs a key in the review, a missed one stays unseen.
    least_confidence: float = least_confidence(
        0.5,
        Text(
            "What is less likely to be a sign is left out.",
            "標識である見込みがこの値より低いものは出力しません。",
        ),
    )


def find_signs(
    drives: tuple[Drive, ...], parameters: SignParameters, monitor: Monitor
) -> CandidateResult:
    """Road signs of a survey: one result for all heads and passes.

    Raises
    ------
    BadFile, UserError
        The file of positions isn't a table of them, or can't be read.
    """
    if parameters.positions.strip():
        return _by_positions(drives, read_positions(Path(parameters.positions)), monitor)
    found = road_signs(drives, PartMonitor(monitor, 0.0, _FOUND))
    signs = [one for one in found if one.confidence >= parameters.least_confidence]
    note = _note(drives, found, signs)
    return _with_pictures(signs, drives, note, PartMonitor(monitor, _FOUND, 1.0))


def diagnose_signs(asked: RequestedPosition, parameters: SignParameters) -> tuple[Diagnostic, ...]:
    """The plates about a place with the outlines laid on them, and what speaks for each."""
    return sign_diagnostics(asked, parameters.least_confidence)


def _by_positions(
    drives: Sequence[Drive],
    given: Sequence[InitialPosition | SignPixel],
    monitor: Monitor,
) -> CandidateResult:
    """The signs of given positions; those without one are named."""
    sighted = sighted_positions(
        [one for one in given if isinstance(one, SignPixel)], drives, monitor
    )
    positions = [one for one in given if isinstance(one, InitialPosition)]
    positions += sighted.positions
    lowest = np.min([drive.info.lowest for drive in drives], axis=0)
    highest = np.max([drive.info.highest for drive in drives], axis=0)
    missed = misplaced(positions, lowest, highest)
    elsewhere = {*missed.outside, *missed.swapped, *missed.degrees}
    here = [one for one in positions if one.line not in elsewhere]

    def shapes_at(place: Floats) -> SoughtShapes | None:
        return any_shape(place) if is_about(place, here) else None

    def given_shapes_at(place: Floats) -> SoughtShapes | None:
        return sought_about(place, here, doubtful)

    found = asked_signs(road_signs(drives, PartMonitor(monitor, 0.0, _FIRST), shapes_at), here)
    doubtful = doubtful_numbers(found, here)
    if doubtful:
        again = road_signs(drives, PartMonitor(monitor, _FIRST, _FOUND), given_shapes_at)
        found = with_given_shapes(found, again, here, doubtful)
    signs = [found[number] for number in sorted(found)]
    nothing = tuple(one.line for number, one in enumerate(here) if number not in found)
    whole = replace(
        missed,
        nothing=nothing,
        unknown=sighted.unknown,
        unmet=sighted.unmet,
        heights=with_other_heights(found, here),
    )
    note = _joined(whole.note(), _unsure_facing(signs))
    return _with_pictures(signs, drives, note, PartMonitor(monitor, _FOUND, 1.0))


def _with_pictures(
    signs: Sequence[RoadSign], drives: Sequence[Drive], note: Text, monitor: Monitor
) -> CandidateResult:
    """Signs as candidates, each with its picture where camera images show its face."""
    candidates = _candidates(signs)
    if not any(drive.images for drive in drives):
        seen = [_point_colours(one, drives) for one in signs]
        return CandidateResult(_coloured(candidates, seen), note)
    faces = [
        Face(one.plate.outline - one.plate.centre + one.centre, one.plate.normal) for one in signs
    ]
    cut = cut_outs(faces, drives, monitor)
    pictured = [
        replace(one, picture=picture) for one, picture in zip(candidates, cut.pictures, strict=True)
    ]
    if cut.unread:
        unread = Text(
            "Camera images that can't be read: {count}; signs on them have no picture.",
            "読み込めないカメラ画像が{count}枚あり、写っている標識の写真はありません。",
        ).filled(count=cut.unread)
        note = _joined(note, unread)
    return CandidateResult(_coloured(pictured, cut.insides), note)


def _coloured(
    candidates: Sequence[Candidate], seen: Sequence[NDArray[np.uint8] | None]
) -> tuple[Candidate, ...]:
    """Candidates with the colour of the plate's ground, where what is seen of its face tells it."""
    told = [None if one is None else ground_colour(one) for one in seen]
    return tuple(
        one if colour is None else replace(one, attributes={**one.attributes, "colour": colour})
        for one, colour in zip(candidates, told, strict=True)
    )


def _point_colours(sign: RoadSign, drives: Sequence[Drive]) -> NDArray[np.uint8] | None:
    """Colours of the points on a sign's face; None of its back, or where points have none."""
    drive, plate = drives[sign.drive], sign.plate
    if not plate.evidence.front_seen or not has_colours(drive):
        return None
    return colours_on(drive, sign.point, _place_of(sign))


def _place_of(sign: RoadSign) -> PlatePlace:
    shape, normal = sign.plate.shape, sign.plate.normal
    return PlatePlace(
        sign.centre,
        float(np.degrees(np.arctan2(normal[0], normal[1]))),
        float(np.degrees(np.arcsin(np.clip(normal[2], -1, 1)))),
        wide_m=shape.wide_m,
        high_m=shape.high_m,
        turns=sign.plate.evidence.turns,
    )


def _note(drives: Sequence[Drive], found: Sequence[RoadSign], signs: Sequence[RoadSign]) -> Text:
    if not any(drive.count for drive in drives):
        return Text("The drive has no points.", "走行データに点がありません。")
    dull = [drive.info.name for drive in drives if _has_no_intensity(drive)]
    if dull:
        return Text(
            "Points have no intensity, or all the same, so that fronts and backs of signs look "
            "alike: {names}.",
            "反射強度がない（または一定の）ため、標識板の表と裏を区別できません: {names}",
        ).filled(names=", ".join(dull))
    if signs:
        return _unsure_facing(signs)
    if not found:
        return Text(
            "No upright plate was measured beside the road.",
            "道路沿いに、標識板とみなせる平らな板は計測されていません。",
        )
    return Text(
        f"None of {len(found)} flat things looks like a sign.",
        f"平らな物{len(found)}件のうち、標識とみなせるものはありませんでした。",
    )


def _joined(one: Text, other: Text) -> Text:
    return Text(f"{one.en} {other.en}".strip(), f"{one.ja}{other.ja}")


def _unsure_facing(signs: Sequence[RoadSign]) -> Text:
    """How many signs might as well face the other way; empty where none does."""
    count = sum(not one.plate.evidence.is_facing_sure for one in signs)
    if not count:
        return Text("", "")
    return Text(
        "Signs whose front and back can't be told apart by their brightness: {count} of {all}.",
        "明るさから表裏を判別できない標識があります（{all}件中{count}件）。",
    ).filled(count=count, all=len(signs))


def _has_no_intensity(drive: Drive) -> bool:
    step = max(1, drive.count // 10_000)
    return drive.count > 0 and not np.ptp(drive.columns["intensity"][::step])


def _candidates(signs: Sequence[RoadSign]) -> tuple[Candidate, ...]:
    places = np.array([one.centre[:2] for one in signs]).reshape(-1, 2)
    counts = [int((np.hypot(*(places - one.centre[:2]).T) <= _ONE_POST_M).sum()) for one in signs]
    return tuple(_candidate(one, count) for one, count in zip(signs, counts, strict=True))


def _candidate(sign: RoadSign, plates: int) -> Candidate:
    plate = sign.plate
    normal = plate.normal
    edge = float(plate.outline[:, 2].min() - plate.centre[2] + sign.centre[2]) - sign.ground_m
    facing = round(float(np.degrees(np.arctan2(normal[0], normal[1]))) % 360, 1)
    attributes: dict[str, CandidateValue] = {
        "shape": plate.shape.shape,
        "size_m": round(plate.shape.size_m, 3),
        "width_m": round(plate.shape.wide_m, 3),
        "plate_high_m": round(plate.shape.high_m, 3),
        "facing_deg": facing % 360,
        "height_m": round(float(sign.centre[2]) - sign.ground_m, 2),
        "lower_edge_m": round(edge, 2),
        "tilt_deg": round(float(np.degrees(np.arcsin(np.clip(normal[2], -1, 1)))), 1),
        "roll_deg": round(float(np.degrees(plate.evidence.roll_rad)), 1),
        "supplementary": sign.is_supplement,
        "plates": plates,
        "scan_lines": plate.evidence.turns,
        "front_seen": plate.evidence.front_seen,
        "facing_sure": plate.evidence.is_facing_sure,
    }
    if sign.post is not None:
        attributes["post"] = sign.post
    return Candidate(
        "sign",
        "point",
        sign.centre[None],
        np.array([sign.point], np.int64),
        sign.confidence,
        attributes,
        np.array([sign.drive], np.int64),
        own_points=sign.own_points,
        own_drives=sign.own_drives,
    )


SIGNS = Tool(
    id="signs",
    name=Text("Road signs", "道路標識の抽出"),
    explanation=Text(
        "Finds road signs on posts, poles, arms and walls, or those near given positions, and "
        "tells place, shape, size and facing from all heads and passes of a survey.",
        "支柱・電柱・アーム・壁面などの道路標識、または指定した概略位置の標識を"
        "全スキャナー・全走行のデータから抽出し、位置・形・寸法・向きを計測します。",
    ),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=SignParameters,
    method=SurveyFinder(find_signs),
    makes=("sign",),
    sought=("positions",),
    button=ToolButton(
        Text("Find road signs", "道路標識を抽出"), "Ctrl+Shift+F7", "mdi6.sign-direction"
    ),
    diagnostics=diagnose_signs,
    scorer=SIGN_SCORER,
)
