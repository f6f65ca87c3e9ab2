"""Camera: where a point of the ground falls in an image, and which way a pixel looks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.recording.camera_images.image_list import CameraImage

_UNDISTORT_STEPS = 20
"""Of the iteration that takes distortion off; of usual lenses ten leave less than a thousandth of a
pixel."""


@dataclass(frozen=True)
class Camera:
    """One oriented image.

    Notes
    -----
    A ground point X has camera coordinates ``R (X - C)``, R = R3(kappa) R2(phi) R1(omega): x to
    the right, y up, and the camera looks along -z. Perspective: column = cx + f x / -z, row =
    cy - f y / -z. Equirectangular: the image centre (cx, cy) looks along -z; columns count
    width / 360° to the right, rows height / 180° downwards.

    Brown's distortion acts on (x / -z, y / z), that is with y down like the rows, in the order
    and with the signs of OpenCV: k1, k2, p1, p2, k3.

    References
    ----------
    Kraus, Photogrammetry (2007), section 2.1; Brown, Close-range camera calibration (1971).
    """

    image: CameraImage

    @cached_property
    def rotation(self) -> NDArray[np.float64]:
        """(3, 3) float64, project axes to camera axes."""
        angles = (self.image.omega_deg, self.image.phi_deg, self.image.kappa_deg)
        (so, sp, sk), (co, cp, ck) = np.sin(np.radians(angles)), np.cos(np.radians(angles))
        r1 = np.array([[1, 0, 0], [0, co, so], [0, -so, co]])
        r2 = np.array([[cp, 0, -sp], [0, 1, 0], [sp, 0, cp]])
        r3 = np.array([[ck, sk, 0], [-sk, ck, 0], [0, 0, 1]])
        return np.asarray(r3 @ r2 @ r1, dtype=np.float64)

    def pixels_of(self, xyz: ArrayLike) -> NDArray[np.float64]:
        """Where ground points fall.

        Parameters
        ----------
        xyz : (n, 3) float64
            Project CRS, m.

        Returns
        -------
        (n, 2) float64
            Column and row, maybe outside the image; NaN for points behind the camera or so far
            aside that the distortion is not defined there.
        """
        seen = (np.asarray(xyz, dtype=np.float64) - np.array(self.image.xyz)) @ self.rotation.T
        x, y, forward = seen[:, 0], -seen[:, 1], -seen[:, 2]
        if self.image.projection == "equirectangular":
            right = np.arctan2(x, forward) * self.image.width_px / (2 * np.pi)
            down = np.arctan2(y, np.hypot(x, forward)) * self.image.height_px / np.pi
        else:
            forward = np.where(forward > 0, forward, np.nan)
            right, down = self._distort_rays(x / forward, y / forward)
            right, down = right * self.image.focal_px, down * self.image.focal_px
        return np.column_stack([self.image.cx_px + right, self.image.cy_px + down])

    def shows(self, pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of (n, 2) columns and rows lie inside the image; False for NaN."""
        columns, rows = pixels[:, 0], pixels[:, 1]
        inside = (columns >= 0) & (columns < self.image.width_px)
        return np.asarray(inside & (rows >= 0) & (rows < self.image.height_px))

    def distances_to(self, xyz: ArrayLike) -> NDArray[np.float64]:
        """(n,) float64, m from the perspective centre to (n, 3) ground points."""
        away = np.asarray(xyz, dtype=np.float64) - np.array(self.image.xyz)
        return np.asarray(np.sqrt((away * away).sum(axis=1)))

    def rays_of(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """Which way pixels look.

        Parameters
        ----------
        pixels : (n, 2) float64
            Column and row.

        Returns
        -------
        (n, 3) float64
            Unit vectors from the perspective centre, project axes.
        """
        position = np.asarray(pixels, dtype=np.float64)
        right, down = position[:, 0] - self.image.cx_px, position[:, 1] - self.image.cy_px
        if self.image.projection == "equirectangular":
            azimuth = right * 2 * np.pi / self.image.width_px
            below = down * np.pi / self.image.height_px
            level = np.cos(below)
            seen = np.column_stack(
                [level * np.sin(azimuth), -np.sin(below), -level * np.cos(azimuth)]
            )
        else:
            x, y = self._undistort_rays(right / self.image.focal_px, down / self.image.focal_px)
            seen = np.column_stack([x, -y, np.full(x.size, -1.0)])
            seen /= np.linalg.norm(seen, axis=1, keepdims=True)
        return np.asarray(seen @ self.rotation, dtype=np.float64)

    def _distort_rays(
        self, x: NDArray[np.float64], y: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        if not any(self.image.distortion):
            return x, y
        k1, k2, p1, p2, k3 = self.image.distortion
        # Beyond its turning point the polynomial would fold far points back into the image.
        r2 = x * x + y * y
        r2 = np.where(r2 < self._valid_r2, r2, np.nan)
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )

    def _undistort_rays(
        self, x: NDArray[np.float64], y: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        if not any(self.image.distortion):
            return x, y
        k1, k2, p1, p2, k3 = self.image.distortion
        u, v = x.copy(), y.copy()
        for _ in range(_UNDISTORT_STEPS):
            r2 = np.minimum(u * u + v * v, self._valid_r2)
            radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
            side = 2 * p1 * u * v + p2 * (r2 + 2 * u * u)
            below = p1 * (r2 + 2 * v * v) + 2 * p2 * u * v
            u, v = (x - side) / radial, (y - below) / radial
        return u, v

    @cached_property
    def _valid_r2(self) -> float:
        """Square of the radius up to which the radial polynomial rises."""
        k1, k2, _, _, k3 = self.image.distortion
        roots = np.roots([7 * k3, 5 * k2, 3 * k1, 1.0])
        real = roots[np.abs(roots.imag) < 1e-12].real
        return float(min((root for root in real if root > 0), default=np.inf))
