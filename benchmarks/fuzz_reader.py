"""Ten thousand spoiled sessions through everything that reads one: one clear error or a result, never a traceback."""

from __future__ import annotations

import random
import resource
import sys
import tempfile
import time
from collections import Counter
from io import BytesIO
from pathlib import Path

from mcap.records import Attachment, Channel, Header, Metadata, Schema
from mcap.writer import CompressionType, Writer

from benchmarks.figure import Figure
from benchmarks.mutations import mutated
from cli.in_process import run_in_process
from cli.info import numbers
from cli.progress import Progress
from cli.session import Watch
from report.session import read
from runtime.findings import Examination
from runtime.launch import load
from runtime.mcap_items import RawMessage, items
from runtime.mend import mend
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.replay import replay

CASES = 10_000
SESSION_S = 1.5
CHUNK_BYTES = 4096
"""Small, so that one mutation spoils a part of the session and not all of it."""
REPLAYED = ("head", "base", "grasper", "pilot")
"""Components whose start costs little; every fifth case is replayed by one of them."""


def figures() -> list[Figure]:
    """Half of the cases have no checksums, so that the damage gets past the chunks."""
    with tempfile.TemporaryDirectory() as folder:
        directory = Path(folder)
        seeds = _seeds(directory)
        _read(directory, 0)  # imports are not the cases'
        before_mb, escaped, slowest_s, ends = _peak_mb(), 0, 0.0, Counter[str]()
        rng = random.Random(20051122)
        file = directory / "case.mcap"
        for number in range(CASES):
            file.write_bytes(mutated(seeds[number % len(seeds)], rng))
            began_s = time.perf_counter()
            try:
                _read(directory, number)
                ends["read"] += 1
            except ConfigurationError as error:
                ends["refused"] += 1
                escaped += "\n" in str(error)
            except Exception as error:  # noqa: BLE001  (what must not happen is counted and shown)
                escaped += 1
                sys.stderr.write(f"case {number}: {type(error).__name__}: {error}\n")
            slowest_s = max(slowest_s, time.perf_counter() - began_s)
    return [
        Figure("cases", CASES, at_least=10_000, note=f"{ends['refused']} refused in one line, {ends['read']} read"),
        Figure("tracebacks", escaped, at_most=0),
        Figure("memory on top", _peak_mb() - before_mb, "MB", at_most=300, note="largest record read: 64 MB"),
        Figure("slowest case", slowest_s, "s", at_most=5.0),
    ]


def _read(directory: Path, number: int) -> None:
    """What info, doctor, recover and, now and then, replay do."""
    mended = directory / "mended.mcap"
    mended.unlink(missing_ok=True)
    recording = Recording(directory / "case.mcap")
    recording.session()
    for logged in recording.messages():
        logged.decoded()
    if number % 5 == 0:
        replay(recording, REPLAYED[number // 5 % len(REPLAYED)])
    numbers(read(recording.file))
    Examination(recording).run()
    mend(recording, mended)


def _seeds(directory: Path) -> tuple[bytes, bytes]:
    """A short session of the simulation as it was recorded, and the same without compression and checksums."""
    file = directory / "case.mcap"
    system = load("launch/sim.toml", [f"recorder.chunk_bytes={CHUNK_BYTES}"], recording=file)
    run_in_process(system, Watch(Progress("", quiet=True)), "", SESSION_S)
    content = file.read_bytes()
    bare = BytesIO()
    writer = Writer(bare, chunk_size=CHUNK_BYTES, compression=CompressionType.NONE, enable_crcs=False)
    for item in items(BytesIO(content), []):
        _copy(writer, item)
    writer.finish()
    return content, bare.getvalue()


def _copy(writer: Writer, item: object) -> None:
    if isinstance(item, Header):
        writer.start(item.profile, item.library)
    elif isinstance(item, Metadata):
        writer.add_metadata(item.name, item.metadata)
    elif isinstance(item, Attachment):
        writer.add_attachment(0, 0, item.name, item.media_type, item.data)
    elif isinstance(item, Schema):
        writer.register_schema(item.name, item.encoding, item.data)
    elif isinstance(item, Channel):
        writer.register_channel(item.topic, item.message_encoding, item.schema_id, item.metadata)
    elif isinstance(item, RawMessage):
        writer.add_message(item.channel, item.log_ns, item.payload, item.publish_ns, item.sequence)


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
