"""A recording that can not go on: what was written stays, and it is said once, clearly."""

import os
import resource
import subprocess
import sys
import time
import tracemalloc
from datetime import UTC, datetime

import pytest
from mcap.reader import make_reader

from runtime.contract import ComponentError
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.recording import Recording
from schemas.drive_pb2 import BaseCommand
from tests.runtime.system import small_system


@pytest.fixture
def system(tmp_path):
    return small_system(tmp_path)


def write(log, count, first=0, size=100):
    for number in range(first, first + count):
        log.write("a/b", "berth.BaseCommand", os.urandom(size), 7, number, number * 1000, number * 1000)


def sequences(file):
    return [logged.sequence for logged in Recording(file).messages()]


@pytest.fixture
def full_disk(tmp_path):
    """A file system with room for little, as far as this process is concerned."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_told_once_and_what_was_flushed_is_kept(tmp_path, system, full_disk):
    file = tmp_path / "full.mcap"
    log = LogWriter(file, system, started="", compression="none")
    write(log, 100)
    log.flush()
    full_disk(file.stat().st_size + 5_000)
    write(log, 100, first=100)
    with pytest.raises(ComponentError, match=r"full\.mcap: can not be written any more: File too large; it is kept up"):
        log.flush()
    write(log, 100, first=200, size=10_000)
    log.flush()
    log.close()
    assert sequences(file) == list(range(100))


def test_a_disk_that_is_full_at_the_end_keeps_every_message(tmp_path, system, full_disk):
    file = tmp_path / "end.mcap"
    log = LogWriter(file, system, started="", compression="none")
    write(log, 100)
    log.flush()
    full_disk(file.stat().st_size + 10)
    with pytest.raises(ComponentError, match="can not be written any more"):
        log.close()
    assert sequences(file) == list(range(100))


def test_a_disk_that_is_full_from_the_start_is_told(tmp_path, system, full_disk):
    full_disk(100)
    with pytest.raises(ComponentError, match="can not be written any more"):
        LogWriter(tmp_path / "none.mcap", system, started="")


def test_a_removed_file_is_written_again_under_its_name(tmp_path, system):
    file = tmp_path / "gone.mcap"
    log = LogWriter(file, system, started="")
    write(log, 100)
    log.flush()
    file.unlink()
    write(log, 50, first=100)
    with pytest.raises(ComponentError, match=r"gone\.mcap: was removed while it was recorded"):
        log.flush()
    log.close()
    assert sequences(file) == list(range(150))


def test_a_renamed_file_is_recorded_on(tmp_path, system):
    log = LogWriter(tmp_path / "old.mcap", system, started="")
    (tmp_path / "old.mcap").rename(tmp_path / "new.mcap")
    write(log, 10)
    log.close()
    assert sequences(tmp_path / "new.mcap") == list(range(10))
    assert Recording(tmp_path / "new.mcap").whole()


@pytest.mark.parametrize("parent", ["file.txt/below", "read-only"])
def test_a_folder_that_takes_no_file_is_refused_by_name(tmp_path, system, parent):
    (tmp_path / "file.txt").touch()
    (tmp_path / "read-only").mkdir(mode=0o500)
    if parent == "read-only" and os.geteuid() == 0:
        pytest.skip("root may write everywhere")
    with pytest.raises(ConfigurationError, match=r"x\.mcap: can not be made: "):
        LogWriter(tmp_path / parent / "x.mcap", system, started="")


def test_a_jump_of_the_wall_clock_changes_no_byte(tmp_path, system, monkeypatch):
    monkeypatch.setattr(time, "time", lambda: 0.0)
    files = [tmp_path / "calm.mcap", tmp_path / "jump.mcap"]
    for file in files:
        log = LogWriter(file, system, started=datetime(2026, 1, 1, tzinfo=UTC).isoformat())
        for number in range(50):
            payload = BaseCommand(v_mps=number).SerializeToString()
            log.write("a/b", "berth.BaseCommand", payload, 7, number, number, number)
        log.close()
        monkeypatch.setattr(time, "time", lambda: -1e9)
    assert files[0].read_bytes() == files[1].read_bytes()


def test_an_hour_of_chunks_takes_no_memory_and_all_of_them_are_indexed(tmp_path, system):
    """MCAP's writer alone would keep 2.4 kB of a chunk of thirty topics."""
    file = tmp_path / "long.mcap"
    log = LogWriter(file, system, started="")

    def chunks(first, count):
        for number in range(first, first + count):
            for topic in range(30):
                log.write(f"a/{topic}", "berth.BaseCommand", b"", 7, number, number, number)
            log.flush()

    chunks(0, 50)
    tracemalloc.start()
    chunks(50, 300)
    grown_bytes = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    log.close()
    assert grown_bytes < 300 * 40
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
        found = make_reader(stream).iter_messages(topics=["a/29"], starting_at=300, ending_before=310)
        assert [message.sequence for _, _, message in found] == list(range(300, 310))
    assert summary.statistics.chunk_count == len(summary.chunk_indexes) == 350
    assert all(len(index.message_index_offsets) == 30 for index in summary.chunk_indexes)


def test_a_kill_leaves_everything_up_to_the_last_flush(tmp_path, system):
    code = (
        "import os, sys; from pathlib import Path; from runtime.log import LogWriter\n"
        "from runtime.launch import System\n"
        "log = LogWriter(Path(sys.argv[1]), System.from_json(sys.stdin.read()), started='')\n"
        "for n in range(300):\n"
        "    log.write('a/b', 'berth.BaseCommand', b'', 7, n, n, n)\n"
        "    if n == 199: log.flush()\n"
        "os.kill(os.getpid(), 9)\n"
    )
    file = tmp_path / "killed.mcap"
    done = subprocess.run([sys.executable, "-c", code, str(file)], input=system.to_json(), text=True, check=False)
    assert done.returncode == -9
    assert sequences(file) == list(range(200))
    assert not Recording(file).whole()
