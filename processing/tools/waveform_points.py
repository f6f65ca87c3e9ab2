"""The tools WAVEFORM-DECOMPOSE and WAVEFORM-ESTIMATE: echoes as points, waveforms for points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import ParameterChoice, choice, file, ratio
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.methods.waveforms.drive_echoes import EchoPoints, echoes_of
from processing.methods.waveforms.estimation.drive_waveforms import (
    EVEN_ENERGY,
    STEPS_OF_COUNT,
    EstimateRequest,
    PointsWithWaves,
    waveforms_for,
)
from processing.methods.waveforms.estimation.known_pulse import (
    has_intensities,
    intensity_of_count,
    response_from_points,
    response_of,
)
from processing.methods.waveforms.estimation.pulse_returns import (
    FIRST_SAMPLE_NS,
    HALF_LIGHT_M_NS,
    SAMPLES,
)
from processing.methods.waveforms.pulse_file import read_pulse
from processing.recording.drive import Drive
from processing.recording.waveform_packets.descriptors import WaveformDescriptor
from processing.scoring.scorers import ECHO_SCORER, WAVE_SCORER
from processing.tools.tool import (
    MadePackets,
    MadePoints,
    Needs,
    NewPoints,
    NewPointsTogether,
    Tool,
)

_MOST_RETURNS = 15
"""That LAS 1.4 can count."""

_MOST_INTENSITY = 65_535


@dataclass(frozen=True)
class WaveformDecomposeParameters:
    """What is known of the scanner."""

    pulse: str = file(
        name=Text("System's pulse", "システムパルス"),
        explanation=Text(
            "CSV with time_ns and amplitude: what the scanner records of one flat target. Empty: "
            "taken from the recording's own clear lone echoes.",
            "平らな1面からの受信波形を time_ns と amplitude の2列で記したCSVです。"
            "空欄の場合は、データ中の明瞭な単独エコーから求めます。",
        ),
    )


def make_echoes(
    drive: Drive, parameters: WaveformDecomposeParameters, monitor: Monitor
) -> Iterator[MadePoints]:
    """A point for each echo.

    Raises
    ------
    Unsuitable, BadFile, MissingInput, Cancelled
    """
    given = read_pulse(Path(parameters.pulse)) if parameters.pulse else None
    for found in echoes_of(drive, given, monitor):
        yield _echo_points(drive, found)


def _echo_points(drive: Drive, found: EchoPoints) -> MadePoints:
    echoes, columns = found.echoes, drive.columns
    delivered_s = np.asarray(columns["time"][found.owners]) - drive.info.clock_offset_s
    scanners = (
        {"point_source_id": np.asarray(columns["scanner"][found.owners]).astype(np.uint16)}
        if columns.has("scanner")
        else {}
    )
    return MadePoints(
        found.xyz,
        {
            "gps_time": delivered_s,
            "intensity": np.clip(np.rint(echoes.height), 0, _MOST_INTENSITY).astype(np.uint16),
            "return_number": np.minimum(found.number, _MOST_RETURNS).astype(np.uint8),
            "number_of_returns": np.minimum(found.count, _MOST_RETURNS).astype(np.uint8),
            **scanners,
        },
        {
            "amplitude": echoes.amplitude.astype(np.float32),
            "amplitude_sigma": echoes.amplitude_sigma.astype(np.float32),
            "echo_width_ns": echoes.width_ns.astype(np.float32),
            "range_sigma_m": found.range_sigma_m.astype(np.float32),
        },
    )


WAVEFORM_DECOMPOSE = Tool(
    id="waveform-decompose",
    name=Text("Echoes of waveforms", "波形の分解"),
    explanation=Text(
        "Writes a point for each surface that full waveforms tell of, also weak and close ones "
        "that the sensor left out: LAS or LAZ with the gps_time of the pulse, amplitude, width and "
        "their uncertainties.",
        "フルウェーブフォームを分解し、センサーが出力しなかった弱いエコーや近接したエコーも含めて、"
        "面ごとに1点をLAS・LAZに書き出します。パルスのgps_time、振幅、幅とその標準偏差が付きます。",
    ),
    group=Text("Waveforms", "波形"),
    needs=Needs.POINTS,
    parameters=WaveformDecomposeParameters,
    method=NewPoints(make_echoes),
    scorer=ECHO_SCORER,
)


_PS_IN_NS = 1000
_EVEN_COUNTS = 100.0
"""Height of a pulse's whole energy where no intensities are known: well within 8 bits."""


