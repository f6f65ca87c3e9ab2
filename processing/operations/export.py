"""The map as the files that are handed in: all of them whole, or none of them there."""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from processing.core.errors import (
    MissingInput,
    OutOfRange,
    Unsuitable,
    report_as_user_error,
    use_one_of,
)
from processing.core.monitor import Monitor, PartMonitor, SilentMonitor
from processing.core.parameters import ParameterValue, fill_parameters, parameters_of
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.format import MAP, Content, Format, function_of
from processing.formats.format_list import FormatList
from processing.formats.map_delivery import MapDelivery, tell_nobody
from processing.formats.registry import FORMATS
from processing.formats.work_facts import WorkFacts
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Status
from processing.project.photos import photos_to_hand_in
from processing.project.results.label_export import write_labelled_points
from processing.recording.drive import Drive

_LEAST_VERTICES = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
_SET_SYSTEM = Text(
    "Set the project's reference system, for instance EPSG:6677.",
    "プロジェクトの座標参照系を設定してください（例: EPSG:6677）。",
)


@dataclass(frozen=True)
class ExportRequest:
    """Which files are wanted, where, and how.

    Attributes
    ----------
    formats : tuple of str
        Ids of formats in which maps are handed in.
    folder : Path
        Made if it is missing; files of the same names in it are replaced.
    language : "en" or "ja"
        Of the ledgers' headers.
    options : mapping of str to value
        What is chosen for the formats, by the ids that they declare; defaults for the rest.
    candidates : bool
        Whether features that nobody has judged are handed in too.
    never : tuple of Path
        Delivered files, which must not be overwritten.
    """

    formats: tuple[str, ...]
    folder: Path
    language: Language = "ja"
    options: Mapping[str, ParameterValue] = field(default_factory=dict)
    candidates: bool = False
    never: tuple[Path, ...] = ()


def export(
    features: Iterable[Feature],
    catalogue: Catalogue,
    crs: str,
    request: ExportRequest,
    monitor: Monitor | None = None,
    *,
    drives: tuple[Drive, ...] = (),
    project: Path | None = None,
    work: WorkFacts | None = None,
    formats: FormatList = FORMATS,
    tell: Callable[[Text], None] = tell_nobody,
) -> tuple[Path, ...]:
    """Write the map's accepted features in each format that is asked for.

    A map without features gives files without features, where their format has such. Files take
    their names when the last one is whole: an error, a cancel or a full disk leaves no trace.

    Parameters
    ----------
    features : iterable of Feature
        Written in their order; rejected ones never, candidates if the request says so.
    crs : str
        ``EPSG:n``; empty where it is not known: the files then say so, nothing is guessed.
    drives : tuple of Drive
        Whose points are written with their labels.
    project : Path, optional
        Its folder: files are named after it; pictures in it go beside files that name them.
    work, tell
        As of :class:`MapDelivery`.

    Returns
    -------
    tuple of Path
        The files, in the order of the formats, and the pictures.

    Raises
    ------
    OutOfRange
        No such format, option or reference system; a number or character that can't be written.
    Unsuitable
        A feature that isn't whole, or that a format can't hold; nothing that any has a place for.
    MissingInput, InUse, NoSpace, BadFile, Cancelled
        A format needs a reference system; what stands against writing. Nothing was written.
    """
    monitor = monitor or SilentMonitor()
    chosen = check_formats(request.formats, formats)
    _check_options(request.options, formats)
    _check_needs(chosen, crs)
    every = tuple(features)
    wanted = tuple(one for one in every if _is_wanted(one, request))
    _check_features(wanted, catalogue)
    wanted, pictures = _with_pictures(wanted, chosen, project)
    delivery = MapDelivery(
        wanted, catalogue, crs, request.language, request.options,
        write_points=partial(write_labelled_points, drives), every_feature=every,
        name=MAP if project is None else project.stem, drives=drives, tell=tell,
        work=work or WorkFacts(crs=crs),
    )  # fmt: skip
    return _write(delivery, chosen, request, monitor, pictures)


def _with_pictures(
    features: tuple[Feature, ...], chosen: Sequence[Format], project: Path | None
) -> tuple[tuple[Feature, ...], dict[str, Path]]:
    """Features as the files name their pictures, and these; points alone name none."""
    if project is None or not any(one.has_attributes for one in chosen):
        return features, {}
    return photos_to_hand_in(features, project)


def check_formats(ids: Sequence[str], formats: FormatList = FORMATS) -> tuple[Format, ...]:
    """The formats of some ids, in their order.

    Raises
    ------
    OutOfRange
        There is no such format, or none is named; names those in which maps are handed in.
    """
    known = {one.id: one for one in formats.maps()}
    for id_ in ids or ("",):
        if id_ not in known:
            raise OutOfRange(
                Text("There is no such format.", "そのような形式はありません。"),
                Text.same(id_ or "–"),
                use_one_of(known),
            )
    return tuple(known[id_] for id_ in ids)


