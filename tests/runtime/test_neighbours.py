"""Who of the other hosts is there, and what that means for this one."""

import dataclasses
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.launch import load
from runtime.neighbours import HERE, OVER, Half, Neighbours, digest_of, parse_half

SIM2 = Path(__file__).parent.parent.parent / "launch" / "sim2.toml"


def half_of(host: str, *overrides: str, recording: str = "x.mcap", **options):
    return load(SIM2, overrides, host=host, recording=Path(recording) if recording else None, **options)


ROBOT, LAPTOP = half_of("robot"), half_of("laptop")
DIGEST = digest_of(ROBOT)


@given(st.sampled_from(["berth/sim", "a"]), st.integers(1, 2**64 - 1), st.sampled_from([HERE, OVER]))
def test_a_token_s_key_tells_which_half_it_is(realm, run, state):
    half = Half("robot", DIGEST, run)
    assert parse_half(half.key(realm, state)) == half


@pytest.mark.parametrize("key", ["", "a/@half/robot", "a/@half/robot/xyz/1", "a/@ready/1/robot/0000000000000001"])
def test_a_stranger_s_key_is_refused(key):
    with pytest.raises(ValueError, match="not a half's token"):
        parse_half(key)


def test_both_hosts_of_a_system_have_one_digest_whatever_file_they_record_to():
    assert digest_of(LAPTOP) == DIGEST
    assert digest_of(half_of("laptop", recording="other.mcap")) == DIGEST


@pytest.mark.parametrize(
    "other",
    [
        half_of("laptop", "pilot.train_s=1"),
        half_of("laptop", "task.beta_cells=15"),
        half_of("laptop", seed=2),
        half_of("laptop", clock="lockstep"),
        half_of("laptop", recording=""),
        half_of("laptop", only=("learner", "pilot")),
    ],
)
def test_another_system_has_another_digest(other):
    assert digest_of(other) != DIGEST


def test_a_host_that_comes_goes_and_comes_back_is_noted_and_ends_nothing():
    robot, laptop = Neighbours(ROBOT, 1), Half("laptop", DIGEST, 2)
    assert robot.appear(robot.own, begun=False) == ("", False)
    assert robot.appear(laptop, begun=False) == ("laptop is there", False)
    assert robot.away == {}
    assert robot.vanish(laptop) == ("laptop is away; robot goes on without it", False)
    assert list(robot.away) == ["laptop"]
    assert robot.appear(laptop, begun=True) == ("laptop is back", False)
    assert robot.away == {}


def test_the_robot_goes_on_when_the_laptop_ends_or_starts_again():
    robot = Neighbours(ROBOT, 1)
    robot.appear(Half("laptop", DIGEST, 2), begun=False)
    assert not robot.end(Half("laptop", DIGEST, 2)).fatal
    robot.vanish(Half("laptop", DIGEST, 2))
    assert robot.appear(Half("laptop", DIGEST, 3), begun=True) == ("laptop was started again and is there", False)
    assert robot.away == {}
    assert robot.vanish(Half("laptop", DIGEST, 2)).words == "", "the token of the run before, late"


def test_the_laptop_ends_with_the_robot_and_does_not_learn_from_another_session():
    laptop = Neighbours(LAPTOP, 1)
    laptop.appear(Half("robot", DIGEST, 2), begun=False)
    assert laptop.end(Half("robot", DIGEST, 2)) == ("robot has ended", True)
    assert not laptop.end(Half("robot", DIGEST, 9)).fatal
    laptop.vanish(Half("robot", DIGEST, 2))
    assert laptop.appear(Half("robot", DIGEST, 3), begun=True).fatal


def test_a_robot_that_is_started_again_before_its_end_was_noticed_has_begun_another_session():
    laptop = Neighbours(LAPTOP, 1)
    laptop.appear(Half("robot", DIGEST, 2), begun=False)
    assert not laptop.appear(Half("robot", DIGEST, 3), begun=True).fatal
    assert laptop.vanish(Half("robot", DIGEST, 2)) == ("robot has begun another session; start this host again", True)


def test_a_second_robot_by_mistake_ends_nobody_s_session():
    laptop = Neighbours(LAPTOP, 1)
    laptop.appear(Half("robot", DIGEST, 2), begun=False)
    said = laptop.appear(Half("robot", DIGEST, 3), begun=True)
    assert said == ("a second machine runs robot; laptop stays with the first", False)
    assert laptop.vanish(Half("robot", DIGEST, 9)) == ("", False), "of an earlier session, late"
    assert laptop.vanish(Half("robot", DIGEST, 3)) == ("", False)
    assert laptop.vanish(Half("robot", DIGEST, 2)).words == "robot is away; laptop goes on without it"


def test_only_who_has_not_begun_gives_way_to_a_host_that_runs_another_system():
    stranger = Half("laptop", "0" * 16, 2)
    assert Neighbours(ROBOT, 1).appear(stranger, begun=False).fatal
    verdict = Neighbours(ROBOT, 1).appear(stranger, begun=True)
    assert not verdict.fatal
    assert "host laptop must run the same system" in verdict.words


def test_only_who_has_not_begun_gives_way_to_its_twin():
    twin = Half("robot", DIGEST, 2)
    assert Neighbours(ROBOT, 1).appear(twin, begun=False).fatal
    assert not Neighbours(ROBOT, 1).appear(twin, begun=True).fatal


def test_the_stranger_s_coming_and_going_leaves_nobody_away():
    robot = Neighbours(dataclasses.replace(ROBOT), 1)
    robot.appear(Half("moon", DIGEST, 2), begun=True)
    robot.vanish(Half("moon", DIGEST, 2))
    assert robot.away == {}
