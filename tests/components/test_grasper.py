"""The grasper: the pick-up stage by stage, one answer for each trial message."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.grasper.component import Grasper
from components.grasper.core import Action, Gripper, Stage, sees_object
from components.grasper.ports import Params
from runtime.contract import STOP, Event
from schemas.drive_pb2 import BaseState, GripperAction
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial

PERIOD_NS = 125_000_000
UP = BaseState(lift_up=True)
SEEN = BaseState(inner_beam=True, outer_beam=True)
SHUT = BaseState(inner_beam=True, outer_beam=True, fingers_closed=True)
HELD = BaseState(inner_beam=True, outer_beam=True, fingers_closed=True, lift_up=True)
SLIPPED = BaseState(fingers_closed=True, lift_up=True)
DOWN = BaseState(lift_down=True)


def step(grasper, k, state, mode=Trial.GRASP):
    """Frame k; returns (drive, grasp)."""
    time_ns = k * PERIOD_NS
    grasper.handle(Event(time_ns, "base", state, time_ns))
    command, grasp = grasper.handle(Event(time_ns, "trial", Trial(mode=mode), time_ns))
    assert (command.port, grasp.port) == ("drive", "grasp")
    return command.message, grasp.message


def stages(states, grasper=None, first=0):
    """Stage of each frame, and the last grasp."""
    grasper = grasper or Grasper(Params(), 0)
    said = [step(grasper, first + k, state)[1] for k, state in enumerate(states)]
    return [Stage(g.stage).name for g in said], said[-1]


def test_the_numbers_of_stages_and_actions_are_those_of_the_schema():
    assert {stage.name: int(stage) for stage in Stage} == dict(Grasp.Stage.items())
    assert {f"GRIPPER_{action.name}": int(action) for action in Action} == dict(GripperAction.items())


def test_lower_until_the_beams_see_it_close_lift_done():
    names, last = stages([UP, UP, SEEN, SEEN, SHUT, SHUT, HELD, HELD])
    assert names == ["LOWERING", "LOWERING", "CLOSING", "CLOSING", "LIFTING", "LIFTING", "DONE", "DONE"]
    assert last.picked


def test_what_is_not_between_the_fingers_is_released_and_missed():
    names, last = stages([UP, DOWN, DOWN, UP, UP])
    assert names == ["LOWERING", "RELEASING", "RELEASING", "DONE", "DONE"]
    assert not last.picked


def test_what_slips_while_lifting_is_missed():
    names, last = stages([UP, SEEN, SHUT, SLIPPED])
    assert names[-1] == "DONE"
    assert not last.picked


def test_a_switch_read_before_its_stage_began_does_not_count():
    grasper = Grasper(Params(), 0)
    grasper.handle(Event(0, "base", HELD, 0))
    for k in range(20):
        said = grasper.handle(Event(k * PERIOD_NS, "trial", Trial(mode=Trial.GRASP), k * PERIOD_NS))
        assert said[1].message.stage == Grasp.LOWERING


def test_each_stage_gives_up_after_its_time():
    params = Params(lower_s=2.0, close_s=1.0, lift_s=1.0, release_s=3.0)
    nothing = BaseState()
    names, last = stages([nothing] * 60, Grasper(params, 0))
    assert names.count("LOWERING") == 2 * 8 + 1
    assert names.count("RELEASING") == 3 * 8 + 1
    assert (names[-1], last.picked) == ("DONE", False)
    stuck = BaseState(inner_beam=True, outer_beam=True)
    names, last = stages([stuck] * 60, Grasper(params, 0))
    assert names.count("CLOSING") == names.count("LIFTING") == 8 + 1
    assert (names[-1], last.picked) == ("DONE", False)


def test_the_gripper_is_told_the_stage_and_the_robot_stands_still():
    grasper = Grasper(Params(), 0)
    told = []
    for k, state in enumerate([UP, UP, SEEN, SHUT, HELD]):
        command, _ = step(grasper, k, state)
        assert command.engaged
        assert (command.v_mps, command.omega_radps) == (0.0, 0.0)
        told.append(GripperAction.Name(command.gripper))
    assert told == ["GRIPPER_LOWER", "GRIPPER_LOWER", "GRIPPER_CLOSE", "GRIPPER_LIFT", "GRIPPER_KEEP"]


def test_leaving_the_grasp_releases_once_and_then_leaves_the_robot_alone():
    grasper = Grasper(Params(), 0)
    stages([UP, SEEN, SHUT, HELD], grasper)
    said = [step(grasper, k, HELD, Trial.PLACE if k == 4 else Trial.WAIT) for k in range(4, 7)]
    assert [(GripperAction.Name(d.gripper), d.engaged) for d, _ in said] == [
        ("GRIPPER_RELEASE", True), ("GRIPPER_KEEP", False), ("GRIPPER_KEEP", False),
    ]  # fmt: skip
    assert [g.stage for _, g in said] == [Grasp.RELEASING, Grasp.IDLE, Grasp.IDLE]
    assert not any(g.picked for _, g in said)
    assert stages([UP], grasper, 7)[0] == ["LOWERING"]


@pytest.mark.parametrize(
    ("beams", "inner", "outer"), [("both", True, True), ("inner", True, False), ("outer", False, True)]
)
def test_which_beams_must_be_broken(beams, inner, outer):
    for i in (False, True):
        for o in (False, True):
            gripper = Gripper(0, i, o)
            assert sees_object(gripper, beams) == ((i or not inner) and (o or not outer))
            assert sees_object(gripper, "any") == (i or o)


STATES = st.builds(BaseState, **{name: st.booleans() for name in
                                 ("inner_beam", "outer_beam", "lift_up", "lift_down", "fingers_closed")})  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.integers(-2, 30), STATES, st.sampled_from([0, 1, 4, 5, 3, 3, 3])), max_size=60))
def test_every_new_frame_is_answered_once_and_the_robot_never_moves(steps):
    grasper, now, newest = Grasper(Params(), 0), 0, -1
    for frames, state, mode in steps:
        now = max(0, now + frames * PERIOD_NS)
        assert grasper.handle(Event(10**15, "base", state, now)) == ()
        said = grasper.handle(Event(10**15, "trial", Trial(mode=mode), now))
        assert len(said) == (2 if now > newest else 0)
        newest = max(newest, now)
        if said:
            command, grasp = said[0].message, said[1].message
            assert (command.v_mps, command.omega_radps) == (0.0, 0.0)
            assert command.engaged == (grasp.stage != Grasp.IDLE)
            assert grasp.stage == Grasp.DONE or not grasp.picked
            if mode != Trial.GRASP:
                assert grasp.stage in (Grasp.IDLE, Grasp.RELEASING)


def test_the_stop_is_taken_in_silence():
    assert Grasper(Params(), 0).handle(Event(0, STOP)) == ()
