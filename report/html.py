"""The parts that pages are made of. Everything that comes from a session is escaped here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from report.chart import Key, data_of
from report.charts import Figure
from report.style import STYLE
from report.verdict import Tile


def page(title: str, parts: Iterable[str]) -> str:
    """The whole page; it needs nothing from elsewhere."""
    return (
        "<!doctype html><html lang=en><meta charset=utf-8>"
        "<meta name=viewport content='width=device-width,initial-scale=1'>"
        f"<title>{escape(title)}</title><style>{STYLE}</style><body>{''.join(parts)}</body></html>\n"
    )


def section(title: str, *parts: str) -> str:
    """A heading and what is below it; nothing if there is nothing."""
    body = "".join(parts)
    return f"<h2>{escape(title)}</h2>{body}" if body else ""


def note(words: str) -> str:
    """A sentence that explains or says what is missing."""
    return f"<p class=mute>{escape(words)}</p>"


def tiles(found: Iterable[Tile]) -> str:
    """The answers at the top."""
    return f"<div class=tiles>{''.join(_tile(tile) for tile in found)}</div>"


_SIGNS = {"good": "\N{CHECK MARK} ", "fair": "~ ", "bad": "\N{MULTIPLICATION X} ", "none": ""}


def _tile(tile: Tile) -> str:
    return (
        f"<div class='tile {tile.mark}'>{escape(tile.question)}<b>{_SIGNS[tile.mark]}{escape(tile.answer)}</b>"
        f"<span>{escape(tile.words)}</span></div>"
    )


def cards(figures: Iterable[Figure | str], kind: str = "") -> str:
    """Charts side by side, as many as fit."""
    body = "".join(figure if isinstance(figure, str) else _figure(figure) for figure in figures)
    return f"<div class='cards {kind}'>{body}</div>" if body else ""


def _figure(figure: Figure) -> str:
    words = " ".join([figure.title + ".", *(key.words + "." for key in figure.keys), figure.note])
    keys = "".join(_key(key) for key in figure.keys)
    caption = f"{keys}{'<br>' if keys and figure.note else ''}{escape(figure.note)}"
    return (
        f"<figure><h3>{escape(figure.title)}</h3>{figure.chart.svg(words)}<figcaption>{caption}</figcaption></figure>"
    )


def card(title: str, body: str) -> str:
    """Anything else among the charts."""
    return f"<figure><h3>{escape(title)}</h3>{body}</figure>"


def _key(key: Key) -> str:
    return f"<span class=key><i class='{key.mark}'></i>{escape(key.words)}</span>"


def photograph(data: bytes, words: str) -> str:
    """A camera image as it was recorded."""
    kind = "jpeg" if data[:2] == b"\xff\xd8" else "png"
    image = f"<img alt='{escape(words, quote=True)}' src='{data_of(data, kind)}'>"
    return f"<figure>{image}<figcaption>{escape(words)}</figcaption></figure>"


def table(rows: Sequence[Sequence[str]]) -> str:
    """A table with its head first; the first column is text, the others are numbers if they look like it."""
    numeric = [column > 0 and all(_is_number(row[column]) for row in rows[1:]) for column in range(len(rows[0]))]
    head = "".join(f"<th{_number(n)}>{escape(cell)}</th>" for cell, n in zip(rows[0], numeric, strict=True))
    body = "".join(
        "<tr>" + "".join(f"<td{_number(n)}>{escape(cell)}</td>" for cell, n in zip(row, numeric, strict=True)) + "</tr>"
        for row in rows[1:]
    )
    return f"<div class=wide><table><tr>{head}</tr>{body}</table></div>"


def _is_number(cell: str) -> bool:
    return cell in {"", "-"} or cell[:1].isdigit() or (cell[:1] in "-\N{MINUS SIGN}" and cell[1:2].isdigit())


def _number(yes: bool) -> str:
    return " class=n" if yes else ""


def folded(title: str, body: str) -> str:
    """What few want to read: closed on a screen, open on paper."""
    return f"<details><summary>{escape(title)}</summary>{body}</details>"
