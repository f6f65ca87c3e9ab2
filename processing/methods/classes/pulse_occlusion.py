"""What the classes of flights looked at in one pulse: its waveform hidden a window at a time.

1. The points around a point are described anew as
   :mod:`processing.methods.classes.flight_classes` does, on ground that is found around it.
2. In a window of the pulse's waveform what stands above its baseline is cut off, and all returns
   of the pulse are measured anew in what is left. The thesis lays samples at zero: that is the
   baseline of its waveforms, which were cleaned, and a very dark echo in those of other
   digitizers. What lies below stays, so that the same baseline and noise are found: counts are
   whole numbers, and a median that is one of them off moves the energy of a whole packet.
3. What the trees lose of the class that the point has is what they saw in that window.

The models that come with the program are trees that ask measures of returns, averaged over cells
about as wide as points lie apart: half to two thirds of them hold one point, hardly one more than
three. So a pulse's returns change their own cells nearly alone, and the means around by their share
of the points there. Two questions are answered:

- this pulse alone: by how much its waveform could change the class of its point. All other pulses
  stay, and what the first trees say of other cells. Mostly nothing: surroundings outvote one pulse.
- together: as if the waveforms around had lost the same. All means change by as much as those of
  the point's own cell, what the first trees say around as much as what they say of it. It shows
  which part of such a waveform the trees use where one pulse is outvoted.

In both what the sensor delivered beside the waveform stays: positions, intensities and numbers of
returns; and the tones of the ground in plan, medians of nine places. Where shapes say all, as on
roofs and wires, nothing is lost in any window, and that is what is told.

References
----------
Shinohara 2022, section 3.5: occlusion sensitivity, 5 samples of 1 ns at a time; Zeiler & Fergus
2014.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.classes.aerial_cells import AerialPoints, last_and_only
from processing.methods.classes.class_models import ClassModels, flight_models
from processing.methods.classes.class_trees import class_shares
from processing.methods.classes.drive_classes import rows_seen_again, shares_of_rows
from processing.methods.classes.features import AGREE_LEVELS, REACH
from processing.methods.classes.flight_cells import (
    AROUND,
    columns_of_means,
    flight_cells,
    means_in_cells,
)
from processing.methods.classes.flight_classes import (
    FlightLight,
    flight_cell_m,
    ranks_of,
    sampled_points,
)
from processing.methods.classes.ground_strips import STRIP_COLUMNS
from processing.methods.ground.filters.adaptive import GroundAssumptions, find_ground
from processing.methods.waveforms.return_measures import (
    RETURN_MEASURES,
    PulseReference,
    measures_of_samples,
    return_measures,
)
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from processing.recording.waveforms import waveforms_of
from processing.section.cut import Cut
from processing.section.points_in_cut import points_in_cut

WINDOW_NS = 5.0
"""Length of what is hidden: the thesis' 5 samples of 1 ns, about a pulse long. In samples it would
be another length for each digitizer."""

_MOST_WINDOWS = 256
"""Windows begin at every sample, of longer waveforms at every so many."""

_NEAR_CELLS = REACH + 1.5 * 2 ** AGREE_LEVELS[-1]
"""How far points count, in cells: what the first trees say as far as the second ask, of cells whose
surroundings are whole."""

_MOST_NEAR, _MOST_GROUND = 400_000, 200_000
"""Points that are looked at: of more, every so many. The first is beyond any flight's; ground is
looked for as far as its largest things reach, in one of 100 points/m² in every sixth point."""

_BARE = 2, 11
"""Classes of points that are on the ground, of which the flight's light is taken."""

_NO_CLASS = Text(
    "The point has none of the six classes of flights.",
    "この点には、航空計測の6クラスが付いていません。",
)
_NO_WAVEFORM = Text("This point has no waveform.", "この点に波形はありません。")
_TOO_SHORT = Text(
    "The waveform is too short to be measured.", "波形が短く、リターンの形を求められません。"
)
_NO_REFERENCE = Text(
    "The waveforms of this flight don't tell the shape of its pulse.",
    "このデータの波形からは、パルスの形を求められません。",
)


