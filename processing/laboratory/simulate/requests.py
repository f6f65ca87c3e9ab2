"""What a user orders: the fields of the form in the window and of the command line."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.parameters import (
    ParameterChoice,
    angle,
    choice,
    count,
    file,
    length,
    ratio,
    switch,
)
from processing.core.text import Text
from processing.laboratory.simulate.airborne.flight_scene import FLIGHT_STYLES
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.street.styles import STYLES

_SEED = Text("Seed", "シード値")
_SEED_MEANING = Text(
    "A whole number; the same number gives the same street, to the last bit.",
    "整数。同じ値からは、まったく同じ道路が得られます。",
)
_STYLE = Text("Style", "種類")
_SENSOR = Text("Sensor", "センサー")
_OWN_SENSOR = Text("Own sensor file", "独自のセンサー定義ファイル")
_OWN_SENSOR_MEANING = Text(
    "Rates, beam and mounting of another sensor, in the form of the program's sensors.toml.",
    "別のセンサーの計測レート・ビーム・取付けを、付属のsensors.tomlの書式で指定します。",
)


def _sensors(kind: str) -> tuple[ParameterChoice, ...]:
    return tuple(ParameterChoice(one.id, one.name) for one in SENSORS.values() if one.kind == kind)


@dataclass(frozen=True)
class StreetRequest:
    """A street to be made and recorded.

    Attributes
    ----------
    own_sensor : str
        A file that describes another sensor; empty for none.
    speed_km_h : float
        0 for what is usual in this style.
    pulses, turns_per_s : int, float
        0 for those of the sensor.
    passes : int
        The second one comes back on the other side, and so on.
    drift_m : float
        Standard deviation of the delivered trajectory's error, which changes over minutes.
    attitude_deg, mounting_deg : float
        The same of the angles that the trajectory delivers, and of those at which each head is said
        to be mounted, which don't change during a pass.
    jumps_m, wander_m : float
        Steps in the delivered positions, and their random walk within a minute.
    control_per_km : float
        Surveyed points along the street.
    wear : float
        What time made of the kerb stones.
    avenue : bool
        Rows of large trees along both sides, with posts and lamps under their crowns.
    flush : bool
        Most sides have no curb: flush walks, shoulders of gravel and soil.
    noise : float
        How many times as many points of nothing as such a scanner usually gives.
    """

    seed: int = count(1, low=0, high=2**31 - 1, name=_SEED, explanation=_SEED_MEANING)
    length_m: float = length(
        120.0,
        low=10.0,
        high=100_000.0,
        name=Text("Length", "延長"),
        explanation=Text("How far the vehicle drives.", "車両が走行する距離。"),
    )
    style: str = choice(
        "urban",
        choices=tuple(ParameterChoice(one.id, one.name) for one in STYLES.values()),
        name=_STYLE,
    )
    sensor: str = choice("vq250", choices=_sensors("mobile"), name=_SENSOR)
    own_sensor: str = file(name=_OWN_SENSOR, explanation=_OWN_SENSOR_MEANING)
    speed_km_h: float = ratio(
        0.0,
        low=0.0,
        high=130.0,
        name=Text("Speed (km/h)", "走行速度 (km/h)"),
        explanation=Text(
            "0: what is usual on such a street.", "0 の場合は、その種類の道路で一般的な速度。"
        ),
    )
    passes: int = count(
        1,
        low=1,
        high=4,
        name=Text("Passes", "走行回数"),
        explanation=Text(
            "Every second one drives back on the other side.", "2回目は反対側の車線を戻ります。"
        ),
    )
    stops: bool = switch(
        default=False,
        name=Text("Waits at lights", "信号で停車する"),
        explanation=Text(
            "The vehicle stands still once or more while it scans.",
            "走行中に1回以上、計測しながら停車します。",
        ),
    )
    pulses: int = count(
        0,
        low=0,
        high=20_000,
        name=Text("Pulses per revolution", "1回転のパルス数"),
        explanation=Text("0: those of the sensor.", "0 の場合はセンサーの値。"),
    )
    turns_per_s: float = ratio(
        0.0,
        low=0.0,
        high=400.0,
        name=Text("Revolutions per second", "1秒あたりの回転数"),
        explanation=Text("0: those of the sensor.", "0 の場合はセンサーの値。"),
    )
    drift_m: float = length(
        0.005,
        low=0.0,
        high=1.0,
        name=Text("Drift of the trajectory", "走行軌跡の誤差"),
        explanation=Text(
            "Standard deviation of the delivered positions; it changes over minutes.",
            "成果の位置の標準偏差。数分かけて変化します。",
        ),
    )
    attitude_deg: float = angle(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Error of the attitude", "姿勢角の誤差"),
        explanation=Text(
            "Standard deviation of the delivered roll, pitch and heading; it changes over minutes.",
            "成果のロール・ピッチ・方位角の標準偏差。数分かけて変化します。",
        ),
    )
    mounting_deg: float = angle(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Error of the mounting", "取付け角の誤差"),
        explanation=Text(
            "Standard deviation of the angles by which each head is mounted otherwise than its "
            "calibration says.",
            "各スキャナーの取付け角の、検定値に対する誤差の標準偏差。",
        ),
    )
    jumps_m: float = length(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Jumps of the trajectory", "走行軌跡の飛び"),
        explanation=Text(
            "Standard deviation of the steps in the delivered positions where GNSS comes back, "
            "about twice a minute.",
            "GNSSの再捕捉時に生じる、成果の位置の段差の標準偏差。1分間に約2回起こります。",
        ),
    )
    wander_m: float = length(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Wander of the trajectory", "走行軌跡のゆらぎ"),
        explanation=Text(
            "How far the delivered positions wander at random within a minute, standard deviation.",
            "成果の位置が1分間に不規則に変化する量の標準偏差。",
        ),
    )
    control_per_km: float = ratio(
        0.0,
        low=0.0,
        high=1000.0,
        name=Text("Control points per km", "1 kmあたりの標定点数"),
        explanation=Text(
            "Surveyed points on corners of markings and on the road, every third of them a check "
            "point, in control_points.csv.",
            "標示の角や路面を測量した点。3点に1点は検証点とし、control_points.csv に書き出します。",
        ),
    )
    wear: float = ratio(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Wear of kerb stones", "縁石の傷み"),
        explanation=Text(
            "0: as laid; 1: settled, tilted and rounded, as in an old street.",
            "0 は施工時の状態、1 は古い街路のように沈下・傾斜し、角が丸くなった状態。",
        ),
    )
    avenue: bool = switch(
        default=False,
        name=Text("Avenue trees", "並木道"),
        explanation=Text(
            "Rows of large trees whose crowns touch each other and hang over posts and lamps.",
            "樹冠が互いに接し、標識柱や街灯の上に覆いかぶさる大きな並木。",
        ),
    )
    flush: bool = switch(
        default=False,
        name=Text("Sides without curbs", "縁石のない道路"),
        explanation=Text(
            "On most sides no curb stands: flush walks, shoulders of gravel and soil.",
            "縁石を設けず、段差のない歩道や、砂利・土の路肩とする区間が大半になります。",
        ),
    )
    noise: float = ratio(
        1.0,
        low=0.0,
        high=1000.0,
        name=Text("Noise, times the usual", "ノイズの量（通常比）"),
        explanation=Text(
            "Arcs, drops, dust and other points of nothing, so many times as often as such a "
            "scanner usually has them.",
            "円弧状のノイズ、雨滴、粉じんなど、物のない所の点を、通常の何倍含めるか。",
        ),
    )
    images: bool = switch(
        default=True,
        name=Text("Camera images", "カメラ画像"),
        explanation=Text(
            "Photographs with places and angles, every ten metres.",
            "10 m ごとの、位置・姿勢付きの写真。",
        ),
    )


@dataclass(frozen=True)
class SiteRequest:
    """An earthwork site of two dates, scanned from tripods.

    Attributes
    ----------
    length_m : float
        Of the longer side of the site.
    spacing_m : float
        From beam to beam, 10 m away.
    """

    seed: int = count(1, low=0, high=2**31 - 1, name=_SEED, explanation=_SEED_MEANING)
    length_m: float = length(
        60.0, low=20.0, high=500.0, name=Text("Length", "長さ"),
        explanation=Text("Of the longer side.", "現場の長辺。"),
    )  # fmt: skip
    style: str = choice(
        "levee",
        choices=(
            ParameterChoice("levee", Text("Levee", "堤防")),
            ParameterChoice("cutting", Text("Road cutting and embankment", "道路の切土・盛土")),
            ParameterChoice("pad", Text("Building land", "宅地造成")),
            ParameterChoice("hillside", Text("Road through hills", "丘陵地の道路")),
        ),
        name=_STYLE,
    )
    sensor: str = choice("p40", choices=_sensors("standing"), name=_SENSOR)
    own_sensor: str = file(name=_OWN_SENSOR, explanation=_OWN_SENSOR_MEANING)
    stations: int = count(
        0,
        low=0,
        high=12,
        name=Text("Stations", "器械点の数"),
        explanation=Text("0: as many as the site needs.", "0 の場合は現場の広さから決めます。"),
    )
    spacing_m: float = length(
        0.02,
        low=0.002,
        high=0.2,
        name=Text("Point spacing at 10 m", "10 m 先の点間隔"),
    )


@dataclass(frozen=True)
class FlightRequest:
    """A landscape flown over by a scanner that records waveforms.

    Attributes
    ----------
    length_m : float
        Side of the square that is flown over.
    height_m, density : float
        Above the ground, and pulses per m² of all lines together; 0 for the sensor's usual ones.
    """

    seed: int = count(1, low=0, high=2**31 - 1, name=_SEED, explanation=_SEED_MEANING)
    length_m: float = length(
        100.0, low=40.0, high=500.0, name=Text("Length", "長さ"),
        explanation=Text("Side of the square that is flown over.", "計測する正方形の一辺。"),
    )  # fmt: skip
    style: str = choice(
        "village",
        choices=tuple(ParameterChoice(id_, one.name) for id_, one in FLIGHT_STYLES.items()),
        name=_STYLE,
    )
    sensor: str = choice(
        "corridor",
        choices=tuple(ParameterChoice(one.id, one.name) for one in FLIGHT_SENSORS.values()),
        name=_SENSOR,
    )
    height_m: float = length(
        0.0, low=0.0, high=3000.0, name=Text("Flying height", "対地高度"),
        explanation=Text(
            "Above the ground; 0: what is usual for the sensor.",
            "地面からの高さ。0 の場合はセンサーの標準。",
        ),
    )  # fmt: skip
    density: float = ratio(
        0.0, low=0.0, high=100.0, name=Text("Pulses per m²", "パルス密度 (1 m²あたり)"),
        explanation=Text(
            "Of all lines together; 0: what is usual for the sensor.",
            "全コースの合計。0 の場合はセンサーの標準。",
        ),
    )  # fmt: skip
