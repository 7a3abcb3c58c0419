"""A system in one process: total order of messages, virtual time, and every way to end."""

import itertools

import pytest

from runtime.contract import ComponentError, Event
from runtime.launch import load
from runtime.lockstep import Lockstep
from schemas.drive_pb2 import BaseCommand
from schemas.session_pb2 import Journal

FRAME_NS = 125_000_000


class Listener:
    """A tap that keeps what it is told."""

    def __init__(self) -> None:
        self.heard: list[tuple] = []
        self.closed = 0

    def message(self, key, schema, payload, run, sequence, capture_ns, time_ns):
        self.heard.append((key, schema, payload, run, sequence, capture_ns, time_ns))
        return ()

    def tick(self, time_ns):
        return ()

    def close(self):
        self.closed += 1
        return ()


def make(tmp_path, frames: int = 6, echo: str = "", more: str = ""):
    (tmp_path / "lock.toml").write_text(
        f"""
realm = "test/lockstep"
[session]
end = "world/end"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "echo/drive" }}
params = {{ frames = {frames} }}
[component.echo]
run = "tests.runtime.parts.echo"
inputs = {{ image = "world/image" }}
{echo}
{more}
""",
        encoding="utf-8",
    )
    return load(tmp_path / "lock.toml")


def run(system, duration_s=None) -> tuple[Lockstep, Listener, str]:
    listener = Listener()
    engine = Lockstep(system, taps=[listener])
    return engine, listener, engine.run(duration_s)


def stamps(listener: Listener, key: str) -> list[int]:
    return [capture_ns for k, _, _, _, _, capture_ns, _ in listener.heard if k == key]


def test_a_session_ends_with_its_end_message(tmp_path):
    engine, listener, reason = run(make(tmp_path))
    assert reason == engine.end_reason == "all frames shown"
    assert stamps(listener, "world/image") == [k * FRAME_NS for k in range(6)]
    assert listener.closed == 1


def test_the_world_s_next_frame_is_taken_at_its_own_time(tmp_path):
    _, listener, _ = run(make(tmp_path))
    frames = [(key, time_ns) for key, *_, time_ns in listener.heard if key in {"world/image", "echo/drive"}]
    expected = [(key, k * FRAME_NS) for k in range(6) for key in ("world/image", "echo/drive")]
    assert frames[:12] == expected


def test_time_never_runs_backwards_and_never_before_the_capture(tmp_path):
    _, listener, _ = run(make(tmp_path))
    times = [row[-1] for row in listener.heard]
    assert times == sorted(times)
    assert all(capture_ns <= time_ns for *_, capture_ns, time_ns in listener.heard)


def test_sequences_count_from_zero_and_runs_are_the_same_every_time(tmp_path):
    system = make(tmp_path)
    heard = [run(system)[1].heard for _ in range(2)]
    assert heard[0] == heard[1]
    rows = {key: [row for row in heard[0] if row[0] == key] for key in ("world/image", "echo/drive")}
    assert [row[4] for row in rows["echo/drive"]] == list(range(7))
    assert {row[3] for row in rows["world/image"]} == {1}
    assert {row[3] for row in rows["echo/drive"]} == {2}


def test_readers_get_the_bytes_not_the_object(tmp_path):
    engine = Lockstep(make(tmp_path, frames=2))
    handed: list[Event] = []
    engine.observe = lambda name, event, _: handed.append(event) if name == "echo" else None
    engine.run()
    images = [event.message for event in handed if event.port == "image"]
    assert [image.format for image in images] == ["none"] * 2
    assert images[0] is not images[1]


def test_everyone_gets_the_stop_last_and_what_they_say_is_recorded(tmp_path):
    listener = Listener()
    engine = Lockstep(make(tmp_path), taps=[listener])
    last: dict[str, str] = {}
    engine.observe = lambda name, event, _: last.__setitem__(name, event.port)
    engine.run()
    assert last == {"world": "stop", "echo": "stop"}
    said = [BaseCommand.FromString(row[2]).v_mps for row in listener.heard if row[0] == "echo/drive"]
    assert said[-1] == -2.0


