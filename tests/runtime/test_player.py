"""A log on the bus: everything, in order, under new names; in place of a component too."""

import threading
import time
from contextlib import contextmanager

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import Writer

from runtime import listener
from runtime.answers import Answers, stands
from runtime.contract import ComponentError
from runtime.joining import description
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.player import Player
from runtime.playhead import Playhead
from runtime.playlist import Playlist, in_order
from runtime.recording import Logged, Recording
from runtime.runfile import find
from runtime.selection import Selection
from runtime.stage import joined_stage, own_stage
from runtime.supervise import Supervisor
from tests.cli.running import Ear, by_key, messages
from tests.runtime.system import recorded_system, run_until

pytestmark = pytest.mark.xdist_group("live")
FRAMES = 120


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A whole lockstep session of world and echo, whose recorder is never far behind."""
    system = recorded_system(tmp_path_factory.mktemp("log"), [f"world.frames={FRAMES}", "world.window=16"])
    with Supervisor(system) as supervisor:
        run_until(supervisor)
        supervisor.stop()
    assert supervisor.exit_code == 0
    return system


def in_log_order(file):
    """What is to be heard of a log."""
    return sorted(messages(file), key=lambda row: row.time_ns)


def playlist(log, selection=None, remap=None, **options) -> Playlist:
    return Playlist(Recording(log.recording), selection or Selection(), remap or {}, **options)


@contextmanager
def heard_in(realm, keys):
    """What is heard in a realm, complete after the context."""
    ear = Ear(find(realm), keys)
    ear.start()
    yield ear.rows
    ear.finish()


def play(log, chosen, head, until=None, **options):
    """Play in a realm of its own; what was heard, and how long it took."""
    realm = f"replay/{log.realm}"
    with own_stage(chosen, realm) as stage:
        player = Player(chosen, stage, head, **options)
        with heard_in(realm, [*chosen.topics, "player/clock"]) as rows:
            if until is not None:
                until(player, rows)
            began_s = time.monotonic()
            player.run()
            wall_s = time.monotonic() - began_s
    return [row for row in rows if row.topic != "player/clock"], wall_s


def contents(rows):
    return [(row.topic, row.schema, row.payload, row.capture_ns) for row in rows]


def test_as_fast_as_possible_is_held_back_by_the_slowest_and_loses_nothing(log, monkeypatch):
    monkeypatch.setattr(listener, "_QUEUE", 8)
    rows, _ = play(log, playlist(log), Playhead(0.0))
    assert contents(rows) == contents(in_log_order(log.recording))


def test_a_played_run_is_a_new_one_whose_sequences_begin_at_zero(log):
    rows, _ = play(log, playlist(log, start_s=5.0), Playhead(0.0))
    logged = messages(log.recording)
    assert not {row.run for row in rows} & {row.run for row in logged}
    assert len({row.run for row in rows}) == len({row.run for row in logged if row.time_ns >= 5e9})
    for found in by_key(rows).values():
        assert [row.sequence for row in found] == list(range(len(found)))


def test_a_loop_begins_a_new_epoch_in_which_time_starts_anew(log):
    chosen = playlist(log, Selection(topics=("world/image",)))

    def stop_in_the_third(player, rows):
        def watch():
            while player.epochs < 3:
                time.sleep(0)
            player.stop("enough")

        threading.Thread(target=watch, daemon=True).start()

    rows, _ = play(log, chosen, Playhead(0.0), until=stop_in_the_third, loop=True)
    epochs: dict[int, list[int]] = {}
    for row in rows:
        epochs.setdefault(row.run, []).append(row.capture_ns)
    frames = [row.capture_ns for row in messages(log.recording) if row.topic == "world/image"]
    assert list(epochs.values())[:2] == [frames, frames]


def test_the_rate_stretches_time(log):
    logged = in_log_order(log.recording)
    span_s = (logged[-1].time_ns - logged[0].time_ns) / 1e9
    _, wall_s = play(log, playlist(log), Playhead(40.0))
    assert wall_s >= 0.99 * span_s / 40


def test_paused_plays_nothing_until_it_is_told_to(log):
    def drive(player, rows):
        for word in ("step", "step", "step", "quit"):
            player.command(word)

    rows, _ = play(log, playlist(log), Playhead(1.0, paused=True), until=drive)
    assert rows == []  # quit is obeyed before the first step was due

    def step_then_quit(player, rows):
        for _ in range(3):
            player.command("step")

        def quit_after_three():
            while player.played < 3:
                time.sleep(0)
            player.command("quit")

        threading.Thread(target=quit_after_three, daemon=True).start()

    rows, _ = play(log, playlist(log), Playhead(1.0, paused=True), until=step_then_quit)
    assert contents(rows) == contents(in_log_order(log.recording))[:3]


def test_a_seek_begins_a_new_epoch_there(log):
    chosen = playlist(log, Selection(topics=("world/image",)))

    def jump(player, rows):
        player.command("forward")

    rows, _ = play(log, chosen, Playhead(0.0), until=jump)
    later = [row for row in messages(log.recording) if row.topic == "world/image" and row.time_ns >= 5e9]
    assert 0 < len(later) < FRAMES
    assert contents(rows) == contents(later)


def test_a_stretch_of_the_log_is_chosen_by_its_own_time(log):
    chosen = playlist(log, start_s=2.0, duration_s=3.0)
    first_ns = in_log_order(log.recording)[0].time_ns
    wanted = [row for row in in_log_order(log.recording) if 2e9 <= row.time_ns - first_ns <= 5e9]
    assert list(chosen.messages(chosen.start_ns)) == wanted


def test_a_remapped_topic_is_played_under_its_new_name_and_owner(log):
    chosen = playlist(log, Selection(topics=("world/image",)), {"world/image": "camera/image"})
    assert chosen.topics == {"camera/image": "foxglove.CompressedImage"}
    assert chosen.owners == {"camera/image": "world"}
    assert {row.topic for row in chosen.messages(0)} == {"camera/image"}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"remap": {"no/such": "a/b"}}, "--remap no/such: must be a topic of"),
        ({"remap": {"world/image": "echo/drive"}}, "must not put two topics on one key"),
        ({"owners": ("ghost",)}, "must hold messages of ghost"),
        ({"selection": Selection(exclude=".")}, "must leave a key of"),
    ],
)
def test_what_can_not_be_played_is_refused_by_name(log, options, said):
    with pytest.raises(ConfigurationError, match=said):
        playlist(log, **options)


def test_a_log_that_was_torn_before_its_first_message_is_refused(log, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(log.recording.read_bytes()[:8192])
    assert list(Recording(torn).messages()) == []
    with pytest.raises(ConfigurationError, match=r"torn\.mcap: must hold messages; there are none that can be read"):
        Playlist(Recording(torn), Selection(), {})


def test_a_strangers_log_is_refused(tmp_path):
    with (tmp_path / "ros.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="ros2")
        channel = writer.register_channel(
            "/scan", "cdr", writer.register_schema("sensor_msgs/LaserScan", "ros2msg", b"")
        )
        writer.add_message(channel, 0, b"", 0)
        writer.finish()
    with pytest.raises(ConfigurationError, match=r"ros\.mcap: must be a session recorded by berth"):
        Playlist(Recording(tmp_path / "ros.mcap"), Selection(), {})


@given(st.lists(st.integers(0, 9), max_size=60))
def test_frames_are_put_in_order_if_none_comes_later_than_the_skew(frames):
    captures = [frame + number for number, frame in enumerate(frames)]  # at most 9 behind the newest
    rows = [Logged("a/b", "", b"", 1, number, capture, 0) for number, capture in enumerate(captures)]
    assert list(in_order(rows, 9, lambda row: row.capture_ns)) == sorted(rows, key=lambda row: row.capture_ns)


def test_a_file_in_which_time_stands_still_is_not_held_in_memory():
    rows = (Logged("a/b", "", b"", 1, number, 0, 0) for number in range(50_000))
    ordered = in_order(rows, 9, lambda row: row.time_ns)
    next(ordered)
    assert next(rows).sequence < 20_000
    assert [row.sequence for row in ordered][:3] == [1, 2, 3]


def stand_in(log, run, name):
    """A player in a component's place, at full speed."""
    spec = log.component(name)
    others = {key for other in log.components if other is not spec for key in other.outputs.values()}
    frames = others & {"world/image"}
    chosen = playlist(log, owners=(name,), known=run.topics, by_frame=True)
    return chosen, joined_stage(run, description(run), chosen, {}), Answers(stands([spec], others), frames)


