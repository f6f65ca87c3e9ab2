"""What a project holds, as far as a user would miss it, without ids and times."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

from processing.project.project import Project
from processing.project.volumes.volume_store import VolumeStore
from tests.processing.project.drawn import features_of

State = Mapping[str, object]


def state_of(project: Path) -> State:
    """What a closed project holds; it is opened to read."""
    with closing(Project.open(project, writing=False)) as opened:
        features = sorted(
            f"{one.kind} {one.status.value} {[vertex.xyz for vertex in one.vertices]}"
            for one in features_of(opened).values()
        )
        drives = {
            drive.info.name: {
                path.name: path.read_bytes() for path in sorted(drive.folder.glob("*.bin"))
            }
            for drive in opened.drives
        }
        store = VolumeStore(project)
        volumes = [str(store.read_result(one).volumes) for one in store.all()]
        return {"features": features, "drives": drives, "volumes": volumes}
