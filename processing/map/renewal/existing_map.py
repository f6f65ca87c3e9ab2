"""What is asked before an existing map is taken in or compared."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.parameters import ParameterChoice, choice, file, length, text
from processing.core.text import Text
from processing.map.renewal.map_comparison import MOST_SEARCH_M, SEARCH_M, TOLERANCE_M

COMPARE, TAKE = "compare", "take"


@dataclass(frozen=True)
class ExistingMap:
    """An existing map, and what is to become of it."""

    file: str = file(
        name=Text("File", "ファイル"),
        explanation=Text(
            "DXF, extended DM, SIMA, Shapefile, GeoPackage or GeoJSON.",
            "DXF、拡張DM、SIMA、Shapefile、GeoPackage、GeoJSONを読み込めます。",
        ),
    )
    use: str = choice(
        COMPARE,
        choices=(
            ParameterChoice(
                COMPARE, Text("Find what has changed since", "変化箇所を抽出する（経年変化）")
            ),
            ParameterChoice(TAKE, Text("Take its features in", "地物として取り込む")),
        ),
        name=Text("What for", "用途"),
        explanation=Text(
            "Changes are candidates of a run and are judged in the review.",
            "変化箇所は候補になり、確認作業で採否を決めます。",
        ),
    )
    crs: str = text(
        name=Text("Reference system", "座標参照系"),
        explanation=Text(
            "As EPSG:6677, of a file that does not say it.",
            "ファイルに記載がないときに、EPSG:6677のように指定します。",
        ),
    )
    of_kind: str = text(
        name=Text("Kind of the rest", "その他の種別"),
        explanation=Text(
            "What things are that name no kind, layer or code of the catalogue, by the kind's id;"
            " empty: they are left out.",
            "カタログにない画層・分類コードの地物の種別（ID）です。空欄では取り込みません。",
        ),
    )
    tolerance_m: float = length(
        TOLERANCE_M,
        low=0.05,
        high=10.0,
        name=Text("Tolerance", "許容差"),
        explanation=Text(
            "What lies nearer has not moved: two maps of level 500 differ by it without a change.",
            "これより近ければ変化なしとします。地図情報レベル500の2図面は、"
            "変化がなくてもこの程度異なります。",
        ),
    )
    search_m: float = length(
        SEARCH_M,
        low=0.1,
        high=MOST_SEARCH_M,
        name=Text("Search distance", "探索距離"),
        explanation=Text(
            "What lies farther is another thing: one is new, the other gone.",
            "これより遠ければ別の地物とし、新設と消滅に分けます。",
        ),
    )
