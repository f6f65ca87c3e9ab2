"""The published local network: classes of flights by one waveform alone, and what it looked at.

It isn't what classifies: trees do, which are better and faster. It is shown beside them because
its last map lies over time, so that Grad-CAM can say where in a waveform a class was seen.

1. Waveforms are put on 160 samples of 1 ns with the first return at 12.5, without their baseline
   and what isn't clear of the noise, in units of the flight's middle peak.
2. Three convolutions over time, each with ReLU and batch norm, the first two halved by pooling:
   maps of 40 positions. One linear layer makes scores of them, and these are told as shares.
3. Grad-CAM: the gradient of a score by the maps is the linear layer's weights. Each map counts by
   the mean of its own over time; what speaks for the class is left.

References
----------
Shinohara 2022, sections 3.3.1 and 3.5; Selvaraju et al. 2017, “Grad-CAM”, equations 1 and 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.protobuf_fields import (
    block_field,
    fields_of,
    first_field,
    number_field,
    varint,
)
from processing.recording.waveform_packets.echo_shapes import echo_shapes

F32 = NDArray[np.float32]

SAMPLES, FIRST_AT_NS = 160, 12.5
"""Of a waveform as the network sees it, 1 ns apart, and where its first return lies."""

LAYERS = 3
_POOLED = 4
_CLEAR_SIGMAS = 3.0
"""Less is taken for noise, as published waveforms were cleaned by the scanner's software."""

_EPSILON = 1e-5
"""Of batch norm."""

_NORM_PARTS = ("scale", "bias", "mean", "variance")

# Numbers of fields of onnx.proto, and of the kinds of values.
_MODEL_GRAPH, _GRAPH_NODE, _GRAPH_INITIALIZER, _GRAPH_INPUT, _GRAPH_OUTPUT = 7, 1, 5, 11, 12
_TENSOR_DIMS, _TENSOR_TYPE, _TENSOR_NAME, _TENSOR_RAW = 1, 2, 8, 9
_FLOAT, _INT64 = 1, 7
_IR_VERSION, _OPSET = 8, 13