def play_instead(log, name, file):
    """Play a component in a system that runs without it; what was recorded."""
    system = load(log.file, ["world.frames=0"], only={"world", "echo", "recorder"} - {name}, recording=file)
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        chosen, opened, answers = stand_in(log, find(system.realm), name)
        with opened as stage:
            player = Player(chosen, stage, Playhead(0.0), clock=False, answers=answers)
            assert player.run() == "end of the log"
            if name == "world":
                with pytest.raises(ComponentError, match="can not go back to 0"):
                    Player(chosen, stage, Playhead(0.0), clock=False, answers=Answers(answers.stands)).run()
        supervisor.stop("played")
    assert (supervisor.exit_code, supervisor.lost) == (0, 0)
    assert [status.malformed for status in supervisor.statuses.values()] == [0, 0]
    return by_key(messages(file))


@pytest.mark.parametrize("name", ["world", "echo"])
def test_in_lockstep_a_log_replaces_a_component_and_every_frame_is_answered_as_before(log, tmp_path, name):
    before, again = by_key(messages(log.recording)), play_instead(log, name, tmp_path / "again.mcap")
    for key in ("world/image", "echo/drive"):
        assert contents(again[key][:FRAMES]) == contents(before[key][:FRAMES])


def epochs_of(rows, key):
    """The messages of each run, in the order of the runs."""
    found: dict[int, list] = {}
    for row in rows:
        if row.topic == key:
            found.setdefault(row.run, []).append(row)
    return list(found.values())


