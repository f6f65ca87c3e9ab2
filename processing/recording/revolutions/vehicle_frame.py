"""Points as the scanner saw them: beam vectors in the vehicle's frame, for kernels and samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.recording.columns.point_source import PointColumns
from processing.recording.vehicle_path.trajectory import Trajectory


@dataclass(frozen=True)
class Poses:
    """A trajectory as arrays that kernels take.

    Attributes
    ----------
    time : (m,) float64
    xyz : (m, 3) float64
    rotation : (m, 3, 3) float64
        Columns: the vehicle's forward, left and up axes. Between records they are interpolated
        element by element, which turns by the right angle to a few parts in a thousand of the
        angle between two records.
    """

    time: Floats
    xyz: Floats
    rotation: Floats

    @staticmethod
    def of(trajectory: Trajectory) -> Poses:
        """The poses at a trajectory's records."""
        time = np.ascontiguousarray(trajectory.time)
        return Poses(time, np.ascontiguousarray(trajectory.xyz), trajectory.rotations_at(time))

    def beams(self, points: PointColumns, every: int) -> tuple[Floats, Floats]:
        """Every n-th point's time and its place in the vehicle's frame.

        Returns
        -------
        time : (k,) float64
        beam : (k, 3) float64
            Forward, left, up, m: from the scanner where points know it, else from the trajectory's
            reference point. Points outside the trajectory's times are left out.
        """
        first = int(np.searchsorted(points.time, self.time[0]))
        last = int(np.searchsorted(points.time, self.time[-1], side="right"))
        chosen = slice(first, last, every)
        time = np.ascontiguousarray(points.time[chosen])
        positions = points.quantisation.metres(points.xyz[chosen])
        origins = np.empty((0, 3)) if points.origin is None else points.origin[chosen]
        beam = np.empty((time.size, 3))
        _beams_kernel(
            time, positions, np.ascontiguousarray(origins), self.time, self.xyz, self.rotation, beam
        )
        return time, beam


@kernel
def _beams_kernel(
    time: Floats,
    positions: Floats,
    origins: Floats,
    pose_time: Floats,
    pose_xyz: Floats,
    pose_rotation: Floats,
    beam: Floats,
) -> None:
    j = 0
    last = pose_time.shape[0] - 2
    for i in range(time.shape[0]):
        if pose_time[min(j + 8, last)] < time[i]:
            j = min(max(np.searchsorted(pose_time, time[i]) - 1, 0), last)
        while j < last and pose_time[j + 1] < time[i]:
            j += 1
        share = (time[i] - pose_time[j]) / (pose_time[j + 1] - pose_time[j])
        share = min(max(share, 0.0), 1.0)
        for axis in range(3):
            beam[i, axis] = 0.0
        for k in range(3):
            if origins.shape[0] > 0:
                base = origins[i, k]
            else:
                base = pose_xyz[j, k] + share * (pose_xyz[j + 1, k] - pose_xyz[j, k])
            offset = positions[i, k] - base
            for axis in range(3):
                start = pose_rotation[j, k, axis]
                beam[i, axis] += offset * (start + share * (pose_rotation[j + 1, k, axis] - start))


def warm_up() -> None:
    """Compile the kernel."""
    _beams_kernel(
        np.zeros(2),
        np.zeros((2, 3)),
        np.zeros((0, 3)),
        np.array([0.0, 1.0, 2.0]),
        np.zeros((3, 3)),
        np.zeros((3, 3, 3)),
        np.empty((2, 3)),
    )
