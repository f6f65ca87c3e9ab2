"""The street of the sections' tests: ten metres whose cross-section is known."""

from __future__ import annotations

from tests.processing.section.conftest import both_heads, street

__all__ = ["both_heads", "street"]
