"""Messages to and from the pick-up: one drive and one grasp for each trial message."""

from __future__ import annotations

from typing import cast

from components.grasper import ports
from components.grasper.core import ACTIONS, Gripper, PickUp, Stage, step
from runtime.contract import Event, Output
from schemas.drive_pb2 import BaseState, Drive, GripperAction
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial


class Grasper:
    """Picks the object up while the trial is in its grasp; the robot stands still meanwhile.

    A trial message whose capture time was answered before is ignored.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._pick_up = PickUp()
        self._gripper = Gripper()
        self._answered_ns = -1

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Remember the gripper's switches; answer a trial message."""
        if event.port == "base" and event.capture_ns >= self._gripper.capture_ns:
            self._gripper = _gripper(event.message, event.capture_ns)
        if event.port != "trial" or event.capture_ns <= self._answered_ns:
            return ()
        self._answered_ns = event.capture_ns
        wanted = event.message.mode == Trial.GRASP
        self._pick_up = step(self._params, self._pick_up, self._gripper, wanted, event.capture_ns)
        return (Output("drive", _drive(self._pick_up)), Output("grasp", _grasp(self._pick_up)))


def _gripper(state: BaseState, capture_ns: int) -> Gripper:
    return Gripper(capture_ns, state.inner_beam, state.outer_beam, state.lift_up, state.lift_down, state.fingers_closed)


def _drive(now: PickUp) -> Drive:
    return Drive(engaged=now.stage != Stage.IDLE, gripper=cast("GripperAction", int(ACTIONS[now.stage])))


def _grasp(now: PickUp) -> Grasp:
    return Grasp(stage=cast("Grasp.Stage", int(now.stage)), picked=now.picked)
