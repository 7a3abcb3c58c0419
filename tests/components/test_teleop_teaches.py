"""A person who drives by keys teaches the learner: keys, teleop, pilot, base and learner around a perfect plant."""

import math

import pytest

from components.base.component import Base
from components.base.ports import Params as BaseParams
from components.learner.component import Learner
from components.learner.ports import Params as LearnerParams
from components.pilot.component import Pilot
from components.pilot.ports import Params as PilotParams
from components.teleop.component import Teleop
from components.teleop.keys import Keys
from components.teleop.ports import Params as TeleopParams
from docking import plant
from docking.cells import Grid
from docking.linear import BEST_TUNED, Linear, teacher_action
from docking.task import Task
from runtime.contract import STOP, TICK, Event
from schemas.drive_pb2 import BaseState
from schemas.teleop_pb2 import Hands
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import HEIGHT_M, PERIOD_NS, percept

TASK = Task(beta_cells=15, alpha_cells=15)
GRID = Grid.of(TASK)
LAW = Linear(*BEST_TUNED, TASK.turn_rate_radps)
ARCS = ("u", "o")
"""Keys of the task's actions."""
REPEAT_NS = 31_250_000


def by_linear_law(beta, alpha, d, state):
    """The key that a person holds who steers by the linear law: back to 1.4 m after each docking."""
    if d < 0.3 or max(abs(beta), abs(alpha)) > 1.0:
        state["back"] = True
    if d > 1.4:
        state["back"] = False
    if state["back"]:
        return "s" if abs(alpha) < 0.1 else ("j" if alpha > 0 else "l")
    return ARCS[teacher_action(LAW, GRID, GRID.cell(beta, alpha), TASK.actions)]


def straight_on(beta, alpha, d, state):
    """As above, but ahead, which is none of the task's actions."""
    key = by_linear_law(beta, alpha, d, state)
    return "i" if key in ARCS else key


class Session:
    """Robot and person, frame by frame; the order of messages is that of the bus."""

    def __init__(self, person, clock):
        self._person, self._state, self._clock = person, {"back": False}, clock
        self._keys, self._teleop = Keys(), Teleop(TeleopParams(task=TASK), 0)
        self._base = Base(BaseParams(clock=clock, commanders=("pilot",), begins_with=("teleop",)), 0)
        self._pilot = Pilot(PilotParams(task=TASK, controller="lc", train_s=1e9), 1)
        self._learner = Learner(LearnerParams(task=TASK), 0)
        self._pose, self._motion, self._now_ns = plant.pose(0.5, 0.3, 1.5), (0.0, 0.0), 0
        self.commanders, self.trials, self.policy = [], [], None

    def run(self, seconds):
        for k in range(round(seconds * 8)):
            self._frame(k * PERIOD_NS)
        for said in self._learner.handle(Event(self._now_ns, STOP, None, self._now_ns)):
            assert said.port == "snapshot"
        return self

    def _frame(self, time_ns):
        self._now_ns = time_ns
        beta, alpha, d = plant.observe(*self._pose)
        look = percept(beta, alpha, math.atan2(HEIGHT_M, d))
        for said in self._pilot.handle(Event(time_ns, "percept", look, time_ns)):
            self._learn("trial", said.message) if said.port == "trial" else None
            self._tell_base("pilot", said.message, time_ns) if said.port == "drive" else None
            self.trials += [said.message] if said.port == "trial" else []
        self._learn("percept", look)
        state = BaseState(v_mps=self._motion[0], omega_radps=self._motion[1])
        self._pilot.handle(Event(time_ns, "base", state, time_ns))
        self._hear_hands(self._teleop.handle(Event(time_ns, "base", state, time_ns)))
        self._press(self._person(beta, alpha, d, self._state))

    def _press(self, key):
        """Keys between two frames, as a keyboard repeats them, and the robot's motion meanwhile."""
        for step in range(PERIOD_NS // REPEAT_NS):
            at_ns = self._now_ns + step * REPEAT_NS
            for hand in self._keys.feed(key.encode()):
                event = Event(at_ns, "device", Hands(**hand._asdict()), at_ns)
                self._hear_hands(self._teleop.handle(event), at_ns)
            self._hear_hands(self._teleop.handle(Event(at_ns, TICK, None, at_ns)), at_ns)
            self._pose = plant.advance(*self._pose, *self._motion, REPEAT_NS * 1e-9)

    def _hear_hands(self, outputs, at_ns=None):
        for said in outputs:
            self._tell_base("teleop", said.message, said.capture_ns, at_ns)

    def _tell_base(self, port, message, capture_ns, at_ns=None):
        time_ns = self._now_ns if at_ns is None else at_ns
        for said in self._base.handle(Event(time_ns, port, message, capture_ns)):
            if said.port != "applied":
                continue
            self._motion = (said.message.v_mps, said.message.omega_radps)
            self.commanders.append(said.message.commander)
            self._learn("applied", said.message, said.capture_ns)
            self._pilot.handle(Event(time_ns, "applied", said.message, said.capture_ns))

    def _learn(self, port, message, capture_ns=None):
        stamp = self._now_ns if capture_ns is None else capture_ns
        for said in self._learner.handle(Event(self._now_ns, port, message, stamp)):
            self.policy = said.message if said.port == "policy" else self.policy


@pytest.mark.parametrize("clock", ["lockstep", "real"])
def test_a_person_who_steers_by_keys_teaches_the_learner(clock):
    session = Session(by_linear_law, clock).run(120)
    assert set(session.commanders) <= {"teleop", "none"}, "the pilot never has the robot"
    assert 3 <= session.trials[-1].number <= 10, "each new way ahead begins a trial"
    assert Trial.REACHED in {trial.outcome for trial in session.trials}
    assert session.policy.transitions >= 2 * session.trials[-1].ended, "an approach crosses a few cells"
    known = [action for action in session.policy.action if action != 255]
    assert len(known) >= 20, "and the mirror of each"


def test_what_is_none_of_the_tasks_actions_teaches_nothing():
    session = Session(straight_on, "lockstep").run(60)
    assert "teleop" in session.commanders
    assert session.policy is None
