"""The motions of each stage."""

from __future__ import annotations

from functools import partial

from components.inspector.first_step import drove_too_far, turned_too_far
from components.inspector.gripper_axes import open_action, safe_action
from components.inspector.phase import Action, Phase
from components.inspector.ports import Params
from components.inspector.sample import Sample

_HOLD_S, _REST_S, _MOVE_S = 1.125, 1.5, 1.0
_STEP_S = 0.25
"""Of the first steps: so short that a robot whose unit is wrong by any factor has not got up speed."""
_A_LITTLE, _MORE = 0.1, 0.3
"""Speed of the first steps, of that of the motion itself: units are wrong by ten and more, wheels by less."""


def script(params: Params) -> tuple[Phase, ...]:
    """The phases of the stage."""
    return {"facing": facing, "fingertips": fingertips, "head": head}[params.stage](params)


def facing(params: Params) -> tuple[Phase, ...]:
    """Pan, tilt, turn and drive, each to and fro; what is compared are the rests between.

    The wheels begin with steps of millimetres: nobody knows yet by what factor they obey.
    """
    pan, tilt, turn, speed = params.pan_step_rad, params.tilt_step_rad, params.turn_rate_radps, params.speed_mps
    small, larger = _A_LITTLE * speed, _MORE * speed
    turned = partial(turned_too_far, told_rad=0.2 * turn * _STEP_S, params=params)
    drove, drove_on = (partial(drove_too_far, told_m=v * _STEP_S, params=params) for v in (small, larger))
    return (
        Phase("rest", _REST_S),
        Phase("pan +", _HOLD_S, pan_rad=pan),
        Phase("pan 0", _HOLD_S),
        Phase("pan -", _HOLD_S, pan_rad=-pan),
        Phase("tilt 0", _HOLD_S),
        Phase("tilt +", _HOLD_S, tilt_rad=tilt),
        Phase("tilt -", _HOLD_S, tilt_rad=-tilt),
        Phase("before the wheels", _HOLD_S),
        Phase("turn a little", _STEP_S, omega_radps=0.2 * turn),
        Phase("before the turn", _HOLD_S, check=partial(turned, before="before the wheels", after="before the turn")),
        Phase("turn", _MOVE_S, omega_radps=turn),
        Phase("after the turn", _HOLD_S),
        Phase("turn back", _MOVE_S, omega_radps=-turn),
        Phase("before the first step", _HOLD_S),
        Phase("drive a little", _STEP_S, v_mps=small),
        Phase(
            "between the steps",
            _HOLD_S,
            check=partial(drove, before="before the first step", after="between the steps"),
        ),
        Phase("drive more", _STEP_S, v_mps=larger),
        Phase(
            "before the drive", _REST_S, check=partial(drove_on, before="between the steps", after="before the drive")
        ),
        Phase("drive", _MOVE_S, v_mps=speed),
        Phase("after the drive", _REST_S),
        Phase("drive back", _MOVE_S, v_mps=-speed),
        Phase("at the end", _HOLD_S),
    )


def fingertips(params: Params) -> tuple[Phase, ...]:
    """The object comes between the beams; then fingers and lift, a little and back, whichever way round they run."""
    longest_s, creep = params.creep_m / params.creep_mps, params.creep_mps
    return (
        Phase("rest", 1.0),
        Phase("creep", longest_s, v_mps=creep, until=_both_beams_changed),
        Phase("stand", 0.5),
        Phase("close", 3.0, gripper=Action.CLOSE, until=lambda _, now: now.closed),
        Phase("lift", 2.0, gripper=Action.LIFT, until=lambda first, now: now.lift_down != first.lift_down),
        Phase("lower", 3.0, gripper=Action.LOWER, until=_lowered),
        Phase("lift again", 3.0, gripper=Action.LIFT, until=lambda _, now: now.lift_down),
        Phase("open", 1.5, gripper=safe_action, until=lambda _, now: now.closed),
        Phase("open again", 1.25, gripper=open_action),
        Phase("creep back", longest_s, v_mps=-creep, as_long_as="creep"),
        Phase("at the end", 0.5),
    )


def _both_beams_changed(first: Sample, now: Sample) -> bool:
    return now.inner != first.inner and now.outer != first.outer


def _lowered(first: Sample, now: Sample) -> bool:
    """The lift has moved, and the fingers, too, unless the lift goes up."""
    return now.lift_down != first.lift_down and (now.closed != first.closed or not now.lift_down)


STEPS = (1, 0, 1, -1, 0, -1, 1, -1, 0, 1, -1)
"""Of the response, in units of a step, a few frames each."""


def head(params: Params) -> tuple[Phase, ...]:
    """Steps of one axis after the other."""
    pan, tilt = params.pan_step_rad, params.tilt_step_rad
    frames = 3 * params.frame_s
    return (
        Phase("rest", _REST_S),
        *(Phase("pan", frames, pan_rad=step * pan) for step in STEPS * 3),
        Phase("between", _REST_S),
        *(Phase("tilt", frames, tilt_rad=(1 + step) * tilt) for step in STEPS * 3),
        Phase("at the end", _REST_S),
    )
