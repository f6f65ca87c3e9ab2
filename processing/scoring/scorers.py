"""Every kind of result that can be scored against a truth, declared once.

A tool names its scorer in its declaration; ``zuka score``, the accuracy tables and the evaluation
in the window take it from there. A tool that classifies points has a
:class:`~processing.scoring.points.point_scores.PointScorer`, one that maps features a
:class:`~processing.scoring.features.file_scores.FeatureScorer`; echoes and waveforms of flights
have those of :mod:`processing.scoring.waveforms.flight_scores`.
"""

from __future__ import annotations

from processing.core.text import Text
from processing.scoring.features.barriers import barrier_score
from processing.scoring.features.clearances import clearance_score
from processing.scoring.features.covers import cover_score
from processing.scoring.features.curb_lines import curb_score
from processing.scoring.features.edges import edge_score
from processing.scoring.features.file_scores import FeatureScorer, VolumeScorer
from processing.scoring.features.gutters import gutter_score
from processing.scoring.features.markings import marking_score
from processing.scoring.features.poles import pole_score
from processing.scoring.features.signs import sign_score
from processing.scoring.features.trees import tree_score
from processing.scoring.features.volumes import volume_score
from processing.scoring.features.walls import wall_score
from processing.scoring.features.wires import wire_score
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.point_scores import (
    GROUND_CODES,
    NOISE_CODES,
    PointScorer,
    ground_score,
    noise_score,
)
from processing.scoring.points.six_classes import six_class_score
from processing.scoring.waveforms.flight_scores import (
    EchoScorer,
    WaveScorer,
    flight_echo_score,
    flight_wave_score,
)

Scorer = PointScorer | FeatureScorer | VolumeScorer | EchoScorer | WaveScorer
"""One per kind of result."""

NOISE_SCORER = PointScorer(
    tool="noise",
    name=Text("Noise", "ノイズ除去"),
    codes=NOISE_CODES,
    if_false=0,
    if_true=18,
    flags={"signal": (18, 0)},
    score_counts=noise_score,
)
GROUND_SCORER = PointScorer(
    tool="ground",
    name=Text("Ground", "地面抽出"),
    codes=GROUND_CODES,
    if_false=2,
    if_true=1,
    flags={"ground": (1, 2)},
    score_counts=ground_score,
)
CLASS_SCORER = PointScorer(
    tool="classify",
    name=Text("Classes", "分類"),
    codes=frozenset(),
    if_false=0,
    if_true=1,
    flags={},
    score_counts=class_score,
)
SIX_CLASS_SCORER = PointScorer(
    tool="waveform-classify",
    name=Text("Six classes of a flight", "航空計測の6クラス"),
    codes=frozenset(),
    if_false=0,
    if_true=1,
    flags={},
    score_counts=six_class_score,
)
CURB_SCORER = FeatureScorer("curbs", Text("Curbs", "縁石"), curb_score)
GUTTER_SCORER = FeatureScorer("gutters", Text("Covered gutters", "蓋付き側溝"), gutter_score)
SIGN_SCORER = FeatureScorer("signs", Text("Road signs", "道路標識"), sign_score)
TREE_SCORER = FeatureScorer("trees", Text("Street trees", "街路樹"), tree_score)
POLE_SCORER = FeatureScorer("poles", Text("Poles", "柱状物"), pole_score)
WIRE_SCORER = FeatureScorer("wires", Text("Wires", "架線"), wire_score)
MARKING_SCORER = FeatureScorer("markings", Text("Road markings", "区画線"), marking_score)
BARRIER_SCORER = FeatureScorer("barriers", Text("Barriers", "防護柵・柵"), barrier_score)
WALL_SCORER = FeatureScorer("walls", Text("Walls and buildings", "塀・擁壁・建物"), wall_score)
CLEARANCE_SCORER = FeatureScorer(
    "clearance", Text("Clearance over the road", "建築限界"), clearance_score
)
COVER_SCORER = FeatureScorer("covers", Text("Covers and inlets", "マンホール・蓋"), cover_score)
EDGE_SCORER = FeatureScorer("edges", Text("Edges of the carriageway", "車道の縁"), edge_score)
VOLUME_SCORER = VolumeScorer("volume", Text("Volumes", "土量"), volume_score)
ECHO_SCORER = EchoScorer(
    "waveform-decompose", Text("Echoes of waveforms", "波形の分解"), flight_echo_score
)
WAVE_SCORER = WaveScorer(
    "waveform-estimate", Text("Estimated waveforms", "波形の推定"), flight_wave_score
)