@dataclass(frozen=True)
class WaveformEstimateParameters:
    """What is known of the scanner."""

    pulse: str = file(
        name=Text("System's pulse", "システムパルス"),
        explanation=Text(
            "CSV with time_ns and amplitude: what the scanner records of one flat target. Empty: "
            "a Gaussian as long as the closest returns of one pulse say.",
            "平らな1面からの受信波形を time_ns と amplitude の2列で記したCSVです。"
            "空欄の場合は、同じパルスの最も近いリターンの間隔から長さを求めたガウス波形を使います。",
        ),
    )
    inputs: str = choice(
        "all",
        choices=(
            ParameterChoice("all", Text("Positions and intensities", "位置と反射強度")),
            ParameterChoice("positions", Text("Positions alone", "位置のみ")),
        ),
        name=Text("What is used", "使う情報"),
        explanation=Text(
            "Positions alone are also used where all intensities are the same.",
            "反射強度がすべて同じデータでは、位置のみを使います。",
        ),
    )
    intensity_of_count: float = ratio(
        0.0,
        low=0.0,
        high=65_535.0,
        name=Text("Intensity of one count", "1カウント当たりの反射強度"),
        explanation=Text(
            "How heights of 8 bits follow from intensities. 0: the whole range of the intensities "
            "(8, 12 or 16 bits) is 255 counts.",
            "反射強度から8ビットの波高を求める係数です。0の場合は、反射強度の全範囲"
            "（8、12、16ビット）を255カウントとします。",
        ),
    )


def make_waveforms(
    drives: tuple[Drive, ...], parameters: WaveformEstimateParameters, monitor: Monitor
) -> Iterator[MadePoints]:
    """The points of drives, each with the waveform of its pulse.

    Raises
    ------
    Unsuitable, BadFile, MissingInput, NoSpace, Cancelled
    """
    if parameters.pulse:
        pulse = response_of(*read_pulse(Path(parameters.pulse)))
    else:
        pulse = response_from_points(max(drives, key=_size_of))
    knows_intensity = parameters.inputs == "all" and any(map(has_intensities, drives))
    if knows_intensity:
        by = parameters.intensity_of_count or max(map(intensity_of_count, drives))
    else:
        by = EVEN_ENERGY / _EVEN_COUNTS
    with scratch_folder(drives[0].folder) as scratch:
        for found in waveforms_for(
            drives, EstimateRequest(pulse, knows_intensity, by), scratch, monitor
        ):
            yield _archive_points(drives[found.drive], found)


def _size_of(drive: Drive) -> int:
    return drive.count


def _archive_points(drive: Drive, found: PointsWithWaves) -> MadePoints:
    columns, here = drive.columns, found.points
    size = here.size
    kept = {
        name: np.asarray(columns[name][here]) if columns.has(name) else np.zeros(size, np.uint8)
        for name in ("intensity", "return_number", "number_of_returns", "classification")
    }
    angle = (
        {"scan_angle_deg": np.asarray(columns["scan_angle_deg"][here])}
        if columns.has("scan_angle_deg")
        else {}
    )
    return MadePoints(
        drive.xyz(here),
        {
            **kept,
            **angle,
            "user_data": np.zeros(size, np.uint8),
            "scanner": np.full(size, drive.info.scanner, np.uint16),
            "time": np.asarray(columns["time"][here]) - drive.info.clock_offset_s,
        },
        {},
        MadePackets(
            found.packet,
            (_PS_IN_NS * (found.after_ns + FIRST_SAMPLE_NS)).astype(np.float32),
            (-found.direction * (HALF_LIGHT_M_NS / _PS_IN_NS)).astype(np.float32),
            found.samples,
        ),
    )


WAVEFORM_ESTIMATE = Tool(
    id="waveform-estimate",
    name=Text("Estimated waveforms", "波形の推定"),
    explanation=Text(
        "Gives points that were delivered without waveforms those that their pulses are likely to "
        "have had: LAS of format 9 with a .wdp beside it, 160 samples of 1 ns, the first return at "
        "sample 12.5; gain times samples are counts of 8 bits.",
        "波形なしで納品された点群に、各パルスの推定波形を付けて書き出します。LASのポイント"
        "フォーマット9と .wdp で、1 ns間隔の160サンプル、最初のリターンは12.5サンプル目です。",
    ),
    group=Text("Waveforms", "波形"),
    needs=Needs.POINTS,
    parameters=WaveformEstimateParameters,
    method=NewPointsTogether(
        make_waveforms,
        WaveformDescriptor(
            16, SAMPLES, spacing_ps=_PS_IN_NS, gain=1.0 / STEPS_OF_COUNT, offset=0.0
        ),
    ),
    scorer=WAVE_SCORER,
)