@dataclass(frozen=True, eq=False)
class PulseOcclusion:
    """What a class hangs on in a waveform.

    Attributes
    ----------
    code : int
        The class that the point has.
    share : float
        How likely the trees find it with the waveform as it was recorded, 0 to 1.
    starts_ns : (w,) float64
        Where windows begin, after the first sample, rising.
    window_ns : float
        How long they are: whole samples, :data:`WINDOW_NS` at most half of one off.
    drops : (w,) float32
        By how much less likely the class is with a window hidden; below 0 where it is likelier.
    drops_together : (w,) float32
        The same with the pulses around.
    """

    code: int
    share: float
    starts_ns: Floats
    window_ns: float
    drops: NDArray[np.float32]
    drops_together: NDArray[np.float32]

    @property
    def middles_ns(self) -> Floats:
        """(w,) middles of the windows."""
        middles: Floats = self.starts_ns + self.window_ns / 2
        return middles


def occluded_pulse(
    drives: Sequence[Drive], drive: Drive, point: int, monitor: Monitor
) -> PulseOcclusion | Text:
    """What the class of a point hangs on in its waveform, or why that can't be said.

    Parameters
    ----------
    drives : sequence of Drive
        Strips that were flown and classified together.
    drive : Drive
        The point's, one of them.

    Raises
    ------
    BadFile, MissingInput, NoSpace, Cancelled
    """
    models = flight_models(with_waveforms=True)
    code = int(class_columns(drive.columns).codes_of(np.array([point]))[0])
    if code not in models.codes:
        return _NO_CLASS
    hidden = _hidden_pulse(drive, point)
    if isinstance(hidden, Text):
        return hidden
    lights = [_light_of(one) for one in drives]
    light = lights[drives.index(drive)]
    if light.pulse is None:
        return _NO_REFERENCE
    around = _Around(drives, lights, (drives.index(drive), point), monitor)
    changes = hidden.changes(light.pulse)
    shares = around.shares(hidden.points, changes, models)[:, :, models.codes == code][:, :, 0]
    alone, together = shares[:, :1] - shares[:, 1:]
    return PulseOcclusion(
        code, float(shares[0, 0]), hidden.starts_ns, hidden.window_ns, alone, together
    )


@dataclass(frozen=True, eq=False)
class _HiddenPulse:
    """The returns of a pulse, and its waveform as it is and with each window hidden.

    ``points`` (k,) int64, ``places_ns`` (k,); ``samples`` (w + 1, m), the first as recorded;
    ``starts_ns`` (w,).
    """

    points: Integers
    places_ns: Floats
    interval_ns: float
    samples: NDArray[np.float32]
    starts_ns: Floats
    window_ns: float

    def changes(self, pulse: PulseReference) -> NDArray[np.float32]:
        """(w + 1, k, RETURN_MEASURES) by how much the returns' measures differ; first by 0."""
        rows, returns = len(self.samples), self.points.size
        raw = measures_of_samples(
            np.repeat(self.samples, returns, axis=0),
            np.full(rows * returns, self.samples.shape[1], np.int32),
            np.full(rows * returns, self.interval_ns),
            np.tile(self.places_ns, rows),
        )
        told = return_measures(raw, pulse).reshape(rows, returns, RETURN_MEASURES)
        return np.asarray(told - told[:1], np.float32)


