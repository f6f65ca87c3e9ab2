"""The tool WAVEFORM-DECOMPOSE: a point for each surface that a waveform tells of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import file
from processing.core.text import Text
from processing.methods.waveforms.drive_echoes import EchoPoints, echoes_of
from processing.methods.waveforms.pulse_file import read_pulse
from processing.recording.drive import Drive
from processing.scoring.scorers import ECHO_SCORER
from processing.tools.tool import MadePoints, Needs, NewPoints, Tool

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
        yield _points(drive, found)


def _points(drive: Drive, found: EchoPoints) -> MadePoints:
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
