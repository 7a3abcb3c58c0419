"""`berth view` beside a running system."""

import threading
import time

import pytest

from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from tests.runtime.system import recorded_system, run_until
from viewer.live import follow
from viewer.shown import Number, Page

pytestmark = pytest.mark.xdist_group("live")
DEADLINE_S = 60.0


class Wall:
    """A viewer that remembers, and that can be made to hang."""

    def __init__(self):
        self.standing, self.shown, self.flushed = {}, [], 0
        self.goes_on = threading.Event()
        self.goes_on.set()

    def stands(self, entities):
        self.standing = entities

    def show(self, shown):
        self.goes_on.wait(DEADLINE_S)
        self.shown += shown

    def flush(self):
        self.flushed += 1

    def table(self):
        pages = [
            each.what.text for each in list(self.shown) if each.entity == "processes" and isinstance(each.what, Page)
        ]
        return pages[-1] if pages else ""


@pytest.fixture
def watched(tmp_path):
    """A system under lockstep at full speed, and a viewer that follows it on a thread of its own."""
    system = recorded_system(tmp_path, ["world.frames=0"])
    wall, over, failed = Wall(), threading.Event(), []
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)

        def watch():
            try:
                follow(supervisor.run, wall, 8.0, over.is_set)
            except ConfigurationError as error:
                failed.append(error)

        thread = threading.Thread(target=watch, daemon=True)
        thread.start()
        try:
            yield supervisor, wall, thread
        finally:
            wall.goes_on.set()
            over.set()
            thread.join(DEADLINE_S)
    assert not failed


def test_every_process_of_a_running_system_is_seen_and_the_system_does_not_notice(watched):
    supervisor, wall, _ = watched
    run_until(
        supervisor, lambda: all(f"| {name} | running |" in wall.table() for name in ("world", "echo", "recorder"))
    )
    assert set(wall.standing) == {"plan/table", "plan/edge", "plan/can", "plan/goal"}
    assert wall.flushed > 0
    assert (supervisor.lost, supervisor.deaths) == (0, [])


def test_a_viewer_that_hangs_does_not_hold_the_robot_back(watched):
    supervisor, wall, _ = watched
    run_until(supervisor, lambda: wall.table() != "")
    wall.goes_on.clear()
    before = supervisor.messages
    run_until(supervisor, lambda: supervisor.messages > before + 20_000)  # more than twice what may wait for it
    wall.goes_on.set()
    run_until(supervisor, lambda: dropped(wall) > 0)
    assert (supervisor.lost, supervisor.deaths) == (0, [])


def dropped(wall):
    return max(
        (
            each.what.value
            for each in list(wall.shown)
            if each.entity == "lost/by_this_viewer" and isinstance(each.what, Number)
        ),
        default=0.0,
    )


def test_it_ends_with_the_system(tmp_path):
    system = recorded_system(tmp_path, ["world.frames=0"])
    wall, done = Wall(), threading.Event()
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)

        def watch():
            follow(supervisor.run, wall, 8.0, lambda: False)
            done.set()

        threading.Thread(target=watch, daemon=True).start()
        run_until(supervisor, lambda: wall.table() != "")
        supervisor.stop()
    until_s = time.monotonic() + DEADLINE_S
    while not done.is_set():
        assert time.monotonic() < until_s
        time.sleep(0.01)
