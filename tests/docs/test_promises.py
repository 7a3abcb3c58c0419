"""The table of promises names tests and commands that are there."""

import re

import pytest

from benchmarks.__main__ import BENCHMARKS
from experiments.registry import EXPERIMENTS
from tests.docs.page import ROOT

PAGE = (ROOT / "docs" / "promises.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.splitlines()
    if line.startswith("|") and not line.startswith(("| promise", "|---"))
]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[1])
def test_a_promise_names_its_test_what_was_tried_and_a_command_that_runs_it(row):
    _, tests, tried, held, command = row
    assert int(tried.replace(",", "")) >= int(held.replace(",", "")) > 0
    paths = re.findall(r"tests/\S+?\.py|\.ci/\w+", command)
    assert all((ROOT / path).exists() for path in paths)
    benchmark = re.search(r"python -m benchmarks (\w+)", command)
    experiment = re.search(r"berth experiment (\w+)", command)
    assert paths or (benchmark and benchmark[1] in BENCHMARKS) or (experiment and experiment[1] in EXPERIMENTS)
    for name in re.findall(r"`(\w+)(?:\.py)?`", tests):
        assert name in BENCHMARKS or name in EXPERIMENTS or list((ROOT / "tests").rglob(f"{name}.py")), name
