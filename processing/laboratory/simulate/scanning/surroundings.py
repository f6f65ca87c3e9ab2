"""The part of a street that is seen from one of its sections, ready to be cast at."""

from __future__ import annotations

from collections.abc import Callable

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.mesh import Mesh


def scene_around(
    street: Street, row: int, reach_m: float, check: Callable[[], None]
) -> RaycastScene:
    """Everything within a reach of a section.

    Parameters
    ----------
    row : int
        Of the street's plans.
    reach_m : float
        Along the road, from the section's ends.
    check : callable
        Raises when the work shall end; asked before each section.
    """
    plan = street.plans[row]
    near = street.within(plan.start_m - reach_m, plan.end_m + reach_m)
    meshes = []
    for one in near:
        check()
        meshes.append(street.section(one).mesh)
    mesh = Mesh.joined(meshes)
    check()
    middle = (plan.start_m + plan.end_m) / 2
    level = street.alignment.carriageway_height(middle, 0.0)
    return RaycastScene(mesh, street.alignment.at(middle, 0.0, level))
