"""The frame: resumable, seeded, whole files."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scipy import stats

from experiments.campaign import Job, Options, job_key, run_campaign, seeds_of
from experiments.files import write_atomically
from experiments.intervals import interval, paired
from experiments.rows import COLUMNS, Row, read_csv, select, write_csv
from runtime.params import ConfigurationError


def row(seed: int | None = 0, percent: float = 50.0) -> Row:
    return Row("toy", "geometric", "lc", seed, 60.0, None, percent, None, 1e4)


class Toy(ModuleType):
    """An experiment whose runs are counted."""

    NAME = "toy"

    def __init__(self) -> None:
        super().__init__("toy_experiment")
        self.ran: list[object] = []

    def jobs(self, options: Options) -> Sequence[Job]:
        return [{"seed": seed} for seed in options.seeds_or(3)]

    def run(self, job: Job) -> Sequence[Row]:
        self.ran.append(job["seed"])
        return [row(int(job["seed"] or 0), 10.0 * float(job["seed"] or 0))]

    def draw(self, rows: Sequence[Row], folder: Path) -> Sequence[Path]:
        return []


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch) -> Toy:
    module = Toy()
    monkeypatch.setitem(sys.modules, "toy_experiment", module)
    return module


def test_a_second_campaign_runs_only_the_seeds_that_are_missing(toy: Toy, tmp_path: Path) -> None:
    run_campaign(toy, Options(), tmp_path, backend="threading")
    outcome = run_campaign(toy, Options(seeds=(1, 7, 2)), tmp_path, backend="threading")
    assert sorted(toy.ran) == [0, 1, 2, 7]
    assert outcome.resumed_jobs == 2
    assert [r.seed for r in outcome.rows] == [1, 7, 2]


def test_an_interrupted_campaign_keeps_what_was_finished(toy: Toy, tmp_path: Path) -> None:
    whole = toy.run

    def broken(job: Job) -> Sequence[Row]:
        if job["seed"] == 2:
            raise KeyboardInterrupt
        return whole(job)

    toy.run = broken  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt):
        run_campaign(toy, Options(), tmp_path, backend="threading", workers=1)
    toy.run = whole  # type: ignore[method-assign]
    assert run_campaign(toy, Options(), tmp_path, backend="threading").resumed_jobs == 2
    assert sorted(toy.ran) == [0, 1, 2]


def test_the_csv_has_the_published_columns_and_comes_back_as_it_was(toy: Toy, tmp_path: Path) -> None:
    outcome = run_campaign(toy, Options(), tmp_path, backend="threading")
    header = outcome.csv.read_text().splitlines()[0]
    assert header == (
        "experiment,plant,controller,seed,robot_minutes,start_distance_m,"
        "controllable_percent,docking_time_s,robot_seconds_per_core_second"
    )
    assert tuple(header.split(",")) == COLUMNS
    assert tuple(read_csv(outcome.csv)) == outcome.rows


def test_a_key_changes_with_the_job_and_the_name_but_not_with_the_order_of_its_values() -> None:
    assert job_key("a", {"x": 1, "y": 2}) == job_key("a", {"y": 2, "x": 1})
    assert len({job_key("a", {"x": 1}), job_key("a", {"x": 2}), job_key("b", {"x": 1})}) == 3


def test_seeds_are_a_count_or_a_list() -> None:
    assert seeds_of("3") == (0, 1, 2)
    assert seeds_of("3,5,9") == (3, 5, 9)
    assert seeds_of("7,") == (7,)
    for text in ("", "a", "-1", "1.5", "2;3"):
        with pytest.raises(ConfigurationError, match="--seeds"):
            seeds_of(text)


def test_an_unknown_backend_is_named(toy: Toy, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="--backend"):
        run_campaign(toy, Options(), tmp_path, backend="slurm")


def test_a_file_appears_only_whole(tmp_path: Path) -> None:
    def fail() -> None:
        with write_atomically(tmp_path / "a.txt") as file:
            file.write("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert list(tmp_path.iterdir()) == []


def test_select_and_write_of_rows(tmp_path: Path) -> None:
    rows = [row(0), row(None, 12.5)]
    write_csv(tmp_path / "rows.csv", rows)
    assert read_csv(tmp_path / "rows.csv") == rows
    assert select(rows, seed=None, plant="geometric") == rows[1:]


def test_interval_covers_the_mean_in_95_percent_of_samples() -> None:
    samples = np.random.default_rng(1).normal(3.0, 2.0, (2000, 5))
    covered = [interval(list(s)).low <= 3.0 <= interval(list(s)).high for s in samples]
    assert np.mean(covered) == pytest.approx(0.95, abs=0.015)


def test_paired_interval_is_that_of_scipy_s_paired_t_test() -> None:
    rng = np.random.default_rng(2)
    first, second = rng.normal(1, 1, 12), rng.normal(0, 1, 12)
    ours = paired(list(first), list(second))
    theirs = stats.ttest_rel(first, second).confidence_interval(0.95)
    assert (ours.low, ours.high) == pytest.approx((theirs.low, theirs.high))


def test_interval_leaves_out_none_and_says_what_it_can_not_know() -> None:
    assert interval([1.0, None, 3.0]).mean == 2.0
    assert math.isnan(interval([1.0]).half_width)
    assert math.isnan(interval([]).mean)
    assert str(interval([None])) == "-"
