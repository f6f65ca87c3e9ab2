"""The tool REGISTER: drives, passes and heads set on each other and on control points."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.parameters import file
from processing.core.text import Text
from processing.methods.registration.registration import register_drives
from processing.tools.tool import Needs, SurveyCorrection, Tool


@dataclass(frozen=True)
class RegisterParameters:
    """What a registration rests on beside the points."""

    control: str = file(
        name=Text("Control points", "標定点"),
        explanation=Text(
            "CSV with id, easting_m, northing_m, height_m and, where wanted, role (control or "
            "check) and where; or SIMA. Empty: the drives are set on each other alone.",
            "id, easting_m, northing_m, height_m と、必要に応じて role（control または check）、"
            "where の列をもつCSV、またはSIMAです。空欄の場合は走行データ同士だけを合わせます。",
        ),
    )


REGISTER = Tool(
    id="register",
    name=Text("Registration", "位置合わせ"),
    explanation=Text(
        "Sets drives, passes and scanner heads on each other and on control points: corrections of "
        "each trajectory that change with time, and of each head's mounting. The delivered files "
        "stay as they are.",
        "走行データ・往復・スキャナー同士を、標定点があればそれにも合わせます。走行軌跡の時間変化する"
        "補正と各スキャナーの取付け補正を求めます。納品ファイルは変更しません。",
    ),
    group=Text("Registration", "位置合わせ"),
    needs=Needs.TRAJECTORY,
    parameters=RegisterParameters,
    method=SurveyCorrection(register_drives),
)