def test_duration_is_session_time_and_the_message_behind_it_is_kept(tmp_path):
    engine, listener, reason = run(make(tmp_path, frames=0), 1.0)
    assert reason == "duration"
    assert engine.time_ns == 8 * FRAME_NS
    assert stamps(listener, "echo/drive")[:-1] == [k * FRAME_NS for k in range(9)]
    assert stamps(listener, "world/image") == [k * FRAME_NS for k in range(10)], "shown, but seen by nobody"


def test_stop_ends_after_the_message_at_hand(tmp_path):
    engine = Lockstep(make(tmp_path, frames=0))
    seen = []

    def look(message, capture_ns):
        seen.append(capture_ns)
        if len(seen) == 3:
            engine.stop("enough")
            engine.stop("the first reason counts")

    engine.watch("world/image", look)
    assert engine.run() == "enough"
    assert engine.time_ns == 2 * FRAME_NS


def test_a_missing_answer_is_a_stall_and_the_world_goes_on(tmp_path):
    _, listener, reason = run(make(tmp_path, echo="params = { silent_at = 3 }"))
    assert reason == "all frames shown"
    assert stamps(listener, "world/image") == [k * FRAME_NS for k in range(6)]
    assert 3 * FRAME_NS not in stamps(listener, "echo/drive")
    (journal,) = [Journal.FromString(row[2]) for row in listener.heard if row[0] == "world/journal"]
    assert [journal.ports[port] for port in journal.port].count("stall") == 1


def test_a_system_in_which_nobody_speaks_is_an_error(tmp_path):
    (tmp_path / "still.toml").write_text(
        'realm = "a/b"\n[component.a]\nrun = "tests.runtime.parts.deaf"\n', encoding="utf-8"
    )
    with pytest.raises(ComponentError, match=r"lockstep stands still at 0\.000 s: nobody answers"):
        Lockstep(load(tmp_path / "still.toml")).run()


def test_what_a_component_raises_ends_the_session(tmp_path):
    with pytest.raises(RuntimeError, match="told to crash"):
        run(make(tmp_path, echo="params = { crash_at = 2 }"))


def test_the_journal_names_every_event_with_its_source(tmp_path):
    listener = Listener()
    engine = Lockstep(make(tmp_path, frames=300), taps=[listener])
    events = []
    engine.observe = lambda name, event, _: events.append(event) if name == "world" else None
    engine.run()
    batches = [Journal.FromString(row[2]) for row in listener.heard if row[0] == "world/journal"]
    assert [batch.first for batch in batches] == [
        0,
        *itertools.accumulate(len(batch.port) for batch in batches[:-1]),
    ]
    rows = []
    for batch in batches:
        times = itertools.accumulate(batch.time_delta_ns)
        columns = (batch.source_run, batch.source_sequence, times)
        rows += zip((batch.ports[port] for port in batch.port), *columns, strict=True)
    assert rows == [(event.port, event.source_run, event.sequence, event.time_ns) for event in events]


def test_ticks_come_once_a_period_before_the_message(tmp_path):
    engine = Lockstep(make(tmp_path))
    ticks = []
    engine.observe = lambda name, event, _: ticks.append(event.time_ns) if event.port == "tick" else None
    engine.run()
    assert ticks == [k * FRAME_NS for k in range(6)]


def test_messages_of_one_time_come_in_the_order_of_their_publication(tmp_path):
    faulty = '[component.faulty]\nrun = "tests.runtime.parts.faulty"\ninputs = { image = "world/image" }\n'
    _, listener, _ = run(make(tmp_path, more=faulty + 'params = { fault = "undeclared" }'))
    said = [row[0] for row in listener.heard if row[5] == 4 * FRAME_NS and "journal" not in row[0]]
    assert said == ["world/image", "echo/drive", "faulty/drive", "faulty/word"], "readers in launch order"
