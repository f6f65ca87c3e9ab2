"""Which of the two sides of a plate is its face, by how bright scanners saw each."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.core.arrays import Floats, Integers
from processing.methods.road.signs.brightness import SHINING
from processing.methods.road.signs.piece_kernels import BRIGHTS, COUNT, SHINE, VIEW
from processing.methods.road.signs.scan_pieces import ScanPieces

_SHINES = 0.5
"""Share of bright points from which a side is a face."""

_BRIGHTER = 0.5
"""Of two sides that were seen, by how many standard deviations of diffuse things one has to be
brighter to be surely the face: heads and passes agree on one plate within a third of one."""

_FACE_ABOVE, _UNSURE_FROM, _UNSURE_TO = 1.5, 0.75, 2.5
"""Standard deviations above the middle of diffuse things, of a plate that was seen from one side:
bare metal and brown paint (reflectances 0.3 to 0.5) are up to 0.75 above, white paint two; what is
brighter than that is a face, and between them either may be."""

_LEAST_SIDE = 0.05
"""Share of a plate's points from which a side counts: fewer may be of its rim or its post."""


class PlateSides(NamedTuple):
    """What the two sides of a plate tell.

    Attributes
    ----------
    facing : (3,) float64
        Where its face looks.
    bright : float
        Share of bright points on the side where more are.
    front_seen : bool
        Whether one saw the side that is taken for the face.
    is_sure : bool
        Whether brightness tells the face from the back.
    both_seen : bool
        Whether both sides were seen.
    shine : float
        How bright the brighter side is that was seen, in standard deviations above the middle of
        diffuse things; NaN where nothing of a survey shines.
    faint : float
        Of what shines, how far it stays below the brightest faces of the survey, 0 to 1.
    """

    facing: Floats
    bright: float
    front_seen: bool
    is_sure: bool
    both_seen: bool
    shine: float
    faint: float


def sides_of(pieces: ScanPieces, members: Integers, normal: Floats) -> PlateSides:
    """Which side of a plate is its face.

    Parameters
    ----------
    members : (k,) int64
        Pieces on it.
    normal : (3,) float64
        Of its plane, one way or the other.

    Notes
    -----
    Where both were seen it is the brighter one, however dull both are: a scale may show a face
    hardly brighter than a white wall. A side alone is the face if it shines, and the back if it is
    as dull as metal on a scale on which other things of that recording shine.
    """
    values = pieces.values[members]
    towards = values[:, VIEW : VIEW + 3] @ normal < 0
    seen = [_Seen.of(values[side]) for side in (towards, ~towards)]
    least = _LEAST_SIDE * sum(one.points for one in seen)
    before, behind = (one if one.points >= least else _UNSEEN for one in seen)
    bright = max(before.share, behind.share)
    shows_faces = not math.isnan(pieces.face_shine)
    if before.points and behind.points:
        facing = normal if before.shine >= behind.shine else -normal
        is_sure = bright > _SHINES or abs(before.shine - behind.shine) >= _BRIGHTER
        shine = max(before.shine, behind.shine)
        is_face = True
    else:
        only, way = (before, normal) if before.points else (behind, -normal)
        shine = only.shine
        is_face = bright > _SHINES or shine >= _FACE_ABOVE
        is_told = shine > _UNSURE_TO or (shine < _UNSURE_FROM and shows_faces)
        is_sure = is_told or bright > _SHINES
        facing = way if is_face else -way
    return PlateSides(
        facing,
        bright,
        front_seen=is_face,
        is_sure=is_sure,
        both_seen=bool(before.points and behind.points),
        shine=shine if shows_faces else math.nan,
        faint=_faint(shine, pieces.face_shine) if bright > _SHINES else 0.0,
    )


def _faint(shine: float, face_shine: float) -> float:
    """How far what shines stays below what faces reach, 0 to 1."""
    span = face_shine - SHINING
    if not span > 0.0:
        return 0.0
    return min(max((face_shine - shine) / span, 0.0), 1.0)


class _Seen(NamedTuple):
    """A side as scanners saw it: its points, which share of them shines, how bright their mean is.

    ``shine`` is in standard deviations above the middle of diffuse things.
    """

    points: float
    share: float
    shine: float

    @staticmethod
    def of(values: Floats) -> _Seen:
        """From the pieces of scan lines on it."""
        points, brights, shine = values[:, [COUNT, BRIGHTS, SHINE]].sum(axis=0).tolist()
        return _Seen(points, brights / max(points, 1.0), shine / max(points, 1.0))


_UNSEEN = _Seen(0.0, 0.0, 0.0)
