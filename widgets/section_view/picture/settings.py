"""SectionSettings: how sections are cut and shown, one value."""

from __future__ import annotations

from dataclasses import dataclass

EXAGGERATIONS = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True)
class SectionSettings:
    """What the bar of the section view sets.

    Attributes
    ----------
    width_m : float
        Thickness of the slab.
    step_m : float
        How far a key steps along the line.
    exaggeration : float
        How many times heights are drawn larger.
    is_along : bool
        Whether the slab lies along the line instead of across it.
    is_live : bool
        Whether the slab follows the mouse over lines in any view.
    is_by_distance : bool
        Whether points are coloured by their distance from the plane.
    shows_ground : bool
        Whether the ground that the tool “ground” found is drawn.
    shows_diagnostics : bool
        Whether the normalised scanline is drawn, with the places that tools look at on it.
    shows_waveforms : bool
        Whether pulses with waveforms are drawn along their rays.
    """

    width_m: float = 1.0
    step_m: float = 1.0
    exaggeration: float = 1.0
    is_along: bool = False
    is_live: bool = True
    is_by_distance: bool = False
    shows_ground: bool = True
    shows_diagnostics: bool = False
    shows_waveforms: bool = False

    @property
    def wanted(self) -> tuple[bool, bool, bool, bool]:
        """What is looked up: colours by distance, found ground, what tools look at, waveforms."""
        return (
            self.is_by_distance,
            self.shows_ground,
            self.shows_diagnostics,
            self.shows_waveforms,
        )
