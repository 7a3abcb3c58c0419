"""Components as real processes on the bus."""

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import pytest
import zenoh

from runtime.assignment import Assignment
from runtime.bus import free_endpoint, open_peer, open_router
from runtime.clock import LOG_SKEW_NS
from runtime.params import ConfigurationError
from runtime.presence import STARTS, Presence, watch
from runtime.supervise import Supervisor
from runtime.wire import encoding_of, pack_stamp
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import Hold, Journal
from tests.runtime.system import Heard, heard, run_to_end, run_until, small_system, wait_for

FRAME_NS = 125_000_000


def alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A lockstep session of 40 frames, run to its end."""
    system = small_system(tmp_path_factory.mktemp("finished"), ["world.frames=40"])
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: False)
        began_s = time.monotonic()
        supervisor.stop()
        stop_s = time.monotonic() - began_s
    return supervisor, heard(system), stop_s


def test_a_session_ends_by_its_end_message_without_loss(finished):
    supervisor, _, stop_s = finished
    assert supervisor.end_reason == "all frames shown"
    assert (supervisor.exit_code, supervisor.deaths, supervisor.lost) == (0, [], 0)
    assert stop_s < 2.0


def test_every_frame_is_answered_exactly_once_from_the_first_on(finished):
    drives = [row for row in finished[1] if row.key == "echo/drive"]
    answers = [row.capture_ns for row in drives if BaseCommand.FromString(row.payload).v_mps >= 0]
    assert answers == [frame * FRAME_NS for frame in range(40)]


def test_the_tap_hears_every_key_without_a_hole_up_to_the_last_word(finished):
    sequences: dict[str, list[int]] = {}
    for row in finished[1]:
        sequences.setdefault(row.key, []).append(row.sequence)
    assert all(found == list(range(len(found))) for found in sequences.values())
    last = [row for row in finished[1] if row.key == "echo/drive"][-1]
    assert BaseCommand.FromString(last.payload).v_mps == -2.0  # what echo says at the stop


def test_the_journal_names_every_event_in_order(finished):
    batches = [Journal.FromString(row.payload) for row in finished[1] if row.key == "echo/journal"]
    names = [batch.ports[port] for batch in batches for port in batch.port]
    assert names == ["image"] * 40 + ["stop"]
    sequences = [sequence for batch in batches for sequence in batch.source_sequence]
    assert sequences[:40] == list(range(40))


def test_log_time_at_the_tap_is_the_capture_time_and_keeps_each_sequence(finished):
    newest: dict[tuple[str, int], int] = {}
    for row in finished[1]:
        assert row.time_ns >= max(row.capture_ns, newest.get((row.key, row.run), 0))
        newest[row.key, row.run] = row.time_ns
    late = [row for row in finished[1] if row.key == "world/image" and row.time_ns != row.capture_ns]
    assert len(late) == 0 or max(newest.values()) - late[0].capture_ns > LOG_SKEW_NS


def test_a_crash_stops_everything_and_is_told_in_one_line(tmp_path):
    with Supervisor(small_system(tmp_path, ["echo.crash_at=5"])) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        pids = list(supervisor.pids.values())
        run_to_end(supervisor)
    assert supervisor.exit_code == 1
    assert "echo ended with exit code 1: RuntimeError: told to crash" in supervisor.end_reason
    assert not any(map(alive, pids))


def test_a_killed_component_is_reported_and_its_peers_learn_of_it(tmp_path):
    system = small_system(tmp_path, ["world.frames=0"])
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        pids = supervisor.pids
        _kill(pids["world"])
        run_to_end(supervisor)
    assert supervisor.end_reason == "world was killed by SIGKILL"
    assert supervisor.exit_code == 1
    assert not any(map(alive, pids.values()))
    speeds = [BaseCommand.FromString(row.payload).v_mps for row in heard(system) if row.key == "echo/drive"]
    assert -1.0 in speeds  # what echo says when a peer is gone


def _kill(pid: int) -> None:
    subprocess.run(["kill", "-KILL", str(pid)], check=True)


def test_no_process_outlives_a_killed_supervisor(tmp_path):
    small_system(tmp_path, ["world.frames=0"])
    code = (
        "import sys; from runtime.launch import load; from runtime.supervise import Supervisor\n"
        "from pathlib import Path\n"
        f"system = load({str(tmp_path / 'small.toml')!r}, ['world.frames=0'], recording=Path({str(tmp_path)!r}, 'w'))\n"
        "with Supervisor(system) as s:\n"
        "    while s.missing: s.poll(0.01)\n"
        "    print(*s.pids.values(), flush=True)\n"
        "    while s.poll(): pass\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as supervisor:
        pids = [int(word) for word in supervisor.stdout.readline().split()]
        assert len(pids) == 3
        assert all(map(alive, pids))
        supervisor.kill()
    assert wait_for(lambda: not any(map(alive, pids)), 3.0)


def test_a_restarted_component_goes_on_and_time_is_held_meanwhile(tmp_path):
    system = small_system(tmp_path, ["world.frames=60", "echo.crash_at=40"], echo='restart = "on-failure"', stall_s=0.3)
    with Supervisor(system) as supervisor:
        run_to_end(supervisor)
    assert supervisor.end_reason == "all frames shown"
    assert [(death.name, death.restarted) for death in supervisor.deaths] == [("echo", True)]
    assert supervisor.restarted == "1; echo ended with exit code 1: RuntimeError: told to crash"
    assert supervisor.exit_code == 0
    rows = heard(system)
    assert len({row.run for row in rows if row.key == "echo/drive"}) == 2
    holds = [Hold.FromString(row.payload).active for row in rows if row.key == "supervisor/hold"]
    assert holds == [True, False]


def test_a_component_that_fails_for_ever_is_given_up(tmp_path):
    echo = 'restart = "on-failure"\nrestart_limit = 1'
    system = small_system(tmp_path, ["world.frames=0", "echo.crash_at=0"], echo=echo, stall_s=0.2)
    with Supervisor(system) as supervisor:
        run_to_end(supervisor)
    assert [death.restarted for death in supervisor.deaths] == [True, False]
    assert supervisor.exit_code == 1


def test_a_missing_answer_is_a_named_stall(tmp_path):
    system = small_system(tmp_path, ["world.frames=20", "echo.silent_at=10"], stall_s=0.3)
    with Supervisor(system) as supervisor:
        run_to_end(supervisor)
    assert supervisor.end_reason == "all frames shown"
    assert supervisor.statuses["world"].note == "stall: nothing on drive since 1.125 s"
    journal = [Journal.FromString(row.payload) for row in heard(system) if row.key == "world/journal"]
    assert Counter(batch.ports[port] for batch in journal for port in batch.port)["stall"] == 1


def test_what_is_malformed_is_counted_and_changes_nothing(tmp_path):
    system = small_system(tmp_path, ["world.frames=0"], clock="real")
    good = CompressedImage(format="none").SerializeToString()
    stamp, encoding = pack_stamp(1, 0, 0), encoding_of(CompressedImage)
    junk = [
        (good, None, encoding),  # no attachment
        (good, b"short", encoding),
        (good, stamp, "text/plain"),
        (good, stamp, encoding_of(BaseCommand)),
        (good, stamp, encoding),  # a run that nobody announced
        (good, pack_stamp(1, 0, -5), encoding),  # before the session
        (b"\xff\xff\xff", stamp, encoding),
    ]
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        with open_peer(supervisor.run.endpoint) as stranger:
            seen = Presence(("world", "echo", "witness"))
            watch(stranger, system.realm, seen, lambda *_: None, pytest.fail)
            assert seen.wait(STARTS, 20.0)  # a token comes after the subscribers of its process
            for payload, attachment, kind in junk:
                stranger.put(f"{system.realm}/world/image", payload, attachment=attachment, encoding=kind)
            stranger.delete(f"{system.realm}/world/image")
            stranger.put(f"{system.realm}/nobody/knows", b"x")
            run_until(supervisor, lambda: supervisor.statuses["echo"].malformed >= len(junk) + 1)
            run_until(supervisor, lambda: supervisor.statuses["witness"].malformed >= len(junk) + 2)
        supervisor.stop()
    assert supervisor.exit_code == 0
    assert supervisor.statuses["echo"].malformed == len(junk) + 1
    assert supervisor.statuses["echo"].lost == 0
    rows = heard(system)
    images = sum(row.key == "world/image" for row in rows)
    answers = [row for row in rows if row.key == "echo/drive" and BaseCommand.FromString(row.payload).v_mps >= 0]
    assert abs(len(answers) - images) <= 1


def test_what_is_said_again_is_refused_counted_and_told_and_changes_nothing(tmp_path):
    """Every image of a run, again while it goes on, and all of them once more when the world has been started again."""
    system = small_system(tmp_path, ["world.frames=0"], clock="real", world='restart = "on-failure"')
    taken: list[zenoh.Sample] = []
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        with open_peer(supervisor.run.endpoint) as stranger:
            subscriber = stranger.declare_subscriber(f"{system.realm}/world/image", taken.append)
            run_until(supervisor, lambda: len(taken) >= 8)
            say_again(stranger, taken[:8])
            run_until(supervisor, lambda: supervisor.statuses["echo"].malformed >= 8)
            assert "came after" in supervisor.refusal
            subscriber.undeclare()
            old = list(taken)
            _kill(supervisor.pids["world"])
            run_until(supervisor, lambda: bool(supervisor.deaths))
            before = supervisor.statuses["echo"].handled
            run_until(supervisor, lambda: supervisor.statuses["echo"].handled > before + 8)
            known = supervisor.statuses["echo"].malformed
            say_again(stranger, old)
            run_until(supervisor, lambda: supervisor.statuses["echo"].malformed >= known + len(old))
        supervisor.stop()
    assert supervisor.refused >= 2 * (8 + len(old)), "echo and the witness"
    answers = [row.capture_ns for row in heard(system) if row.key == "echo/drive" and is_answer(row)]
    assert len(answers) == len(set(answers)), "no frame is answered twice"


def say_again(session: zenoh.Session, samples: list[zenoh.Sample]) -> None:
    for sample in samples:
        session.put(sample.key_expr, sample.payload, attachment=sample.attachment, encoding=sample.encoding)


def is_answer(row: Heard) -> bool:
    return BaseCommand.FromString(row.payload).v_mps >= 0


def test_by_default_nothing_listens_off_loopback(tmp_path):
    system = small_system(tmp_path, ["world.frames=0"], clock="real")
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        found = {pid: listening(pid) for pid in (os.getpid(), *supervisor.pids.values())}
    assert all(found.values()), "each process has a place of its own"
    assert {address for addresses in found.values() for address in addresses} == {"tcp 0100007F"}


def listening(pid: int) -> set[str]:
    """Protocol and hexadecimal address of each socket of a process that hears whoever comes (Linux)."""
    inodes, found = set(), set()
    for file in Path(f"/proc/{pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            inodes.add(str(file.readlink()))
    for protocol in ("tcp", "tcp6", "udp", "udp6"):
        for line in Path(f"/proc/{pid}/net/{protocol}").read_text(encoding="ascii").splitlines()[1:]:
            _, local, _, state, *_, inode = line.split()[:10]
            if f"socket:[{inode}]" in inodes and (state == "0A" or protocol.startswith("udp")):
                found.add(f"{protocol} {local.partition(':')[0]}")
    return found


def test_two_realms_do_not_mix(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    systems = [small_system(tmp_path / name, ["world.frames=30"]) for name in "ab"]
    with Supervisor(systems[0]) as first, Supervisor(systems[1]) as second:
        run_to_end(first)
        run_to_end(second)
    for system in systems:
        runs = {(row.key, row.run) for row in heard(system)}
        assert len(runs) == len({key for key, _ in runs})


def test_a_busy_realm_is_refused(tmp_path):
    system = small_system(tmp_path)
    with Supervisor(system), pytest.raises(ConfigurationError, match="realm must not run yet"):
        Supervisor(system).start()


def test_a_busy_endpoint_is_refused_and_leaves_nothing(tmp_path):
    endpoint = free_endpoint()
    with open_router(endpoint), pytest.raises(ConfigurationError, match=f"endpoint {endpoint} must be free"):
        Supervisor(small_system(tmp_path), endpoint=endpoint).__enter__()


def test_a_peer_that_never_comes_is_named(tmp_path):
    system = small_system(tmp_path)
    endpoint = free_endpoint()
    with open_router(endpoint):
        assignment = Assignment(system, "echo", ("echo", "ghost"), endpoint, 0, "", ready_timeout_s=0.3)
        process = subprocess.Popen(
            [sys.executable, "-m", "runtime.process"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        process.stdin.write(assignment.to_json() + "\n")
        process.stdin.flush()
        assert process.wait(timeout=20) == 1
        assert "echo: no sign of ghost after" in process.stdout.read()


def test_one_signal_to_one_component_ends_it_cleanly_and_the_session_with_it(tmp_path):
    with Supervisor(small_system(tmp_path, ["world.frames=0"])) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        subprocess.run(["kill", f"-{signal.SIGINT:d}", str(supervisor.pids["echo"])], check=True)
        run_to_end(supervisor)
    assert supervisor.end_reason.startswith("echo ended with exit code 0")
    assert supervisor.exit_code == 1


def test_zenoh_is_as_the_door_expects_it():
    """An attachment that is missing is None, and `REALM/**` does not match a verbatim chunk."""
    assert not zenoh.KeyExpr("realm/**").intersects(zenoh.KeyExpr("realm/@ready/1/a/b"))
    assert zenoh.KeyExpr("realm/@ready/*/*/*").intersects(zenoh.KeyExpr("realm/@ready/1/a/b"))
