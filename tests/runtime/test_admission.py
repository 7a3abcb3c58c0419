"""Who may say and hear what follows from the launch file's graph."""

from collections.abc import Callable
from pathlib import Path

import pytest

from runtime.admission import access_control, check_topology, rights
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.system import System

LAUNCH = Path(__file__).parent.parent.parent / "launch"


def half(host: str, launch: str = "teleop.toml", **options):
    return load(LAUNCH / launch, host=host, recording=Path("x.mcap"), **options)


def granted(system, neighbour: str, flow: str, message: str) -> set[str]:
    found = [set(right.keys) for right in rights(system, neighbour) if right.flow == flow and message in right.messages]
    return {key.removeprefix(system.realm + "/") for keys in found for key in keys}


@pytest.fixture
def with_desk(tmp_path) -> Callable[[str], System]:
    """teleop.toml with its recorder on a machine of its own; the laptop has the keys and the learner."""
    head, mark, tail = (LAUNCH / "teleop.toml").read_text(encoding="utf-8").rpartition('host = "laptop"')
    file = tmp_path / "desk.toml"
    file.write_text(f'{head}host = "desk"{tail}', encoding="utf-8")
    assert mark
    return lambda host: load(file, host=host, recording=Path("x.mcap"))


def test_the_laptop_may_put_what_its_components_publish_and_nothing_else():
    own = {"teleop/drive", "teleop/device", "learner/policy", "learner/snapshot", "recorder/ack", "recorder/gap"}
    said = granted(half("robot"), "laptop", "ingress", "put")
    assert own <= said
    assert {key.split("/")[0] for key in said} == {"teleop", "learner", "recorder"}
    assert not any("*" in key for key in said)


def test_only_the_host_of_a_component_may_put_its_keys():
    """Whoever publishes, in each launch file of several hosts."""
    for launch in ("sim2.toml", "teleop.toml"):
        robot, laptop = half("robot", launch), half("laptop", launch)
        from_laptop, from_robot = granted(robot, "laptop", "ingress", "put"), granted(laptop, "robot", "ingress", "put")
        assert not from_laptop & from_robot
        assert {"base/applied", "pilot/drive", "base/state"} <= from_robot
        for spec in robot.components:
            theirs = from_robot if spec.host == "robot" else from_laptop
            assert set(spec.outputs.values()) | {f"{spec.name}/status", f"{spec.name}/journal"} <= theirs


def test_what_one_end_lets_out_the_other_lets_in():
    robot, laptop = half("robot"), half("laptop")
    for message in ("put", "declare_subscriber", "liveliness_token"):
        assert granted(robot, "laptop", "egress", message) <= granted(laptop, "robot", "ingress", message)
        assert granted(laptop, "robot", "egress", message) <= granted(robot, "laptop", "ingress", message)


def test_nobody_may_delete_or_ask():
    granted_at_all = {message for right in rights(half("robot"), "laptop") for message in right.messages}
    assert not granted_at_all & {"delete", "query", "reply", "declare_queryable"}


def test_a_host_that_records_hears_everything_and_says_only_its_recorder_s_own(with_desk):
    robot = with_desk("robot")
    assert "**" in granted(robot, "desk", "ingress", "declare_subscriber")
    assert {key.split("/")[0] for key in granted(robot, "desk", "ingress", "put")} == {"recorder"}
    assert granted(robot, "desk", "egress", "put") >= {"camera/image", "learner/policy", "base/applied"}


def test_a_host_without_a_recorder_hears_only_what_it_reads(with_desk):
    robot = with_desk("robot")
    heard = granted(robot, "laptop", "ingress", "declare_subscriber")
    assert "**" not in heard
    assert {"tracker/percept", "base/applied", "base/state", "pilot/trial"} <= heard
    assert "camera/image" not in heard | granted(robot, "laptop", "egress", "put")


def test_through_the_robot_come_the_words_of_the_third_host(with_desk):
    desk = with_desk("desk")
    assert {"learner/policy", "base/applied"} <= granted(desk, "robot", "ingress", "put")
    assert granted(desk, "laptop", "ingress", "put").isdisjoint({"base/applied"})
    assert "@ready/*/learner/*" in granted(desk, "robot", "ingress", "liveliness_token")


def test_with_three_hosts_all_links_meet_at_the_robot(with_desk):
    robot, desk = with_desk("robot"), with_desk("desk")
    check_topology(robot, listens=True, connects=False)
    check_topology(desk, listens=False, connects=True)
    for system, listens in ((robot, False), (desk, True)):
        with pytest.raises(ConfigurationError, match=r"with three hosts, --host \w+ must stand with --"):
            check_topology(system, listens=listens, connects=not listens)
    check_topology(half("robot"), listens=False, connects=True)


def test_in_real_time_nobody_else_may_hold_time():
    assert "supervisor/hold" not in granted(half("robot"), "laptop", "ingress", "put")
    assert "supervisor/hold" in granted(half("robot", "sim2.toml", clock="lockstep"), "laptop", "ingress", "put")


def test_a_host_may_announce_its_own_components_only():
    tokens = granted(half("robot"), "laptop", "ingress", "liveliness_token")
    assert "@ready/*/learner/*" in tokens
    assert not {f"@ready/*/{name}/*" for name in ("base", "pilot", "simulator", "tracker")} & tokens
    assert {"@half/laptop/*/*", "@over/laptop/*/*"} <= tokens


def test_the_default_is_to_deny_and_a_neighbour_is_known_by_its_certificate():
    table = access_control(half("robot"))
    assert (table["enabled"], table["default_permission"]) == (True, "deny")
    here, laptop = table["subjects"]
    assert here == {"id": "here", "link_protocols": ["tcp"]}
    assert laptop == {"id": "laptop", "cert_common_names": ["laptop"], "link_protocols": ["tls"]}
    assert all(rule["permission"] == "allow" and rule["key_exprs"] for rule in table["rules"])
    names = [rule["id"] for rule in table["rules"]]
    assert len(names) == len(set(names))
    assert {name for policy in table["policies"] for name in policy["rules"]} == set(names)
