"""Waveforms that go with points that are handed in: the files of packets beside them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from processing.core.errors import UNCHANGED, BadFile, InUse
from processing.core.text import Text
from processing.formats.points.point_files import read_info
from processing.formats.points.waveform_output import PACKETS_ENDING, packets_beside
from processing.recording.drive import Drive
from processing.recording.waveform_packets.kept_packets import packets_path, read_packet_files

_POINT_ENDINGS = (".las", ".laz")


class DeliveredPackets:
    """The files of packets beside the point files that drives came from.

    Parameters
    ----------
    drives : sequence of Drive
        Their own copies of the packets serve where the delivered ones are gone.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        A file whose points are echoes can't be read, or has others than when it was imported.
    """

    def __init__(self, drives: Sequence[Drive]) -> None:
        self._kept: dict[Path, Path] = {}
        for drive in drives:
            by_name = {
                Path(file.delivered).with_suffix(""): file
                for file in read_packet_files(drive.folder)
            }
            for one in drive.info.sources:
                found = by_name.get(Path(one.path).with_suffix(""))
                if found is not None:
                    source = drive.source_path(one)
                    self._kept[source] = packets_path(drive.folder, found.number)
                    _check_echoes(source, found.echoes)

    def to_copy(self, source: Path, output: Path) -> tuple[Path, Path] | None:
        """What is to be copied beside the points of a delivered file, and where to.

        Parameters
        ----------
        output : Path
            The file that gets the points.

        Returns
        -------
        tuple of Path, or None
            None where the points bring no packets, or these are in place already.

        Raises
        ------
        MissingInput, NoSpace, BadFile
        """
        packets = packets_beside(source, self._kept.get(source))
        target = output.with_suffix(PACKETS_ENDING if packets is None else packets.suffix.lower())
        if packets is None or (target.is_file() and target.samefile(packets)):
            return None
        return packets, target


def _check_echoes(source: Path, imported: int) -> None:
    """Refuse points that are found anew in waveforms and are no longer those of the drive."""
    if not imported:
        return
    now = read_info(source).waveforms
    if now is None or now.echoes == imported:
        return
    raise BadFile(
        Text(
            "The program finds {now:,} echoes in the waveforms now; {imported:,} were imported.",
            "現在のプログラムが検出するエコーは{now:,}個で、インポート時の{imported:,}個と異なります。",
        ).filled(now=now.echoes, imported=imported),
        Text.same(str(source)),
        Text(
            "Import the file again. {unchanged}", "もう一度インポートしてください。{unchanged}"
        ).filled(unchanged=UNCHANGED),
    )


def refuse_others_packets(target: Path, output: Path) -> None:
    """Refuse to replace packets that other points in the folder name.

    Parameters
    ----------
    target : Path
        Where packets are to be copied to.
    output : Path
        The file that gets the points.

    Raises
    ------
    InUse
    """
    others = [output.with_suffix(one) for one in _POINT_ENDINGS]
    of_other = next((one for one in others if one != output and one.is_file()), None)
    if target.is_file() and of_other is not None:
        raise InUse(
            Text(
                "The waveforms of the result would overwrite those of other points.",
                "結果の波形ファイルが、別の点群の波形ファイルを上書きします。",
            ),
            Text(f"{target}, of {of_other.name}", f"{target}（{of_other.name} の波形）"),
            Text(
                "Choose another name or folder; nothing was written.",
                "別の名前かフォルダを指定してください。何も書き込まれていません。",
            ),
        )