@pytest.mark.parametrize("name", ["world", "echo"])
def test_a_loop_in_a_running_system_begins_an_epoch_in_which_its_components_are_new(log, tmp_path, name):
    system = load(log.file, ["world.frames=0"], only={"world", "echo", "recorder"} - {name}, recording=tmp_path / "x")
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        chosen, opened, answers = stand_in(log, find(system.realm), name)
        ended = []
        with opened as stage:
            player = Player(chosen, stage, Playhead(0.0), loop=True, clock=False, answers=answers)
            playing = threading.Thread(target=lambda: ended.append(player.run()), daemon=True)
            playing.start()
            run_until(supervisor, lambda: player.epochs >= 3 and player.played > 2.2 * FRAMES)
            player.stop("enough")
            run_until(supervisor, lambda: not playing.is_alive())
        assert ended == ["enough"]
        supervisor.stop("played")
    assert (supervisor.exit_code, supervisor.lost, supervisor.deaths) == (0, 0, [])
    before, rows = by_key(messages(log.recording)), messages(tmp_path / "x")
    for key in ("world/image", "echo/drive"):
        epochs = epochs_of(rows, key)
        assert len(epochs) >= 3
        for epoch in epochs[:2]:
            assert [row.sequence for row in epoch] == list(range(len(epoch)))
            assert contents(epoch[:FRAMES]) == contents(before[key][:FRAMES])
    assert {row.topic for row in rows} >= {"world/image", "echo/drive", "recorder/ack"}


def test_who_runs_is_not_replaced(log):
    system = load(log.file, ["world.frames=0"], recording=None)
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        chosen, opened, _ = stand_in(log, find(system.realm), "world")
        with pytest.raises(ConfigurationError, match="--replace world: must not run in"), opened:
            pass
        assert chosen.owners["world/image"] == "world"
