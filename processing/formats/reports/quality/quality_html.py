"""The quality report as a page that any browser shows, without anything beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path

from processing.core.text import Language, Text
from processing.formats.reports.quality.quality_rows import (
    ACCURACY_COLUMNS,
    FINDING_COLUMNS,
    FINDINGS_TITLE,
    HAND_COLUMNS,
    HAND_TITLE,
    KIND_COLUMNS,
    KINDS_TITLE,
    NO_FINDINGS,
    POINT_COLUMNS,
    POINTS_TITLE,
    RULE_COLUMNS,
    RULES_TITLE,
    TITLE,
    QualityFacts,
    accuracy_rows,
    accuracy_title,
    finding_rows,
    hand_rows,
    in_language,
    is_number,
    kind_rows,
    point_rows,
    rule_rows,
    summary_rows,
)

_STYLE = """
body { font: 14px/1.5 "Yu Gothic UI", "Hiragino Sans", "Noto Sans CJK JP", sans-serif;
       margin: 2em auto; max-width: 60em; padding: 0 1em; color: #1c1f24; background: #fff; }
h1 { font-size: 1.6em; } h2 { font-size: 1.15em; margin-top: 2em; }
table { border-collapse: collapse; width: 100%; }
th, td { border: 1px solid #b8bec8; padding: .25em .6em; text-align: left; vertical-align: top; }
th { background: #eceef1; font-weight: 600; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
"""


def write_quality_html(path: Path, facts: QualityFacts, language: Language) -> None:
    """Write the page, UTF-8."""
    title = escape(TITLE.in_language(language))
    parts = [
        f'<!DOCTYPE html>\n<html lang="{language}"><head><meta charset="utf-8">',
        f"<title>{title}</title><style>{_STYLE}</style></head><body><h1>{title}</h1>",
        _table((), summary_rows(facts), language),
        _section(RULES_TITLE, RULE_COLUMNS, rule_rows(facts), language),
        *_accuracy(facts, language),
        _section(KINDS_TITLE, KIND_COLUMNS, kind_rows(facts), language),
        _section(FINDINGS_TITLE, FINDING_COLUMNS, finding_rows(facts), language)
        if facts.check.findings
        else f"<p>{escape(NO_FINDINGS.in_language(language))}</p>",
        f"<p><small>{escape(facts.software)}</small></p></body></html>\n",
    ]
    path.write_text("\n".join(parts), encoding="utf-8")


def _accuracy(facts: QualityFacts, language: Language) -> Iterator[str]:
    points, hand = facts.points, facts.hand
    if hand is not None:
        yield _section(HAND_TITLE, HAND_COLUMNS, hand_rows(facts, hand), language)
    if points is not None:
        yield _section(accuracy_title(points), ACCURACY_COLUMNS, accuracy_rows(points), language)
        yield _section(POINTS_TITLE, POINT_COLUMNS, point_rows(facts, points), language)


def _section(
    title: Text, columns: Sequence[Text], rows: Iterator[tuple[Text, ...]], language: Language
) -> str:
    return f"<h2>{escape(title.in_language(language))}</h2>" + _table(columns, rows, language)


def _table(columns: Sequence[Text], rows: Iterator[tuple[Text, ...]], language: Language) -> str:
    head = "".join(f"<th>{escape(one.in_language(language))}</th>" for one in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>\n" for row in in_language(rows, language))
    return f"<table>{f'<tr>{head}</tr>' if head else ''}\n{body}</table>"


def _cell(words: str) -> str:
    return f"<td{' class=n' if is_number(words) else ''}>{escape(words)}</td>"
