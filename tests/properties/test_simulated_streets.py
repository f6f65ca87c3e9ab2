"""Whatever street is ordered: it is made, imported, and no point is lost on the way."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import numpy as np
from hypothesis import Phase, given, settings
from hypothesis import strategies as some

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.street.styles import STYLES
from processing.laboratory.simulate.streets import simulate_street
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

MOBILE = [one.id for one in SENSORS.values() if one.kind == "mobile"]
REQUESTS = some.builds(
    StreetRequest,
    seed=some.integers(0, 2**31 - 1),
    length_m=some.floats(10.0, 14.0),
    style=some.sampled_from(sorted(STYLES)),
    sensor=some.sampled_from(MOBILE),
    speed_km_h=some.sampled_from([0.0, 10.0, 130.0]),
    passes=some.integers(1, 2),
    stops=some.booleans(),
    pulses=some.integers(60, 300),
    turns_per_s=some.floats(10.0, 60.0),
    drift_m=some.floats(0.0, 1.0),
    images=some.just(False),
)


@settings(max_examples=3, phases=(Phase.explicit, Phase.generate))
@given(REQUESTS)
def test_a_street_is_imported_as_it_was_recorded(request: StreetRequest) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        made = simulate_street(request, folder / "street", SilentMonitor())
        reported = json.loads((made.truth / "scene.json").read_text(encoding="utf-8"))["points"]
        labelled = {
            one.name.removesuffix(".labels.npy"): np.load(one).size
            for one in made.truth.glob("*.labels.npy")
        }
        assert reported == labelled
        import_request = ImportRequest(made.points, made.trajectories, made.images, made.crs)
        drives = [
            Drive(one) for one in import_drives(import_request, folder / "in", SilentMonitor())
        ]
        assert (
            sum(len(one.columns["xyz"]) for one in drives) == made.count == sum(reported.values())
        )
