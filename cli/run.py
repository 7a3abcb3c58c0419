"""`berth run LAUNCH`: start a system, show it, stop it cleanly, say where its recording and report are."""

from __future__ import annotations

import json
import sys
from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from cli.progress import Progress
from cli.session import Summary, Watch, now, recording_name
from runtime.contract import ComponentError
from runtime.device import check_clock
from runtime.launch import load
from runtime.link import Link, checked_link
from runtime.params import ConfigurationError
from runtime.system import System

GOOD_ENDS = ("duration", "interrupted")
"""Reasons that are no failure, beside the end that the system itself declares."""

LAUNCH = Annotated[Path, typer.Argument(help="Launch file, or one that Berth brings, by its name: sim.")]
HOST = Annotated[str, typer.Option(help="Start only the components of this host; the others run elsewhere.")]
LISTEN = Annotated[str, typer.Option(help="Let another host's part come in here, e.g. tcp/0.0.0.0:7447.")]
CONNECT = Annotated[str, typer.Option(help="Where another host's part listens, e.g. tcp/192.168.1.2:7447.")]
KEYS = Annotated[str, typer.Option(help="Directory of `berth keys init`: only hosts with its keys take part.")]
INSECURE = Annotated[bool, typer.Option("--insecure", help="Listen off loopback, open to whoever reaches it.")]
ONLY = Annotated[str, typer.Option(help="Start only these components, with commas between.")]
SET = Annotated[
    list[str] | None, typer.Option("--set", help="COMPONENT.PARAM=VALUE, task.KEY, session.KEY; task=FILE.")
]
RECORD = Annotated[Path | None, typer.Option(help="Recording to make; default: recordings/<launch>-<time>.mcap.")]
NO_RECORD = Annotated[bool, typer.Option("--no-record", help="Record nothing; there is no report then.")]
SHADOW = Annotated[str, typer.Option(help="Policy to run beside, logged, not driven: a file, lc, or learner.")]
DURATION = Annotated[float | None, typer.Option(help="Session seconds to stop after.")]
CLOCK = Annotated[str, typer.Option(help="lockstep, real, or a factor of real time.")]
IN_PROCESS = Annotated[bool, typer.Option("--in-process", help="One process, virtual clock, repeatable.")]
SEED = Annotated[int | None, typer.Option(help="Seed of the session.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, at the end.")]
QUIET = Annotated[bool, typer.Option("--quiet", help="No progress.")]


def run(
    launch: LAUNCH,
    host: HOST = "",
    listen: LISTEN = "",
    connect: CONNECT = "",
    keys: KEYS = "",
    insecure: INSECURE = False,
    only: ONLY = "",
    overrides: SET = None,
    record: RECORD = None,
    no_record: NO_RECORD = False,
    duration: DURATION = None,
    clock: CLOCK = "",
    in_process: IN_PROCESS = False,
    seed: SEED = None,
    shadow: SHADOW = "",
    as_json: JSON = False,
    quiet: QUIET = False,
) -> None:
    """Start this host's part of a system. Example: berth run launch/sim.toml --duration 600."""
    if duration is not None and not 0.0 <= duration < float("inf"):
        raise ConfigurationError(f"--duration must be >= 0 and finite; got {duration}")
    started = now()
    system = load(
        launch,
        overrides or (),
        clock="lockstep" if in_process else clock,
        seed=seed,
        host=host,
        only=tuple(name for name in only.split(",") if name),
        recording=None if no_record else record or recording_name(launch, started),
        keys=keys,
    )
    link = checked_link(listen, connect, insecure=insecure, tls=system.security == "tls")
    if shadow:
        from cli.shadow import with_shadow  # noqa: PLC0415

        system = with_shadow(system, shadow)
    check_recording(system)
    check_clock(system)
    _check_hosts(system, link, in_process=in_process)
    link = _guarded(link, system)
    with Progress(f"berth {launch}", quiet=quiet or as_json) as progress:
        watch = Watch(progress)
        failed, reason = execute(system, watch, started, duration, link, in_process=in_process)
    summary = watch.summary(reason, system.recording)
    if summary.recording and watch.board.scorer.trials:
        summary.report = _report(system.recording)
    _print(summary, as_json=as_json)
    raise typer.Exit(1 if failed else 0)


def execute(
    system: System, watch: Watch, started: datetime, duration: float | None, link: Link, *, in_process: bool
) -> tuple[bool, str]:
    """Run a system to its end, in this process or on the bus. Returns (failed, reason)."""
    if in_process:
        return _run_in_process(system, watch, started.isoformat(timespec="seconds"), duration)
    return _run_on_bus(system, watch, duration, link)


def check_recording(system: System) -> None:
    """Refuse at once what the recorder's process would refuse after the start."""
    file = system.recording
    if file is None:
        return
    if file.exists():
        raise ConfigurationError(f"{file}: must not exist yet; a recording is never overwritten")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigurationError(f"{file}: can not be made: {error.strerror}") from None


def _check_hosts(system: System, link: Link, *, in_process: bool) -> None:
    if in_process and system.host:
        raise ConfigurationError("--in-process must stand without --host: one process runs the whole system")
    if link != Link() and (in_process or not system.host):
        raise ConfigurationError("--listen and --connect must stand with --host: they join the parts of two hosts")
    if system.other_hosts and link == Link():
        others = ", ".join(system.other_hosts)
        raise ConfigurationError(f"--host {system.host} must come with --listen or --connect: {others} runs the rest")


def _guarded(link: Link, system: System) -> Link:
    if system.security == "none" or link == Link():
        return link
    from runtime.guard import guarded  # noqa: PLC0415

    return guarded(link, system)


def _run_in_process(system: System, watch: Watch, started: str, duration: float | None) -> tuple[bool, str]:
    """Returns (failed, reason)."""
    from cli.in_process import run_in_process  # noqa: PLC0415

    try:
        return False, run_in_process(system, watch, started, duration)
    except ComponentError as error:
        return True, str(error)


def _run_on_bus(system: System, watch: Watch, duration: float | None, link: Link) -> tuple[bool, str]:
    """Returns (failed, reason)."""
    from cli.on_bus import run_on_bus  # noqa: PLC0415

    return run_on_bus(system, watch, duration, link)


def _report(recording: Path | None) -> str:
    from cli.report import write_report  # noqa: PLC0415

    try:
        return str(write_report(recording)[0]) if recording is not None else ""
    except OSError as error:  # the disk that ended the recording is full for the report too
        sys.stderr.write(f"berth: {recording}: there is no report: {error.strerror}\n")
        return ""


def _print(summary: Summary, *, as_json: bool) -> None:
    if as_json:
        sys.stdout.write(json.dumps(summary.table()) + "\n")
        return
    console = Console()
    for name, value in summary.table().items():
        console.print(f"{name:12} {value}", highlight=False, soft_wrap=True)
