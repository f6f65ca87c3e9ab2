"""Scanners as their makers describe them, and how they are mounted."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Literal

from processing.errors import OutOfRange
from processing.text import Text
from resources import path_of


@dataclass(frozen=True)
class Head:
    """One scanner on the vehicle.

    Attributes
    ----------
    name : str
        Of its files: ``left``, ``right``.
    source_id : int
        Its ``point_source_id``.
    lever_m : (3,) float
        From the trajectory's reference point: forward, left, up.
    yaw_deg, pitch_deg : float
        Where the axis points about which the mirror spins: to the left of forward, and up.
    """

    name: str
    source_id: int
    lever_m: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float


@dataclass(frozen=True)
class Sensor:
    """A scanner.

    Attributes
    ----------
    kind : str
        ``mobile`` or ``standing`` (on a tripod).
    turns_per_s : float
        Of the mirror.
    pulses : int
        In one turn.
    measures_by : str
        ``pulse``, or ``phase``: one return, folded beyond its range of unambiguity, and arcs.
    most_m : float
        Reach for a surface of 80 %; of a phase-based one its range of unambiguity.
    noise_m : float
        Standard deviation of a range to a bright surface 10 m away.
    exit_m, divergence_rad : float
        Width of the beam where it leaves, and how fast it widens.
    returns : int
        Most returns of one pulse.
    heads : tuple of Head

        As usually mounted; empty for one on a tripod.
    """

    id: str
    name: Text
    kind: Literal["mobile", "standing"]
    turns_per_s: float
    pulses: int
    measures_by: Literal["pulse", "phase"]
    most_m: float
    noise_m: float
    exit_m: float
    divergence_rad: float
    returns: int
    heads: tuple[Head, ...] = ()

    @property
    def rate_hz(self) -> float:
        """Pulses per second of one head."""
        return self.turns_per_s * self.pulses


def _read_sensors() -> dict[str, Sensor]:
    table = tomllib.loads(path_of("catalogue/sensors.toml").read_text(encoding="utf-8"))
    mounts = {
        name: tuple(Head(**{**head, "lever_m": tuple(head["lever_m"])}) for head in heads)
        for name, heads in table["mount"].items()
    }
    sensors = {}
    for one in table["sensor"]:
        name = Text.same(one.pop("name"))
        heads = mounts.get(one.pop("mount", ""), ())
        sensors[one["id"]] = Sensor(**one, name=name, heads=heads)
    return sensors


SENSORS = _read_sensors()


def sensor_of(name: str, kind: str) -> Sensor:
    """The sensor of a name.

    Parameters
    ----------
    kind : {"mobile", "standing"}

    Raises
    ------
    OutOfRange
        There is none of this kind; names those there are.
    """
    known = [one.id for one in SENSORS.values() if one.kind == kind]
    if name not in known:
        raise OutOfRange(
            Text("There is no such sensor for this.", "この用途に使えるセンサーではありません。"),
            Text.same(name),
            Text("Use one of: {names}.", "次のいずれかを指定してください: {names}").filled(
                names=", ".join(known)
            ),
        )
    return SENSORS[name]