class LocalNetwork:
    """The network's weights, and what it answers.

    Parameters
    ----------
    weights : mapping of str to float32 array
        ``conv0.weight`` (maps, maps before, 3), ``conv0.bias``, ``norm0.scale``, ``norm0.bias``,
        ``norm0.mean``, ``norm0.variance``, the same of 1 and 2; ``classes.weight`` (classes, maps x
        40) and ``classes.bias``.
    """

    def __init__(self, weights: Mapping[str, F32]) -> None:
        self.weights = {name: np.asarray(one, np.float32) for name, one in weights.items()}

    @property
    def class_gradients(self) -> F32:
        """(classes, maps, 40) of each class's score by the maps."""
        linear = self.weights["classes.weight"]
        return np.asarray(linear.reshape(len(linear), -1, SAMPLES // _POOLED), np.float32)

    def maps(self, waves: F32) -> F32:
        """(n, maps, 40) the last maps of waveforms (n, 160)."""
        found = np.asarray(waves, np.float32)[:, None]
        for layer in range(LAYERS):
            found = self._normed(layer, np.maximum(self._convolved(layer, found), 0))
            if layer < LAYERS - 1:
                found = np.maximum(found[:, :, ::2], found[:, :, 1::2])
        return found

    def scores(self, maps: F32) -> F32:
        """(n, classes) of maps (n, maps, 40)."""
        linear, bias = self.weights["classes.weight"], self.weights["classes.bias"]
        return np.asarray(maps.reshape(len(maps), -1) @ linear.T + bias, np.float32)

    def _convolved(self, layer: int, values: F32) -> F32:
        weight = self.weights[f"conv{layer}.weight"]
        padded = np.pad(values, ((0, 0), (0, 0), (1, 1)))
        length = values.shape[2]
        parts = [weight[:, :, at] @ padded[:, :, at : at + length] for at in range(3)]
        return np.asarray(sum(parts) + self.weights[f"conv{layer}.bias"][:, None], np.float32)

    def _normed(self, layer: int, values: F32) -> F32:
        scale, bias, mean, variance = (
            self.weights[f"norm{layer}.{part}"][:, None] for part in _NORM_PARTS
        )
        return np.asarray((values - mean) / np.sqrt(variance + _EPSILON) * scale + bias, np.float32)


def shares_of(scores: F32) -> F32:
    """(n, classes) how likely each class is."""
    raised = np.exp(scores - scores.max(axis=1, keepdims=True))
    return np.asarray(raised / raised.sum(axis=1, keepdims=True), np.float32)


def grad_cam(gradients: F32, maps: F32) -> F32:
    """Where a waveform speaks for a class, 0 to 1 of its own greatest.

    Parameters
    ----------
    gradients : (maps, positions) float32
        Of the class's score.
    maps : (maps, positions) float32

    Returns
    -------
    (160,) float32
        At each sample; 0 everywhere where nothing speaks for it.
    """
    seen = np.maximum(gradients.mean(axis=1) @ maps, 0)
    greatest = float(seen.max())
    if greatest > 0:
        seen = seen / greatest
    step = SAMPLES // maps.shape[1]
    middles = np.arange(maps.shape[1]) * step + (step - 1) / 2
    return np.asarray(np.interp(np.arange(SAMPLES), middles, seen), np.float32)


def scale_of(peaks: F32) -> float:
    """The middle of a flight's peaks over their baselines, counts; 1 without any."""
    there = peaks[peaks > 0]
    return float(np.median(there)) if there.size else 1.0


def cleaned_waves(
    samples: F32, lengths: NDArray[np.int32], interval_ns: Floats, first_ns: Floats
) -> F32:
    """(n, 160) float32 counts over the baseline as the network sees them, before scaling.

    Parameters
    ----------
    samples : (n, m) float32
        Counts as recorded; 0 behind the length.
    lengths : (n,) int32
    interval_ns, first_ns : (n,) float64
        Between samples; of the first return, after the first sample.
    """
    shapes = echo_shapes(samples, lengths, interval_ns, first_ns)
    grid, found = np.arange(SAMPLES) - FIRST_AT_NS, np.zeros((len(samples), SAMPLES), np.float32)
    for row, length in enumerate(lengths.tolist()):
        if not np.isfinite(first_ns[row]):
            continue
        wave = samples[row, :length] - shapes.baseline[row]
        wave[wave < _CLEAR_SIGMAS * shapes.noise[row]] = 0
        times = np.arange(length) * interval_ns[row] - first_ns[row]
        found[row] = np.interp(grid, times, wave, 0.0, 0.0)
    return found


def read_local_network(path: Path) -> LocalNetwork:
    """Read what :func:`write_local_network` wrote.

    Raises
    ------
    ValueError
        The file holds no such network: a defect of the program, not of its input.
    """
    (graph,) = fields_of(path.read_bytes(), _MODEL_GRAPH)
    weights = {}
    for tensor in fields_of(graph, _GRAPH_INITIALIZER):
        if int.from_bytes(first_field(tensor, _TENSOR_TYPE)) != _FLOAT:
            continue
        sizes = [_whole(one) for one in fields_of(tensor, _TENSOR_DIMS)]
        values = np.frombuffer(first_field(tensor, _TENSOR_RAW), "<f4")
        weights[first_field(tensor, _TENSOR_NAME).decode()] = values.reshape(sizes)
    return LocalNetwork(weights)


def write_local_network(network: LocalNetwork, path: Path) -> None:
    """Write the network as an ONNX model.

    Its input ``waves`` is (n, 160) float32; its outputs are ``shares`` and ``scores``, (n, classes)
    float32, and ``map`` (n, maps, 40) float32. The linear layer is the initializer
    ``classes.weight``.
    """
    weights = network.weights
    classes, last = weights["classes.weight"].shape[0], weights["conv2.bias"].size
    nodes = [_node("Unsqueeze", ("waves", "axis"), "wave")]
    before = "wave"
    for layer in range(LAYERS):
        conv = (before, f"conv{layer}.weight", f"conv{layer}.bias")
        nodes.append(_node("Conv", conv, f"conv{layer}", kernel_shape=(3,), pads=(1, 1)))
        nodes.append(_node("Relu", (f"conv{layer}",), f"relu{layer}"))
        norm = (f"relu{layer}", *(f"norm{layer}.{part}" for part in _NORM_PARTS))
        before = "map" if layer == LAYERS - 1 else f"norm{layer}"
        nodes.append(_node("BatchNormalization", norm, before))
        if layer < LAYERS - 1:
            halved = {"kernel_shape": (2,), "strides": (2,)}
            nodes.append(_node("MaxPool", (before,), f"pool{layer}", **halved))
            before = f"pool{layer}"
    nodes.append(_node("Flatten", ("map",), "flat"))
    nodes.append(_node("Gemm", ("flat", "classes.weight", "classes.bias"), "scores", transB=1))
    nodes.append(_node("Softmax", ("scores",), "shares", axis=1))
    graph = b"".join(block_field(_GRAPH_NODE, one) for one in nodes) + block_field(2, b"zuka")
    tensors = [_tensor(name, one) for name, one in sorted(weights.items())]
    tensors.append(_tensor("axis", np.ones(1, np.int64)))
    graph += b"".join(block_field(_GRAPH_INITIALIZER, one) for one in tensors)
    graph += block_field(_GRAPH_INPUT, _value("waves", (SAMPLES,)))
    outputs = {"shares": (classes,), "scores": (classes,), "map": (last, SAMPLES // _POOLED)}
    for name, sizes in outputs.items():
        graph += block_field(_GRAPH_OUTPUT, _value(name, sizes))
    opset = block_field(1, b"") + number_field(2, _OPSET)
    head = number_field(1, _IR_VERSION) + block_field(2, b"zuka")
    path.write_bytes(head + block_field(_MODEL_GRAPH, graph) + block_field(8, opset))


def _whole(packed: bytes) -> int:
    """A whole number as it stands in a field."""
    return sum((byte & 0x7F) << 7 * place for place, byte in enumerate(packed))


def _node(
    kind: str, inputs: tuple[str, ...], output: str, **attributes: int | tuple[int, ...]
) -> bytes:
    found = b"".join(block_field(1, name.encode()) for name in inputs)
    found += block_field(2, output.encode()) + block_field(4, kind.encode())
    for name, value in attributes.items():
        content = block_field(1, name.encode())
        if isinstance(value, int):
            content += number_field(3, value) + number_field(20, 2)
        else:
            content += block_field(8, b"".join(varint(one) for one in value))
            content += number_field(20, 7)
        found += block_field(5, content)
    return found


def _tensor(name: str, values: F32 | NDArray[np.int64]) -> bytes:
    is_whole = values.dtype == np.int64
    found = b"".join(number_field(_TENSOR_DIMS, size) for size in values.shape)
    found += number_field(_TENSOR_TYPE, _INT64 if is_whole else _FLOAT)
    found += block_field(_TENSOR_NAME, name.encode())
    return found + block_field(_TENSOR_RAW, values.astype("<i8" if is_whole else "<f4").tobytes())


def _value(name: str, sizes: tuple[int, ...]) -> bytes:
    shape = block_field(1, block_field(2, b"n"))
    shape += b"".join(block_field(1, number_field(1, size)) for size in sizes)
    kind = number_field(1, _FLOAT) + block_field(2, shape)
    return block_field(1, name.encode()) + block_field(2, block_field(1, kind))
