"""The local network as a file, its answers by another reader, and Grad-CAM by its own scores."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import onnxruntime
import pytest
from numpy.typing import NDArray

from processing.core.text import Text
from processing.methods.waveforms.local_network import (
    LocalNetwork,
    cleaned_waves,
    grad_cam,
    read_local_network,
    scale_of,
    shares_of,
    write_local_network,
)
from processing.methods.waveforms.pulse_grad_cam import (
    CLASS_CODES,
    PulseGradCam,
    grad_cam_of_pulse,
    shipped_local_network,
)
from processing.recording.drive import Drive
from processing.recording.waveforms import waveforms_of
from processing.scoring.points.six_classes import SIX
from tests.waveform_flight import import_flight, write_flight

F32 = NDArray[np.float32]


def small_network(seed: int = 0) -> LocalNetwork:
    rng = np.random.default_rng(seed)
    weights = {}
    into = 1
    for layer, out in enumerate((3, 4, 5)):
        weights[f"conv{layer}.weight"] = rng.normal(0, 0.7, (out, into, 3))
        weights[f"conv{layer}.bias"] = rng.normal(0, 0.1, out)
        weights[f"norm{layer}.scale"] = rng.uniform(-1, 2, out)
        weights[f"norm{layer}.bias"] = rng.normal(0, 0.1, out)
        weights[f"norm{layer}.mean"] = rng.normal(0, 0.1, out)
        weights[f"norm{layer}.variance"] = rng.uniform(0.5, 2, out)
        into = out
    weights["classes.weight"] = rng.normal(0, 0.2, (6, into * 40))
    weights["classes.bias"] = rng.normal(0, 0.2, 6)
    return LocalNetwork({name: one.astype(np.float32) for name, one in weights.items()})


def waves(count: int = 4) -> F32:
    rng = np.random.default_rng(1)
    return np.asarray(rng.uniform(0, 1, (count, 160)) ** 8, np.float32)


def test_a_network_is_the_same_from_its_file(tmp_path: Path) -> None:
    network = small_network()
    write_local_network(network, tmp_path / "n.onnx")
    again = read_local_network(tmp_path / "n.onnx")
    assert set(again.weights) == set(network.weights)
    for name, values in network.weights.items():
        np.testing.assert_array_equal(again.weights[name], values)


@pytest.mark.parametrize("shipped", [False, True])
def test_another_reader_answers_the_same(tmp_path: Path, *, shipped: bool) -> None:
    network = shipped_local_network() if shipped else small_network()
    write_local_network(network, tmp_path / "n.onnx")
    session = onnxruntime.InferenceSession(tmp_path / "n.onnx")
    shares, scores, maps = session.run(["shares", "scores", "map"], {"waves": waves()})
    own = network.maps(waves())
    np.testing.assert_allclose(own, maps, atol=1e-4, rtol=1e-4)
    np.testing.assert_allclose(network.scores(own), scores, atol=1e-3, rtol=1e-4)
    np.testing.assert_allclose(shares_of(network.scores(own)), shares, atol=1e-4)


def test_gradients_are_what_the_files_own_scores_change_by(tmp_path: Path) -> None:
    network = small_network()
    write_local_network(network, tmp_path / "n.onnx")
    session = onnxruntime.InferenceSession(tmp_path / "n.onnx")
    changed = waves()
    changed[:, 60:64] += 1e-2
    before, after = (session.run(["scores", "map"], {"waves": one}) for one in (waves(), changed))
    step = np.einsum("cmt,nmt->nc", network.class_gradients, after[1] - before[1])
    np.testing.assert_allclose(step, after[0] - before[0], atol=1e-5)
    # And position by position, by the score of a map that is a little larger there.
    maps = network.maps(waves(1)).astype(np.float32)
    for place in ((0, 0), (2, 17), (4, 39)):
        larger = maps.copy()
        larger[0, *place] += 0.5
        slope = (network.scores(larger) - network.scores(maps))[0] / 0.5
        np.testing.assert_allclose(slope, network.class_gradients[:, *place], atol=1e-4)


def test_grad_cam_is_the_weighted_sum_of_maps() -> None:
    gradients = np.array([[2.0] * 40, [-1.0] * 40], np.float32)
    maps = np.zeros((2, 40), np.float32)
    maps[0, 10], maps[0, 20], maps[1, 20], maps[1, 30] = 4, 2, 2, 8
    seen = grad_cam(gradients, maps)
    assert seen.shape == (160,)
    assert seen.max() == pytest.approx(1, abs=0.13)  # samples lie beside a position's middle
    assert seen[40:44].min() > 0.6
    assert seen[81] == pytest.approx(0.25, abs=0.05)
    assert seen[118:126].max() == 0
    assert grad_cam(gradients, np.zeros((2, 40), np.float32)).max() == 0


def test_waveforms_are_put_where_the_network_expects_them() -> None:
    samples = np.full((1, 120), 20, np.float32)
    samples[0] += np.tile([-1, 0, 1], 40)
    times = np.arange(120) * 0.5
    samples[0] += (100 * np.exp(-(((times - 30) / 1.5) ** 2))).astype(np.float32)
    found = cleaned_waves(samples, np.array([120], np.int32), np.array([0.5]), np.array([30.0]))
    assert found.shape == (1, 160)
    assert found[0].argmax() in (12, 13)
    assert found[0].max() == pytest.approx(90, rel=0.15)
    assert found[0, 30:].max() == 0
    assert scale_of(found.max(axis=1)) == found.max()
    assert scale_of(np.zeros(3, np.float32)) == 1


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    made = import_flight(write_flight(tmp_path / "flight.las", 300).path, tmp_path)
    codes = np.full(made.count, 2, np.uint8)
    codes[0] = 9
    codes.tofile(made.folder / "label.bin")
    return Drive(made.folder)


def test_a_point_of_a_flight_is_asked_about(drive: Drive) -> None:
    found = grad_cam_of_pulse(drive, 7, small_network())
    assert isinstance(found, PulseGradCam)
    assert found.code == 2
    assert found.likeliest in CLASS_CODES
    assert found.likeliest_share >= found.share
    assert found.times_ns.shape == found.seen.shape
    waveforms = waveforms_of(drive)
    assert waveforms is not None
    span = (waveforms.most_samples - 1) * float(waveforms.pulses(np.array([0])).interval_ns[0])
    assert found.times_ns.min() >= 0
    assert found.times_ns.max() <= span
    other = grad_cam_of_pulse(drive, 0, small_network())
    assert isinstance(other, PulseGradCam)
    assert other.code == other.likeliest


def test_classes_stand_in_the_order_of_the_tables() -> None:
    assert CLASS_CODES == SIX


def test_a_recording_whose_packets_are_gone_says_so(tmp_path: Path) -> None:
    path = write_flight(tmp_path / "flight.las", 20).path
    path.with_suffix(".wdp").unlink()
    found = grad_cam_of_pulse(import_flight(path, tmp_path), 7, small_network())
    assert isinstance(found, Text)
    assert "no waveform" in found.en
