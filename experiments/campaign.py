"""The frame of every experiment: jobs over all cores, resumable, rows as CSV, pictures.

An experiment is a module with

    NAME = "table2"
    def jobs(options: Options) -> Sequence[Job]: ...        # plain values only; one job = one process's work
    def run(job: Job) -> Sequence[Row]: ...                 # pure: same job, same rows (but for the speed column)
    def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]: ...    # the pictures made

and a line in `experiments.registry`; also a `FORM` (`experiments.form`) if its rows are no `Row`. A finished job's rows
are kept on disk under a key made of the job and of the sources that computed it, so a campaign that was interrupted or
extended by seeds runs only what is missing, and rows of older code are never mixed in.
"""

from __future__ import annotations

import hashlib
import importlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Protocol

import joblib
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from experiments.files import write_atomically
from experiments.form import Form, form_of
from experiments.rows import write_csv
from runtime.params import ConfigurationError

Value = str | int | float | bool | None
Job = Mapping[str, Value]
"""What one call of `run` needs, as plain JSON values. The same job always gives the same rows."""

SOURCES = ("docking", "experiments", "components/learner")
"""Folders whose code makes the rows: a change there makes kept rows stale."""


@dataclass(frozen=True)
class Options:
    """What the command line says. None = the experiment's own default."""

    seeds: tuple[int, ...] | None = None
    minutes: float | None = None
    """Robot minutes to learn."""
    plant_noise: float = 0.0
    """Standard deviation of each step's speed and turn rate, as a share of the commanded ones."""
    goal: str = "cell"
    """`cell`: the paper's goal cell at any distance. `dock`: gripper within 2 cm and 4 deg of its pose."""
    policies: str | None = None
    """Folder to which learned controllers are exported."""
    turn_rate_radps: float | None = None
    speed_mps: float | None = None
    delay_samples: int = 0
    """Sampling periods between a percept and the command that answers it."""
    gripper_m: float | None = None
    """Gripper ahead of the axle, for `--goal dock`."""
    neural: bool = False
    """The neural learner too (`schools`)."""

    def seeds_or(self, count: int) -> tuple[int, ...]:
        """The seeds asked for, or 0 .. count - 1."""
        return tuple(range(count)) if self.seeds is None else self.seeds


class Experiment(Protocol):
    """What a module of an experiment has."""

    NAME: str
    __name__: str

    def jobs(self, options: Options) -> Sequence[Job]: ...  # noqa: D102
    def run(self, job: Job) -> Sequence[Any]: ...  # noqa: D102
    def draw(self, rows: Sequence[Any], folder: Path) -> Sequence[Path]: ...  # noqa: D102


@dataclass(frozen=True)
class Outcome:
    """What a campaign made."""

    rows: tuple[Any, ...]
    csv: Path
    pictures: tuple[Path, ...]
    resumed_jobs: int
    """Jobs whose rows were on disk already."""
    form: Form
    """Of the rows."""


def seeds_of(text: str) -> tuple[int, ...]:
    """`20` is seeds 0 to 19; `3,5,9` (or `3,`) is a list.

    Raises:
        ConfigurationError: not whole numbers of at least 0.
    """
    parts = [part.strip() for part in text.split(",") if part.strip()]
    if not parts or not all(part.isdecimal() for part in parts):
        raise ConfigurationError(f"--seeds must be a count (20) or a list (3,5,9); got {text!r}")
    numbers = tuple(int(part) for part in parts)
    return numbers if "," in text else tuple(range(numbers[0]))


def run_campaign(
    experiment: Experiment,
    options: Options,
    folder: Path,
    *,
    backend: str = "loky",
    workers: int = -1,
    console: Console | None = None,
) -> Outcome:
    """Run what is missing, then write `folder/NAME.csv` and the pictures.

    Args:
        experiment: module as described at the top of this file.
        options: of the command line.
        folder: made if need be; finished jobs are kept in its `.jobs`.
        backend: of joblib: loky, threading, dask or ray.
        workers: processes; -1 = one for each core.
        console: for the progress bar; None = silent.
    """
    jobs = list(experiment.jobs(options))
    store = {job_key(experiment.NAME, job): job for job in jobs}
    paths = {key: folder / ".jobs" / experiment.NAME / f"{key}.json" for key in store}
    missing = [key for key in store if not paths[key].exists()]
    with _progress(console) as progress:
        task = progress.add_task(experiment.NAME, total=len(store), completed=len(store) - len(missing))
        work = [(key, experiment.__name__, store[key]) for key in missing]
        for key, fresh in _results(work, backend, workers):
            _keep(paths[key], fresh)
            progress.advance(task)
    form, csv = form_of(experiment), folder / f"{experiment.NAME}.csv"
    rows = tuple(row for key in store for row in _kept(paths[key], form))
    write_csv(csv, rows, form.columns)
    return Outcome(rows, csv, tuple(experiment.draw(rows, folder)), len(store) - len(missing), form)


def job_key(name: str, job: Job) -> str:
    """Key of a job: changes with the experiment, the job's values and the code behind it."""
    text = json.dumps([name, dict(job), sources_digest()], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:24]


@cache
def sources_digest() -> str:
    """Digest of the Python files in SOURCES."""
    root = Path(__file__).parent.parent
    digest = hashlib.sha256()
    for path in sorted(path for source in SOURCES for path in (root / source).rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _run(key: str, module: str, job: Job) -> tuple[str, list[Any]]:
    """One job, in a worker."""
    experiment: Experiment = importlib.import_module(module)
    return key, list(experiment.run(job))


def _results(work: Sequence[tuple[str, str, Job]], backend: str, workers: int) -> Iterator[tuple[str, list[Any]]]:
    _register(backend)
    threads = {"inner_max_num_threads": 1} if backend == "loky" else {}
    with joblib.parallel_config(backend=backend, n_jobs=workers, **threads):
        try:
            parallel = joblib.Parallel(return_as="generator_unordered", batch_size=1)
        except ValueError:  # a backend that gives results only when all are done (ray): in portions, to keep progress
            size = 4 * joblib.effective_n_jobs()
            for start in range(0, len(work), size):
                yield from joblib.Parallel()(joblib.delayed(_run)(*item) for item in work[start : start + size])
        else:
            yield from parallel(joblib.delayed(_run)(*item) for item in work)


def _register(backend: str) -> None:
    """Make a cluster's backend known to joblib."""
    try:
        if backend == "ray":
            importlib.import_module("ray.util.joblib").register_ray()
        elif backend == "dask":
            importlib.import_module("distributed").Client(set_as_default=True)  # $DASK_SCHEDULER_ADDRESS, or local
        elif backend not in ("loky", "threading"):
            raise ConfigurationError(f"--backend must be one of loky, threading, dask, ray; got {backend!r}")
    except ImportError as error:
        package = {"ray": "ray", "dask": "dask[distributed]"}[backend]
        raise ConfigurationError(f"--backend {backend} needs `pip install {package}` ({error})") from error


def _keep(path: Path, rows: Iterable[Any]) -> None:
    with write_atomically(path) as file:
        json.dump([asdict(row) for row in rows], file)


def _kept(path: Path, form: Form) -> list[Any]:
    return [form.row_of(table) for table in json.loads(path.read_text(encoding="utf-8"))]


def _progress(console: Console | None) -> Progress:
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=console, disable=console is None, transient=False)
