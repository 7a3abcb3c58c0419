"""`berth record` beside a running system."""

import resource
import signal

import pytest

from cli.record import record
from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from schemas.drive_pb2 import BaseCommand
from tests.cli.running import berth, by_key, finish, is_growing, messages, told
from tests.runtime.system import recorded_system, run_until

pytestmark = pytest.mark.xdist_group("live")


@pytest.fixture(scope="module")
def overheard(tmp_path_factory):
    """A paced system, recorded by its own recorder and from outside: a part of it, and the rest to its end."""
    directory = tmp_path_factory.mktemp("overheard")
    system = recorded_system(directory, ["world.frames=0"], clock="10")
    files = directory / "part.mcap", directory / "rest.mcap"
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        part = berth("record", "-o", files[0], "--realm", system.realm, "--json")
        run_until(supervisor, is_growing(files[0]))
        part.send_signal(signal.SIGINT)
        rest = berth("record", "-o", files[1], "--realm", system.realm, "-x", "image|status", "--json")
        run_until(supervisor, is_growing(files[1]))
        supervisor.stop("interrupted")
    return messages(system.recording), (told(part), messages(files[0])), (told(rest), messages(files[1])), supervisor


def test_a_recording_from_outside_holds_the_same_messages_as_the_systems_own(overheard):
    own, (_, part), _, _ = overheard
    heard = {(row.topic, row.run, row.sequence): (row.schema, row.payload, row.capture_ns) for row in own}
    same = [heard.get((row.topic, row.run, row.sequence)) == (row.schema, row.payload, row.capture_ns) for row in part]
    unknown_to_the_own = [row.topic for row in part if (row.topic, row.run, row.sequence) not in heard]
    assert same.count(True) > 20
    assert set(unknown_to_the_own) <= set()


def test_it_has_no_hole_and_says_so(overheard):
    for table, rows in overheard[1:3]:
        assert (table["lost"], table["dropped"], table["refused"]) == (0, 0, 0)
        assert table["messages"] == len(rows) == sum(table["topics"].values())
        for found in by_key(rows).values():
            numbers = [row.sequence for row in found]
            assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_it_joins_late_and_keeps_session_time(overheard):
    own, (_, part), _, _ = overheard
    assert part[0].capture_ns > 0
    times = [row.time_ns for row in part]
    assert times == sorted(times)
    arrival_ns = {(row.topic, row.sequence): row.time_ns for row in own}
    late_ns = [abs(row.time_ns - arrival_ns[row.topic, row.sequence]) for row in part]
    assert sorted(late_ns)[len(late_ns) // 2] < 1e9  # ten times as fast as real: a tenth of a wall second


def test_ctrl_c_ends_it_and_the_systems_end_too(overheard):
    assert overheard[1][0]["exit_reason"] == "interrupted"
    assert overheard[2][0]["exit_reason"] == "the system has ended"


def test_it_hears_the_last_word(overheard):
    drives = by_key(overheard[2][1])["echo/drive"]
    assert BaseCommand.FromString(drives[-1].payload).v_mps == -2.0  # what echo says at the stop


def test_excluded_topics_are_left_out(overheard):
    assert not [key for key in by_key(overheard[2][1]) if "image" in key or "status" in key]


def test_the_system_does_not_notice(overheard):
    supervisor = overheard[3]
    assert (supervisor.lost, supervisor.deaths) == (0, [])
    assert [status.malformed for status in supervisor.statuses.values()] == [0, 0, 0]


def test_in_lockstep_the_system_waits_rather_than_lose_a_message(tmp_path):
    system = recorded_system(tmp_path, ["world.frames=0"])
    file = tmp_path / "all.mcap"
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        watching = berth("record", "-o", file, "--realm", system.realm, "-x", "status", "--json")
        run_until(supervisor, is_growing(file))
        supervisor.stop()
    table = told(watching)
    assert (table["dropped"], table["refused"]) == (0, 0)
    rows = messages(file)
    assert len(rows) > 500
    assert not [row for row in rows if row.topic == "record/gap"]  # time stood still while it joined
    assert table["lost"] == 0


def test_a_full_disk_ends_the_recording_and_not_the_system(tmp_path):
    system = recorded_system(tmp_path, ["world.frames=0"], clock="10")
    file = tmp_path / "part.mcap"
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        watching = berth("record", "-o", file, "--realm", system.realm)
        run_until(supervisor, is_growing(file))
        size = file.stat().st_size + 100
        resource.prlimit(watching.pid, resource.RLIMIT_FSIZE, (size, size))
        run_until(supervisor, lambda: watching.poll() is not None)
        code, out, _ = finish(watching)
        assert supervisor.poll(0.1)
    assert code == 1
    assert "part.mcap: can not be written any more: File too large; it is kept up to" in out
    assert messages(file)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"realm": "no/such"}, "realm no/such must be running"),
        ({"topics": "no/such"}, "--topics must be keys of"),
        ({"exclude": "."}, "must leave a key of"),
        ({"include": "("}, "-e must be a regular expression"),
    ],
)
def test_mistakes_are_named_before_anything_is_made(tmp_path, idle, options, said):
    file = tmp_path / "x.mcap"
    with pytest.raises(ConfigurationError, match=said):
        record(file, **{"realm": idle, **options})
    assert not file.exists()


def test_a_recording_is_never_overwritten(tmp_path, idle):
    (tmp_path / "x.mcap").write_bytes(b"precious")
    code, out, err = finish(berth("record", "-o", tmp_path / "x.mcap", "--realm", idle))
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert "x.mcap: must not exist yet; a recording is never overwritten" in err
    assert (tmp_path / "x.mcap").read_bytes() == b"precious"


@pytest.fixture(scope="module")
def idle(tmp_path_factory):
    """Realm of a system that runs."""
    system = recorded_system(tmp_path_factory.mktemp("idle"), ["world.frames=0"], clock="real")
    with Supervisor(system):
        yield system.realm