def _hidden_pulse(drive: Drive, point: int) -> _HiddenPulse | Text:
    waveforms = waveforms_of(drive)
    number = np.array([-1]) if waveforms is None else waveforms.pulse_of(np.array([point]))
    if waveforms is None or number[0] < 0:
        return _NO_WAVEFORM
    pulses = waveforms.pulses(number)
    length, interval_ns = int(pulses.lengths[0]), float(pulses.interval_ns[0])
    points = waveforms.points_of(int(number[0]))
    counts = waveforms.samples_of(number)[:, :length]
    shapes = echo_shapes(counts, pulses.lengths, pulses.interval_ns, np.zeros(1))
    baseline = float(shapes.baseline[0])
    if not np.isfinite(baseline):
        return _TOO_SHORT
    width = min(length, max(1, round(WINDOW_NS / interval_ns)))
    step = -(-(length - width + 1) // _MOST_WINDOWS)
    starts = np.arange(0, length - width + 1, step)
    samples = np.repeat(counts, starts.size + 1, axis=0)
    at = np.arange(length)
    is_hidden = (at >= starts[:, None]) & (at < starts[:, None] + width)
    samples[1:] = np.where(is_hidden, np.minimum(samples[1:], baseline), samples[1:])
    return _HiddenPulse(
        points,
        waveforms.location_ns(points),
        interval_ns,
        samples,
        np.asarray(starts * interval_ns, np.float64),
        width * interval_ns,
    )


def _light_of(drive: Drive) -> FlightLight:
    """The light of a classified drive, whose classes say what its ground is; made once."""

    def make() -> FlightLight:
        points = sampled_points(drive)
        bare = np.isin(class_columns(drive.columns).codes_of(points), _BARE)
        return FlightLight.of(drive, points, bare, waveforms_of(drive))

    return drive.kept("flight light", make)


class _Around:
    """The points around one of a flight, in cells with what the trees are told of them.

    Parameters
    ----------
    asked : tuple of int
        Number of a drive, and the point there.
    """

    def __init__(
        self,
        drives: Sequence[Drive],
        lights: Sequence[FlightLight],
        asked: tuple[int, int],
        monitor: Monitor,
    ) -> None:
        number, point = asked
        ids = tuple(one.id for one in drives)
        cell_m = drives[0].kept(("flight cell", ids), lambda: flight_cell_m(drives))
        middle = drives[number].xyz(np.array([point]))[0]
        near = [_points_near(one, middle, _NEAR_CELLS * cell_m, _MOST_NEAR) for one in drives]
        told = [
            light.told(one, own, waveforms_of(one))
            for one, own, light in zip(drives, near, lights, strict=True)
        ]
        self._returns, self._measures = (
            np.concatenate([one[part] for one in told]) for part in (0, 1)
        )
        points = _aerial_points(drives, near, middle, cell_m, monitor)
        self._is_ground, self._monitor = points.is_ground, monitor
        self._near, self._before = near[number], sum(one.size for one in near[:number])
        self._cells = flight_cells(
            points, self._returns, self._measures, ranks_of(lights), cell_m=cell_m, monitor=monitor
        )
        self._cell = int(self._cells.cell_of[self._place(np.array([point]))[0]])

    def shares(
        self, points: Integers, changes: NDArray[np.float32], models: ClassModels
    ) -> NDArray[np.float32]:
        """(2, r, classes) how likely classes are in the asked point's cell: alone, and together.

        Parameters
        ----------
        points : (k,) int64
            Of the same drive.
        changes : (r, k, RETURN_MEASURES) float32
            By how much their measures differ from what was recorded.
        """
        seen = rows_seen_again(self._cells, models, self._monitor)[self._cell]
        touched, changed = self._changed_cells(points, changes)
        means, weights = self._means_around(touched)
        is_own = touched == self._cell
        together = np.broadcast_to(is_own.astype(np.float32), weights.shape)
        return np.stack(
            [
                self._shares(seen, _moved(means, one, changed), one[:, is_own][:, 0], models)
                for one in (weights, together)
            ]
        )

    def _shares(
        self,
        seen: NDArray[np.float32],
        moved: Sequence[NDArray[np.float32]],
        own: NDArray[np.float32],
        models: ClassModels,
    ) -> NDArray[np.float32]:
        """(r, classes) of rows as ``seen``, but of other means; ``own`` (5,) the cell's part."""
        features, classes = self._cells.rows.shape[1], models.alone.codes.size
        rows = np.tile(seen, (len(moved[0]), 1))
        told = columns_of_means(moved, with_waveforms=True)
        end = features - STRIP_COLUMNS
        rows[:, end - told.shape[1] : end] = told
        alone = class_shares(models.alone, rows[:, :features], self._monitor)
        gained = alone - seen[features : features + classes]
        rows[:, features : features + classes] = alone
        for number, size in enumerate(AGREE_LEVELS, 1):
            start = features + number * classes
            rows[:, start : start + classes] += own[1 + AROUND.index(size)] * gained
        self._change_averaged(rows, own, models)
        return shares_of_rows(rows, features, models, self._monitor)

    def _change_averaged(
        self, rows: NDArray[np.float32], own: NDArray[np.float32], models: ClassModels
    ) -> None:
        """Let averaged trees, whose smoothed word the last columns are, look at rows anew."""
        if models.averaged is None:
            return
        features = self._cells.rows.shape[1]
        before = class_shares(models.averaged, self._cells.rows[self._cell][None], self._monitor)
        gained = class_shares(models.averaged, rows[:, :features], self._monitor) - before
        around = sum(own[1 + AROUND.index(size)] for size in AGREE_LEVELS)
        word = rows[:, -before.shape[1] :]
        # What the cells around said is kept: taken off their mean, it may come out below nothing.
        np.maximum(word + gained * (1 + around) / (1 + len(AGREE_LEVELS)), 0, out=word)

    def _place(self, points: Integers) -> Integers:
        """Where points of the asked one's drive are among those around; −1 where they aren't."""
        at = np.minimum(np.searchsorted(self._near, points), self._near.size - 1)
        return np.where(self._near[at] == points, at + self._before, -1)

    def _changed_cells(
        self, points: Integers, changes: NDArray[np.float32]
    ) -> tuple[Integers, NDArray[np.float32]]:
        """(q,) cells of some points, rising; (r, q, RETURN_MEASURES + 1) how their means change.

        Returns that are noise, or that lie far away, are in none.
        """
        places = self._place(points)
        changes, places = changes[:, places >= 0], places[places >= 0]
        touched, of = np.unique(self._cells.cell_of[places], return_inverse=True)
        lit = changes[:, :, 0] * self._is_ground[places]
        sums = np.zeros((len(changes), touched.size, RETURN_MEASURES + 1), np.float32)
        for number, cell in enumerate(of.tolist()):
            sums[:, cell, :-1] += changes[:, number]
            sums[:, cell, -1] += lit[:, number]
        count = np.bincount(self._cells.cell_of)[touched]
        return touched.astype(np.int64), np.asarray(sums / count[:, None], np.float32)

    def _means_around(self, touched: Integers) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """What the asked cell is told, and how much of it some cells say.

        (5, m) means in it and around it in the sizes of `AROUND`; (5, q) shares of the cells.
        """
        cells = self._cells
        own = means_in_cells(cells, self._is_ground, self._returns, self._measures)
        are_touched = np.arange(len(own))[:, None] == touched
        both = np.hstack([own, are_touched.astype(np.float32)])
        around = [both, *(cells.means_around(both, size, self._monitor) for size in AROUND)]
        told = np.stack([one[self._cell] for one in around])
        return told[:, : own.shape[1]], told[:, own.shape[1] :]


def _moved(
    means: NDArray[np.float32], weights: NDArray[np.float32], changed: NDArray[np.float32]
) -> list[NDArray[np.float32]]:
    """(r, m) each: means whose last columns change with those of some cells."""
    moved = np.repeat(means[:, None], len(changed), axis=1)
    moved[:, :, -changed.shape[2] :] += np.einsum("sq,rqm->srm", weights, changed)
    return list(moved)


def _aerial_points(
    drives: Sequence[Drive],
    near: Sequence[Integers],
    middle: Floats,
    cell_m: float,
    monitor: Monitor,
) -> AerialPoints:
    """Points with their ground, which is found around the middle."""
    habits = GroundAssumptions()
    reach_m = _NEAR_CELLS * cell_m + habits.widest_in(cell_m)
    wide = [one.xyz(_points_near(one, middle, reach_m, _MOST_GROUND)) for one in drives]
    ground = find_ground(lambda: iter(wide), habits, monitor)
    xyz = np.concatenate([one.xyz(own) for one, own in zip(drives, near, strict=True)])
    places = [last_and_only(one, own) for one, own in zip(drives, near, strict=True)]
    heights = np.nan_to_num(xyz[:, 2] - ground.heights_at(xyz[:, :2]), nan=0.0)
    is_last, is_only = (np.concatenate([one[part] for one in places]) for part in (0, 1))
    return AerialPoints(xyz - xyz.min(axis=0), heights, ground.is_ground(xyz), is_last, is_only)


def _points_near(drive: Drive, middle: Floats, reach_m: float, most: int) -> Integers:
    """(k,) int64, rising: a drive's points in a square, of any height, without noise."""
    east, north, height = middle.tolist()
    square = Cut((east, north, height), (1.0, 0.0), 2 * reach_m, reach_m)
    return points_in_cut(drive, square, most, hides_noise=True)
