"""The part of a street that is seen from one of its sections, ready to be cast at."""

from __future__ import annotations

from processing.simulate.mesh import Mesh
from processing.simulate.scanning.casting import Scene
from processing.simulate.street.street import Street


def scene_around(street: Street, row: int, reach_m: float) -> Scene:
    """Everything within a reach of a section.

    Parameters
    ----------
    row : int
        Of the street's plans.
    reach_m : float
        Along the road, from the section's ends.
    """
    plan = street.plans[row]
    near = street.within(plan.start_m - reach_m, plan.end_m + reach_m)
    mesh = Mesh.joined(street.section(one).mesh for one in near)
    middle = (plan.start_m + plan.end_m) / 2
    level = street.alignment.carriageway_height(middle, 0.0)
    return Scene(mesh, street.alignment.at(middle, 0.0, level))
