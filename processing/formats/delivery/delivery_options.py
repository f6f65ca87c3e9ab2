"""What is asked before a survey is handed in electronically."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.parameters import file, text
from processing.core.text import Text


@dataclass(frozen=True)
class DeliveryOptions:
    """What the program can't know of a survey; the rest is that of the project's work details."""

    delivery_start: str = text(
        name=Text("Begin of the work (delivery)", "履行期間の着手（電子納品）"),
        explanation=Text("As 2026-04-01.", "例: 2026-04-01"),
    )
    delivery_end: str = text(
        name=Text("End of the work (delivery)", "履行期間の完了（電子納品）"),
        explanation=Text("As 2027-03-31.", "例: 2027-03-31"),
    )
    delivery_area: str = text(name=Text("Area surveyed (delivery)", "測量区域・地区名（電子納品）"))
    delivery_advice: str = text(
        name=Text("Number of GSI's advice (delivery)", "助言番号（電子納品）"),
        explanation=Text(
            "As R08A0001: the metadata's name. Empty: META0001.",
            "メタデータのファイル名にします（例: R08A0001）。空欄のときはMETA0001です。",
        ),
    )
    delivery_folder: str = text(
        name=Text("Folder of the survey (delivery)", "測量細区分フォルダ名（電子納品）"),
        explanation=Text(
            "As the edition calls it; empty: ZUKA_A.",
            "適用する要領で定める名前です。空欄のときはZUKA_A（図化）です。",
        ),
    )
    delivery_edition: str = text(
        name=Text("Edition (delivery)", "適用要領基準（電子納品）"),
        explanation=Text(
            "As the client asks for it, such as 測量202103-01; it is written as it is.",
            "発注者が指定する値です（例: 測量202103-01）。入力どおりに記載します。",
        ),
    )
    delivery_dtds: str = file(
        name=Text("DTD of the edition (delivery)", "要領のDTD（電子納品）"),
        explanation=Text(
            "One of the ministry's files; those beside it are taken too, and the management files"
            " are checked by them.",
            "国土交通省が公開するDTDを1つ選ぶと、同じフォルダのDTDも格納し、"
            "管理ファイルを検査します。",
        ),
    )
