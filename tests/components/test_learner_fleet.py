"""Several robots that share one learner."""

import itertools

import pytest

from components.learner.component import Learner
from components.learner.ports import FLEET, HEARD, POLICIES, Params
from docking.task import Task
from schemas.policy_pb2 import Policy
from tests.components.learning_world import session

TASK = Task(beta_cells=15, alpha_cells=15)
TABULAR = Params(task=TASK, delay_samples=0)
OURS = Params(task=TASK, method="structure-given", grid_angle_rad=0.17, grid_distance_share=0.5)


def heard(robot, seed, trials=4):
    """Events of a robot, in the learner's ports for it."""
    port = {part: name for name, (part, whose) in HEARD.items() if whose == robot}
    for frame in session(TASK, trials, seed=seed):
        yield tuple(event._replace(port=port[event.port]) for event in frame)


def interleaved(*robots):
    """Frame by frame, as long as the first robot has any."""
    for frames in itertools.zip_longest(*robots):
        yield from itertools.chain.from_iterable(frame for frame in frames if frame is not None)


def said(learner, events, port):
    return [output for event in events for output in learner.handle(event) if output.port == port]


def learned(params, *robots, told=0) -> Policy:
    return said(Learner(params, 0), interleaved(*robots), POLICIES[told])[-1].message


@pytest.mark.parametrize("params", [TABULAR, OURS])
@pytest.mark.parametrize("robot", range(1, FLEET))
def test_a_lesson_is_the_same_whichever_robot_it_comes_from(params, robot):
    assert learned(params, heard(robot, 3), told=robot) == learned(params, heard(0, 3))


def test_a_method_of_cells_gives_all_that_were_heard_of_the_same_policy():
    learner, events = Learner(TABULAR, 0), list(interleaved(heard(0, 3), heard(2, 4)))
    outputs = [output for event in events for output in learner.handle(event)]
    newest = {port: [o.message for o in outputs if o.port == port] for port in POLICIES}
    assert newest["policy_3"][-1] == newest["policy"][-1]
    assert newest["policy_2"] == newest["policy_4"] == []


def test_our_own_method_gives_each_its_own():
    events = list(interleaved(heard(0, 3), heard(2, 4)))
    learner = Learner(OURS, 0)
    versions = [(o.port, o.message.version) for e in events for o in learner.handle(e) if o.port in POLICIES]
    assert {port for port, _ in versions} == {"policy", "policy_3"}
    assert len({version for _, version in versions}) == len(versions)


def test_what_robots_see_at_the_same_time_is_counted_for_each_alone():
    together = learned(TABULAR, heard(0, 3), heard(1, 4), heard(3, 5))
    alone = [learned(TABULAR, heard(0, seed)).transitions for seed in (3, 4, 5)]
    assert together.transitions == sum(alone)


def test_the_pace_is_that_of_the_robot_that_is_behind():
    fast, slow = list(heard(0, 3))[:40], list(heard(2, 4))[:40]
    learner = Learner(OURS, 0)
    assert said(learner, itertools.chain(*fast[:20]), "pace")[-1].capture_ns == fast[19][0].time_ns
    said(learner, slow[0], "pace")
    assert said(learner, itertools.chain(*fast[20:]), "pace") == []
    later = [output.capture_ns for output in said(learner, itertools.chain(*slow[1:]), "pace")]
    assert later == [frame[0].time_ns for frame in slow[1:]]


@pytest.mark.parametrize("params", [TABULAR, OURS])
def test_a_saved_and_loaded_learner_goes_on_with_each_robot_where_it_was(params):
    events = list(interleaved(heard(0, 3), heard(1, 4)))
    cut = len(events) // 2 + 1
    whole, first, again = Learner(params, 0), Learner(params, 0), Learner(params, 0)
    expected = said(whole, events, "policy")
    before = said(first, events[:cut], "policy")
    again.load(first.save())
    assert [*before, *said(again, events[cut:], "policy")] == expected != []
    assert again.save() == whole.save()


def test_ports_of_other_robots_are_optional():
    assert [name for name, port in Learner.inputs.items() if not port.optional] == ["percept", "trial", "applied"]
