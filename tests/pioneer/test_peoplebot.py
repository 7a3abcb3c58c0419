"""`launch/peoplebot.toml` from its first packet to the pick-up, against the emulated robot, in real time."""

import time

import numpy as np
import pytest

from docking.angles import DEG
from runtime.launch import load
from runtime.supervise import Supervisor
from tests.pioneer.session import DEADLINE_S, peoplebot, peoplebot_file

pytestmark = pytest.mark.xdist_group("session")
SETTINGS = ["pilot.train_s=0", "pilot.evaluation_trials=3", "pilot.evaluation_controller=lc"]
SLOW_S = 0.3
"""A VC-C4 may take so long to answer."""


def picked_up(folder, robot, watch):
    """Run the session until the robot holds the object; the supervisor."""
    system = load(peoplebot_file(folder, robot.end.port), SETTINGS, recording=folder / "session.mcap")
    deadline_s = time.monotonic() + DEADLINE_S
    held, trials = False, set()
    supervisor = Supervisor(system)
    supervisor.watch("pilot/trial", lambda trial, _: trials.add((trial.number, trial.mode, trial.outcome)))
    for key, call in watch.items():
        supervisor.watch(key, call)
    with supervisor:
        while supervisor.poll(0.1) and not held:
            assert time.monotonic() < deadline_s, trials
            with robot.turn:
                held = robot.body.gripper.holding
    assert held, (supervisor.end_reason, trials)
    return supervisor


def errors_rad(percepts, shown, origin_ns):
    """By how much bearing and depression of each percept err about the moment of its picture, `[N, 2]`."""
    times = np.array([moment.monotonic_ns - origin_ns for moment in shown])
    seen = [p for p in percepts if p.visible and times[0] < p.capture_time_ns < times[-1]]
    exposed = np.array([p.capture_time_ns for p in seen])
    truth = np.array([moment[1:] for moment in shown])
    told = np.array([(p.pan_rad, p.tilt_rad) for p in seen])
    return told - np.stack([np.interp(exposed, times, column) for column in truth.T], axis=-1)


def test_the_peoplebot_docks_and_picks_up_with_a_camera_that_answers_after_300_ms_and_percepts_stay_right(tmp_path):
    percepts = []
    watch = {"tracker/percept": lambda percept, _: percepts.append(percept)}
    with peoplebot(tmp_path, answer_s=SLOW_S) as robot:
        supervisor = picked_up(tmp_path, robot, watch)
        assert robot.body.gripper.holding
        assert not robot.body.collided
        assert robot.v_mps == 0.0
        errors = np.abs(errors_rad(percepts, robot.showing.shown, supervisor._origin_ns))
    assert len(errors) > 30
    assert np.mean(errors[:, 0] < 1.0 * DEG) > 0.9
    assert np.mean(errors[:, 1] < 1.2 * DEG) > 0.9, "from near a can seems 0.6 deg away from its middle"