def _write(
    delivery: MapDelivery,
    chosen: Sequence[Format],
    request: ExportRequest,
    monitor: Monitor,
    pictures: Mapping[str, Path],
) -> tuple[Path, ...]:
    """Write the files under temporary names, and give them their own in the end."""
    paths: list[Path] = []
    with ExitStack() as whole:

        def position(name: str) -> Path:
            path = request.folder / name
            temporary = whole.enter_context(write_safely(path, never=request.never))
            paths.append(path)
            return temporary

        for number, one in enumerate(chosen):
            monitor.check()
            monitor.report(number / len(chosen), _saying(one, delivery.crs))
            part = PartMonitor(monitor, number / len(chosen), (number + 1) / len(chosen))
            if one.writes_map:
                function_of(one.writes_map)(delivery, position, part)
            else:
                path = position(f"{delivery.name}{one.ending}")
                one.writer(Content.FEATURES)(path, delivery, part)
        for name, picture in pictures.items():
            monitor.check()
            copy = position(name)
            with report_as_user_error(picture):
                shutil.copyfile(picture, copy)
    if not paths and all(Content.FEATURES in one.writes for one in chosen):
        raise _nothing_to_write(chosen)
    return tuple(paths)


def _nothing_to_write(chosen: Sequence[Format]) -> Unsuitable:
    names = [one.name for one in chosen]
    return Unsuitable(
        Text(
            "The map has nothing that such a file can hold.",
            "この形式で書き出せる地物がありません。",
        ),
        Text(", ".join(one.en for one in names), "、".join(one.ja for one in names)),
        Text(
            "Accept or draw features first; nothing was written.",
            "先に地物を採用または作図してください。何も書き込まれていません。",
        ),
    )


def _is_wanted(feature: Feature, request: ExportRequest) -> bool:
    return feature.status is Status.ACCEPTED or (
        request.candidates and feature.status is Status.CANDIDATE
    )


def _saying(one: Format, crs: str) -> Text:
    title = one.map_title or one.name
    if not crs:
        return Text(
            "{title}; the reference system is not known",
            "{title}（座標参照系は不明のまま出力します）",
        ).filled(title=title)
    return title


def _check_options(options: Mapping[str, ParameterValue], formats: FormatList) -> None:
    """Refuse options that no format has, and values outside their limits."""
    known = {option.id for option in formats.map_options()}
    for id_ in options:
        if id_ not in known:
            raise OutOfRange(
                Text("No format has such an option.", "そのような設定のある形式はありません。"),
                Text.same(id_),
                use_one_of(sorted(known)),
            )
    for one in formats.maps():
        if one.options is not None:
            own = {option.id for option in parameters_of(one.options)}
            fill_parameters(one.options, {id_: options[id_] for id_ in own & options.keys()})


def _check_needs(chosen: Sequence[Format], crs: str) -> None:
    for one in chosen:
        if one.needs_crs and not crs:
            raise MissingInput(
                Text(
                    "The format needs the reference system, which isn't known.",
                    "この形式の書き出しには座標参照系が必要です。",
                ),
                one.name,
                _SET_SYSTEM,
            )
    if crs:
        _check_crs(crs)


def _check_crs(crs: str) -> None:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        CRS.from_user_input(crs)
    except CRSError as error:
        raise OutOfRange(
            Text("There is no such reference system.", "そのような座標参照系はありません。"),
            Text.same(crs),
            _SET_SYSTEM,
        ) from error


def _check_features(features: Iterable[Feature], catalogue: Catalogue) -> None:
    for feature in features:
        _check_feature(feature, catalogue)


def _check_feature(feature: Feature, catalogue: Catalogue) -> None:
    remedy = Text(
        "Correct or delete the feature; nothing was written.",
        "地物を修正または削除してください。何も書き込まれていません。",
    )
    where = Text(f"{feature.kind}, feature {feature.id}", f"{feature.kind}、地物 {feature.id}")
    if feature.kind not in catalogue:
        what = Text("The catalogue has no such kind.", "カタログにない種別です。")
        raise Unsuitable(what, where, remedy)
    least = _LEAST_VERTICES[feature.geometry]
    if len(feature.vertices) < least:
        what = Text(
            f"It has {len(feature.vertices)} of at least {least} vertices.",
            f"頂点が{len(feature.vertices)}個しかありません（{least}個以上必要）。",
        )
        raise Unsuitable(what, where, remedy)
    if not all(math.isfinite(value) for vertex in feature.vertices for value in vertex.xyz):
        what = Text("A coordinate is no number.", "座標が数値ではありません。")
        raise OutOfRange(what, where, remedy)
