"""A drawing as written, read back, and found without fault by ezdxf's audit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ezdxf.filemanagement

from processing.formats.drawings.dxf import write_dxf
from processing.formats.drawings.dxf_document import DxfVersion
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature


def audited_dxf(
    path: Path, catalogue: Catalogue, *features: Feature, version: DxfVersion = "R2018"
) -> Any:
    """Write features, read the file and let it be audited."""
    write_dxf(path, features, catalogue, version=version, crs="EPSG:6677")
    doc = ezdxf.filemanagement.readfile(path)
    audit = doc.audit()
    assert [error.message for error in audit.errors] == []
    assert [fix.message for fix in audit.fixes] == []
    return doc
