"""The simulated gripper: times, beams, and what it can hold."""

import pytest

from components.simulator.gripper import Action, Gripper
from components.simulator.params import Params

STEP_S = 1 / 64


def run(gripper, action, seconds, ahead_m=0.0, left_m=0.0):
    gripper.command(action)
    for _ in range(round(seconds * 64)):
        gripper.step(ahead_m, left_m, STEP_S)
    return gripper


def picked(ahead_m, left_m):
    gripper = Gripper(Params())
    for action in (Action.LOWER, Action.CLOSE, Action.LIFT):
        run(gripper, action, 2.0, ahead_m, left_m)
    return gripper


def test_it_begins_raised_and_open():
    gripper = run(Gripper(Params()), Action.KEEP, 1.0)
    assert (gripper.up, gripper.down, gripper.closed, gripper.holding) == (True, False, False, False)


@pytest.mark.parametrize(("action", "seconds", "done"), [("LOWER", 1.5, "down"), ("CLOSE", 1.0, "closed")])
def test_an_action_takes_its_time(action, seconds, done):
    gripper = Gripper(Params())
    run(gripper, Action[action], seconds - 2 * STEP_S, ahead_m=1.0)
    assert not getattr(gripper, done)
    run(gripper, Action.KEEP, 4 * STEP_S, ahead_m=1.0)
    assert getattr(gripper, done)


def test_an_object_between_the_fingers_is_held_and_lifted():
    gripper = picked(0.01, -0.01)
    assert gripper.holding
    assert gripper.up
    assert gripper.fingers == pytest.approx(0.066 / 0.12)


@pytest.mark.parametrize(("ahead_m", "left_m"), [(0.05, 0.0), (-0.05, 0.0), (0.0, 0.04), (0.0, -0.04), (1.5, 0.0)])
def test_an_object_that_is_not_between_the_fingers_stays(ahead_m, left_m):
    gripper = picked(ahead_m, left_m)
    assert not gripper.holding
    assert gripper.closed
    assert gripper.fingers == 0.0


def test_closing_with_the_lift_up_holds_nothing():
    gripper = run(run(Gripper(Params()), Action.CLOSE, 2.0), Action.LIFT, 2.0)
    assert not gripper.holding


def test_gripped_but_not_lifted_is_not_holding():
    gripper = run(run(Gripper(Params()), Action.LOWER, 2.0), Action.CLOSE, 2.0)
    assert gripper.gripping
    assert not gripper.holding


@pytest.mark.parametrize("action", [Action.RELEASE, Action.LOWER])
def test_opening_puts_the_object_back(action):
    gripper = run(picked(0.0, 0.0), action, 2.0)
    assert not gripper.holding
    assert gripper.fingers == 1.0


def test_release_ends_raised():
    assert run(picked(0.0, 0.0), Action.RELEASE, 2.0).up


@pytest.mark.parametrize(
    ("ahead_m", "left_m", "inner_outer"),
    [
        (0.0, 0.0, (True, True)),
        (0.022, 0.0, (True, True)),
        (0.04, 0.0, (False, True)),
        (-0.04, 0.0, (True, False)),
        (0.1, 0.0, (False, False)),
        (0.0, 0.1, (False, False)),
    ],
)
def test_beams_see_the_object_at_their_own_depth(ahead_m, left_m, inner_outer):
    gripper = run(Gripper(Params()), Action.LOWER, 2.0, ahead_m, left_m)
    assert gripper.beams(ahead_m, left_m) == inner_outer


def test_beams_see_nothing_while_the_lift_is_up():
    assert Gripper(Params()).beams(0.0, 0.0) == (False, False)


def test_beams_stay_broken_while_the_object_is_held():
    assert picked(0.0, 0.0).beams(0.0, 0.0) == (True, True)


def test_unknown_actions_change_nothing():
    gripper = run(run(Gripper(Params()), Action.LOWER, 0.5), 77, 2.0)
    assert gripper.down
