"""The simulated world behind the emulated robot: wheels, gripper and switches as a Pioneer has them."""

from __future__ import annotations

from components.simulator.gripper import Gripper
from tests.driven import Driven

OPEN, CLOSE, FINGERS_STOP, UP, DOWN, LIFT_STOP, STORE, DEPLOY = range(1, 9)
"""Arguments of GRIPPER."""


class TwoMotors(Gripper):
    """The simulator's gripper with a lift and fingers that are told one by one."""

    def __init__(self, params):
        super().__init__(params)
        self.lift_code, self.fingers_code = LIFT_STOP, FINGERS_STOP
        self.lift_moves = self.fingers_move = False

    def tell(self, code):
        if code in {OPEN, CLOSE, FINGERS_STOP}:
            self.fingers_code = code
        elif code in {UP, DOWN, LIFT_STOP}:
            self.lift_code = code
        elif code in {STORE, DEPLOY}:
            self.fingers_code, self.lift_code = (CLOSE, UP) if code == STORE else (OPEN, DOWN)

    def step(self, ahead_m, left_m, dt_s):
        before = self.lift, self.fingers
        if self.lift_code != LIFT_STOP:
            self._move_lift(self.lift_code == UP, dt_s)
        if self.fingers_code == OPEN:
            self._open(dt_s)
        elif self.fingers_code == CLOSE:
            self._close(ahead_m, left_m, dt_s)
        self.lift_moves, self.fingers_move = self.lift != before[0], self.fingers != before[1]


class Body(Driven):
    """A driven world with a gripper that is told as a Pioneer's is."""

    def __init__(self, params, start, time_ns):
        super().__init__(params, start, time_ns)
        self.gripper = TwoMotors(params)
        if params.begins == "fingertips":
            self.gripper.begin_lowered()

    def place(self, start):
        super().place(start)
        self.gripper = TwoMotors(self._params)

    @property
    def gripper_byte(self):
        """The standard packet's: open, closed, moves, -, up, down, lift moves, -."""
        gripper = self.gripper
        bits = (gripper.fingers >= 1.0, gripper.fingers <= 0.0 or gripper.gripping, gripper.fingers_move, False,
                gripper.up, gripper.down, gripper.lift_moves, False)  # fmt: skip
        return sum(bool(on) << bit for bit, on in enumerate(bits))

    @property
    def switches(self):
        """GRIPPERpac's state: low where a switch holds or a beam is broken, high where a motor moves."""
        gripper = self.gripper
        inner, outer = gripper.beams(*self.object_from_gripper)
        low = (gripper.fingers >= 1.0, gripper.up or gripper.down, outer, inner, gripper.gripping, gripper.gripping)
        bits = sum((not active) << bit for bit, active in enumerate(low))
        return bits | gripper.lift_moves << 6 | gripper.fingers_move << 7
