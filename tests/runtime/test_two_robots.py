"""Two robots on one network: each in its own realm, or one in the wrong one by mistake."""

from contextlib import ExitStack
from pathlib import Path

import pytest

from runtime.bus import free_endpoint, open_router
from runtime.launch import load
from runtime.link import Link
from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from tests.runtime.system import heard, run_to_end, small_system
from tests.runtime.test_two_halves import Pair, follow, handled, on, pair

pytestmark = pytest.mark.xdist_group("live")


def test_two_realms_on_one_router_hear_nothing_of_one_another(tmp_path):
    systems, between = [], free_endpoint()
    for name in "ab":
        (tmp_path / name).mkdir()
        systems.append(small_system(tmp_path / name, ["world.frames=60"]))
    with ExitStack() as stack:
        stack.callback(open_router(between).close)
        robots = [stack.enter_context(Supervisor(system, link=Link("", between))) for system in systems]
        for robot in robots:
            run_to_end(robot)
    for system, robot in zip(systems, robots, strict=True):
        rows = heard(system)
        runs = {(row.key, row.run) for row in rows}
        assert len(runs) == len({key for key, _ in runs}), "one run on each key"
        assert [row.sequence for row in rows if row.key == "world/image"] == list(range(60))
        assert (robot.lost, robot.refused, robot.end_reason) == (0, 0, "all frames shown")
    first, second = ({row.run for row in heard(system)} for system in systems)
    assert not first & second


def test_a_laptop_with_the_wrong_realm_waits_in_vain_and_disturbs_nobody(tmp_path, monkeypatch):
    both = pair(tmp_path)
    text = (tmp_path / "two.toml").read_text(encoding="utf-8")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text.replace('realm = "test/', 'realm = "test/other-'), encoding="utf-8")
    stray = load(wrong, host="laptop", recording=tmp_path / "stray.jsonl")
    with on("robot", both, tmp_path, monkeypatch) as robot, on("laptop", both, tmp_path, monkeypatch) as laptop:
        follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        with on("laptop", Pair(both.robot, stray, both.endpoint), tmp_path, monkeypatch) as lost:
            before = handled(robot, "echo")
            follow(lambda: handled(robot, "echo") > before + 16, robot, laptop, lost)
            assert {"world", "echo"} <= set(lost.missing)
            assert (handled(lost, "student"), robot.refused, laptop.refused, robot.note) == (0, 0, 0, "")


def test_a_second_robot_with_the_realm_of_the_first_is_refused_and_the_first_goes_on(tmp_path, monkeypatch):
    both = pair(tmp_path)
    with on("robot", both, tmp_path, monkeypatch) as robot, on("laptop", both, tmp_path, monkeypatch) as laptop:
        follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        with (
            on("robot", both, tmp_path, monkeypatch, link=Link("", both.endpoint)) as twin,
            pytest.raises(ConfigurationError, match="host robot must run once; another machine runs it, too"),
        ):
            follow(lambda: twin.end_reason, robot, laptop, twin)
        before = handled(robot, "echo")
        follow(lambda: handled(robot, "echo") > before + 8, robot, laptop)
        assert robot.end_reason == laptop.end_reason == ""
    words = (Path(laptop.run.directory) / "supervisor.log").read_text(encoding="utf-8")
    assert "a second machine runs robot; laptop stays with the first" in words
