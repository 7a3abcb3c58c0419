"""How the rows of an experiment are kept and shown: those of the paper's, unless the experiment has a `FORM`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from experiments.rows import COLUMNS, row_of
from experiments.summary import summary


@dataclass(frozen=True)
class Form:
    """One kind of rows."""

    columns: tuple[str, ...]
    """Of the CSV file: the fields of a row."""
    row_of: Callable[[dict[str, object]], Any]
    """A row from plain values."""
    summary: Callable[[Sequence[Any]], Iterator[tuple[str, ...]]]
    """A header, then lines, for people."""
    note: str
    """Printed below them."""


PAPER = Form(COLUMNS, row_of, summary, "+-: 95 % interval of the mean over seeds (Student's t)")


def form_of(experiment: object) -> Form:
    """The form of an experiment's rows."""
    form = getattr(experiment, "FORM", PAPER)
    if not isinstance(form, Form):
        raise TypeError(f"FORM must be a Form; got {form!r}")
    return form
