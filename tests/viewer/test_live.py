"""`berth view` beside a running system."""

import threading

import pytest

from runtime.supervise import Supervisor
from tests.runtime.system import recorded_system, run_until
from viewer.live import follow
from viewer.shown import Page

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


@pytest.fixture(scope="module")
def watched(tmp_path_factory):
    """A system in lockstep at full speed, and a viewer that follows it on a thread of its own until the system ends."""
    system = recorded_system(tmp_path_factory.mktemp("watched"), ["world.frames=0"])
    wall, ended = Wall(), threading.Event()
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)

        def watch():
            follow(supervisor.run, wall, 8.0, lambda: False)
            ended.set()

        threading.Thread(target=watch, daemon=True).start()
        try:
            yield supervisor, wall
        finally:
            wall.goes_on.set()
    assert ended.wait(DEADLINE_S), "it ends with the system"


def test_every_process_of_a_running_system_is_seen_and_the_system_does_not_notice(watched):
    supervisor, wall = watched
    run_until(
        supervisor, lambda: all(f"| {name} | running |" in wall.table() for name in ("world", "echo", "recorder"))
    )
    assert set(wall.standing) == {"plan/table", "plan/edge", "plan/can", "plan/goal"}
    assert wall.flushed > 0
    assert (supervisor.lost, supervisor.deaths) == (0, [])


def test_a_viewer_that_hangs_does_not_hold_the_robot_back(watched):
    supervisor, wall = watched
    run_until(supervisor, lambda: wall.table() != "")
    wall.goes_on.clear()
    before = supervisor.messages
    run_until(supervisor, lambda: supervisor.messages > before + 10_000)
    wall.goes_on.set()
    seen = len(wall.shown)
    run_until(supervisor, lambda: len(wall.shown) > seen)  # it goes on where it hung
    assert (supervisor.lost, supervisor.deaths) == (0, [])
