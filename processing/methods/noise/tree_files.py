"""Boosted trees as ONNX files: one TreeEnsembleClassifier, read and written without a library.

An ONNX file is a protobuf message; the few fields that such a model has are read here directly,
so that nothing has to be installed to ask some trees. onnxruntime answers but does not show a
model's nodes, which the kernel of ``trees.py`` asks; the package ``onnx`` would read and write
them, and protobuf with it.

References
----------
ONNX IR specification (``onnx.proto``) and operator ``ai.onnx.ml.TreeEnsembleClassifier``,
version 1; Protocol Buffers, "Encoding".
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.protobuf_fields import (
    block_field,
    fields_of,
    first_field,
    number_field,
    varint,
)
from processing.methods.noise.trees import Trees

_GRAPH, _NODE, _ATTRIBUTE = 7, 1, 5  # of a model, of a graph, of a node
_NAME, _FLOATS, _INTS, _STRINGS, _TYPE = 1, 7, 8, 9, 20  # of an attribute
_FLOATS_TYPE, _INTS_TYPE, _STRINGS_TYPE, _STRING_TYPE, _STRING = 6, 7, 8, 3, 4
_IR_VERSION, _OPSET, _ML_OPSET = 8, 15, 1
_FLOAT_TENSOR, _INT64_TENSOR = 1, 7
_LEAF, _BRANCH = b"LEAF", b"BRANCH_LEQ"
_MORE, _LONGEST = 0x80, 10  # of a varint: the bit of a byte that another follows, most bytes
_MODES = "nodes_modes"  # says what the leaves say, too; a word a node takes long to read


_YES_OR_NO = np.array([0, 1], np.uint8)


class Forest(NamedTuple):
    """Trees that add to the sums of several classes.

    ``trees``; ``class_of`` (t,) int32: the class that each adds to; ``bases``: what each class has
    before any tree, one number where there are two; ``codes`` (k,) uint8: what the classes are.
    """

    trees: Trees
    class_of: NDArray[np.int32]
    bases: NDArray[np.float64]
    codes: NDArray[np.uint8]


class AveragedTrees(NamedTuple):
    """Trees each of which says how likely every class is; their mean counts.

    ``features`` (m,) int32: the column asked at each node, −1 at a leaf; ``thresholds`` (m,)
    float32: at most this goes to the next node, more to ``rights`` (m,) int32; ``leaf_of`` (m,)
    int32: of leaves, the row in ``shares`` (l, k) float32; ``roots`` (t,) int32; ``codes`` (k,)
    uint8: what the classes are.
    """

    features: NDArray[np.int32]
    thresholds: NDArray[np.float32]
    rights: NDArray[np.int32]
    leaf_of: NDArray[np.int32]
    shares: NDArray[np.float32]
    roots: NDArray[np.int32]
    codes: NDArray[np.uint8]


def read_averaged_trees(path: Path) -> AveragedTrees:
    """Read the trees that :func:`write_averaged_trees` wrote.

    Raises
    ------
    ValueError
        As :func:`read_trees`.
    """
    kept = _attributes_of(path)
    node_ids = _ints_of(kept["nodes_nodeids"])
    roots = np.flatnonzero(node_ids == 0)
    start = roots[_ints_of(kept["nodes_treeids"])]
    leaves = roots[_ints_of(kept["class_treeids"])] + _ints_of(kept["class_nodeids"])
    codes = _ints_of(kept["classlabels_int64s"]).astype(np.uint8)
    leaf_of = np.full(node_ids.size, -1, np.int32)
    different, rows = np.unique(leaves, return_inverse=True)
    leaf_of[different] = np.arange(different.size)
    shares = np.zeros((different.size, codes.size), np.float32)
    shares[rows, _ints_of(kept["class_ids"])] = _floats_of(kept["class_weights"]) * roots.size
    return AveragedTrees(
        np.where(leaf_of >= 0, -1, _ints_of(kept["nodes_featureids"])).astype(np.int32),
        _floats_of(kept["nodes_values"]).astype(np.float32),
        (start + _ints_of(kept["nodes_falsenodeids"])).astype(np.int32),
        leaf_of,
        shares,
        roots.astype(np.int32),
        codes,
    )


def write_averaged_trees(trees: AveragedTrees, path: Path, columns: int) -> None:
    """Write trees whose mean counts as an ONNX model.

    Its input and outputs are as of :func:`write_forest`.
    """
    nodes = np.arange(trees.features.size)
    rows, classes = np.nonzero(trees.shares)
    is_leaf = trees.features < 0
    leaves = np.flatnonzero(is_leaf)[np.argsort(trees.leaf_of[is_leaf])][rows]
    attributes = {
        **_node_attributes(trees, nodes + 1, leaves),
        "class_ids": _ints(classes),
        "classlabels_int64s": _ints(trees.codes),
        "class_weights": _floats(trees.shares[rows, classes] / trees.roots.size),
        "post_transform": _word(b"NONE"),
    }
    _write_model(attributes, path, columns, trees.codes.size)


def read_trees(path: Path) -> Trees:
    """Read the trees of an ONNX file.

    Raises
    ------
    ValueError
        The file holds no such model: a defect of the program, not of its input.
    """
    return read_forest(path).trees


def read_forest(path: Path) -> Forest:
    """Read the trees of an ONNX file with the classes that they add to.

    Raises
    ------
    ValueError
        As :func:`read_trees`.
    """
    kept = _attributes_of(path)
    node_ids = _ints_of(kept["nodes_nodeids"])
    roots = np.flatnonzero(node_ids == 0)
    start = roots[_ints_of(kept["nodes_treeids"])]
    thresholds = _floats_of(kept["nodes_values"])
    leaves = roots[_ints_of(kept["class_treeids"])] + _ints_of(kept["class_nodeids"])
    is_leaf = np.zeros(node_ids.size, np.bool_)
    is_leaf[leaves] = True
    thresholds[leaves] = _floats_of(kept["class_weights"])
    bases = _floats_of(kept["base_values"])
    class_of = np.zeros(roots.size, np.int32)
    class_of[_ints_of(kept["class_treeids"])] = _ints_of(kept["class_ids"])
    trees = Trees(
        np.where(is_leaf, -1, _ints_of(kept["nodes_featureids"])).astype(np.int32),
        thresholds,
        (start + _ints_of(kept["nodes_truenodeids"])).astype(np.int32),
        (start + _ints_of(kept["nodes_falsenodeids"])).astype(np.int32),
        roots.astype(np.int32),
        float(bases[0]),
    )
    codes = _ints_of(kept["classlabels_int64s"]).astype(np.uint8)
    return Forest(trees, class_of, bases, codes)


def write_trees(trees: Trees, path: Path, columns: int) -> None:
    """Write trees as an ONNX model.

    Its input ``features`` is (n, columns) float32; its outputs are ``label`` (n,) int64, 1 where
    the claim is likelier than not, and ``shares`` (n, 2) float32.
    """
    none = np.zeros(trees.roots.size, np.int32)
    write_forest(Forest(trees, none, np.array([trees.base]), _YES_OR_NO), path, columns)


def write_forest(forest: Forest, path: Path, columns: int) -> None:
    """Write trees with the classes that they add to as an ONNX model.

    Its input is as of :func:`write_trees`; its outputs are ``label`` (n,) int64, the code of the
    likeliest class, and ``shares`` (n, k) float32.
    """
    trees = forest.trees
    leaves = np.flatnonzero(trees.features < 0)
    class_of_leaf = forest.class_of[_trees_of(trees.roots, leaves)]
    attributes = {
        **_node_attributes(trees, trees.lefts, leaves),
        "class_ids": _ints(class_of_leaf),
        "classlabels_int64s": _ints(forest.codes),
        "class_weights": _floats(trees.thresholds[leaves]),
        "base_values": _floats(forest.bases),
        "post_transform": _word(b"LOGISTIC" if forest.bases.size == 1 else b"SOFTMAX"),
    }
    _write_model(attributes, path, columns, forest.codes.size)


def _node_attributes(
    trees: Trees | AveragedTrees, lefts: NDArray[np.integer], leaves: NDArray[np.integer]
) -> dict[str, bytes]:
    """What nodes ask and lead to, and the leaves, a row each, that give something to a class."""
    nodes = np.arange(trees.features.size)
    tree_of = _trees_of(trees.roots, nodes)
    starts, is_leaf = trees.roots[tree_of], trees.features < 0
    return {
        "nodes_treeids": _ints(tree_of),
        "nodes_nodeids": _ints(nodes - starts),
        "nodes_featureids": _ints(np.where(is_leaf, 0, trees.features)),
        "nodes_truenodeids": _ints(np.where(is_leaf, 0, lefts - starts)),
        "nodes_falsenodeids": _ints(np.where(is_leaf, 0, trees.rights - starts)),
        "nodes_missing_value_tracks_true": _ints(np.zeros(nodes.size, np.int64)),
        "class_treeids": _ints(tree_of[leaves]),
        "class_nodeids": _ints((nodes - starts)[leaves]),
        "nodes_values": _floats(np.where(is_leaf, 0.0, trees.thresholds)),
        _MODES: _modes(is_leaf),
    }


def _trees_of(roots: NDArray[np.int32], nodes: NDArray[np.integer]) -> NDArray[np.int64]:
    """The tree of each node."""
    return np.asarray(np.searchsorted(roots, nodes, "right") - 1, np.int64)


def _attributes_of(path: Path) -> dict[str, bytes]:
    (graph,) = fields_of(path.read_bytes(), _GRAPH)
    (node,) = fields_of(graph, _NODE)
    named = ((first_field(one, _NAME).decode(), one) for one in fields_of(node, _ATTRIBUTE))
    return {name: one for name, one in named if name != _MODES}


def _write_model(attributes: Mapping[str, bytes], path: Path, columns: int, classes: int) -> None:
    node = (
        block_field(1, b"features")
        + block_field(2, b"label")
        + block_field(2, b"shares")
        + block_field(4, b"TreeEnsembleClassifier")
        + b"".join(
            block_field(_ATTRIBUTE, block_field(_NAME, name.encode()) + content)
            for name, content in attributes.items()
        )
        + block_field(7, b"ai.onnx.ml")
    )
    graph = (
        block_field(_NODE, node)
        + block_field(2, b"zuka")
        + block_field(11, _tensor(b"features", _FLOAT_TENSOR, (columns,)))
        + block_field(12, _tensor(b"label", _INT64_TENSOR, ()))
        + block_field(12, _tensor(b"shares", _FLOAT_TENSOR, (classes,)))
    )
    path.write_bytes(
        number_field(1, _IR_VERSION)
        + block_field(2, b"zuka")
        + block_field(_GRAPH, graph)
        + block_field(8, block_field(1, b"") + number_field(2, _OPSET))
        + block_field(8, block_field(1, b"ai.onnx.ml") + number_field(2, _ML_OPSET))
    )


def _ints(values: NDArray[np.integer]) -> bytes:
    packed = b"".join(varint(int(value)) for value in values)
    return block_field(_INTS, packed) + number_field(_TYPE, _INTS_TYPE)


def _floats(values: NDArray[np.floating]) -> bytes:
    return block_field(_FLOATS, values.astype("<f4").tobytes()) + number_field(_TYPE, _FLOATS_TYPE)


def _modes(is_leaf: NDArray[np.bool_]) -> bytes:
    words = b"".join(block_field(_STRINGS, _LEAF if one else _BRANCH) for one in is_leaf)
    return words + number_field(_TYPE, _STRINGS_TYPE)


def _word(word: bytes) -> bytes:
    return block_field(_STRING, word) + number_field(_TYPE, _STRING_TYPE)


def _tensor(name: bytes, kind: int, sizes: tuple[int, ...]) -> bytes:
    rows = block_field(1, block_field(2, b"n"))
    shape = rows + b"".join(block_field(1, number_field(1, size)) for size in sizes)
    return block_field(1, name) + block_field(
        2, block_field(1, number_field(1, kind) + block_field(2, shape))
    )


def _ints_of(attribute: bytes) -> NDArray[np.int64]:
    packed = np.frombuffer(b"".join(fields_of(attribute, _INTS)), np.uint8)
    ends = np.flatnonzero(packed < _MORE) + 1
    starts = np.concatenate([[0], ends[:-1]]).astype(np.int64)
    values = np.zeros(ends.size, np.uint64)
    for place in range(_LONGEST):
        there = starts + place < ends
        if not there.any():
            break
        seven = packed[starts[there] + place].astype(np.uint64) & np.uint64(_MORE - 1)
        values[there] |= seven << np.uint64(7 * place)
    return values.view(np.int64)


def _floats_of(attribute: bytes) -> NDArray[np.float64]:
    return np.frombuffer(b"".join(fields_of(attribute, _FLOATS)), "<f4").astype(np.float64)
