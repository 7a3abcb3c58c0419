"""A task file is for all components, whoever is named with it, and two components never have two tasks."""

from pathlib import Path

import pytest

from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.shared_task import owner_of

SIM = Path(__file__).parent.parent.parent / "launch" / "sim.toml"
TASKED = ("simulator", "pilot", "learner")


@pytest.fixture
def goal(tmp_path):
    file = tmp_path / "goal.toml"
    file.write_text("goal_slope = -0.15\ngoal_pan_rad = -0.2\ngoal_tilt_rad = 0.9\n", encoding="utf-8")
    return file


def with_task(tmp_path, lines):
    file = tmp_path / "own.toml"
    file.write_text(SIM.read_text(encoding="utf-8").replace("[task]", f"[task]\n{lines}\n#", 1), encoding="utf-8")
    return file


def tasks(system):
    return [system.component(name).params["task"] for name in TASKED]


@pytest.mark.parametrize("key", ["task", "pilot.task", "learner.task", "simulator.task"])
def test_a_task_file_on_the_command_line_reaches_every_component(goal, key):
    system = load(SIM, [f"{key}={goal}"])
    assert [(t["goal_slope"], t["goal_pan_rad"], t["beta_cells"]) for t in tasks(system)] == [(-0.15, -0.2, 31)] * 3
    assert '"goal_slope": -0.15' in system.text


def test_the_file_goes_before_the_launch_file_and_later_words_before_earlier_ones(tmp_path, goal):
    launch = with_task(tmp_path, "goal_slope = 0.1\nbeta_cells = 15")
    file, key = f"pilot.task={goal}", "task.goal_slope=0.05"
    for overrides, slope in (((file,), -0.15), ((file, key), 0.05), ((key, file), -0.15)):
        assert [(t["goal_slope"], t["beta_cells"]) for t in tasks(load(launch, overrides))] == [(slope, 15)] * 3


def test_a_launch_file_names_a_task_file_and_its_own_fields_go_before(tmp_path, goal):
    system = load(with_task(tmp_path, f'file = "{goal}"\ngoal_pan_rad = -0.3'))
    assert [(t["goal_slope"], t["goal_pan_rad"]) for t in tasks(system)] == [(-0.15, -0.3)] * 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("goal_slop = 1", "goal.toml.goal_slop is unknown; known are"),
        ("goal_tilt_rad = 2.0", "goal.toml.goal_tilt_rad must be between 0 and 1.57; got 2.0"),
        ("goal_slope = 'steep'", "goal.toml.goal_slope must be a number; got 'steep'"),
        ("goal_slope = nan", "goal.toml.goal_slope must be finite"),
        ("[task]\ngoal_slope = 1", "goal.toml.task is unknown"),
        ("goal_slope =", "goal.toml: is not TOML"),
    ],
)
def test_what_is_wrong_with_a_task_file_is_said_in_its_own_name(goal, text, words):
    goal.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError) as refused:
        load(SIM, [f"pilot.task={goal}"])
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("task=none.toml", "none.toml: can not be read"),
        ("pilot.task=none.toml", "none.toml: can not be read"),
        ("task=", "must be the path of a task file; got ''"),
        ("task=3", "must be the path of a task file; got 3"),
        ("vision.task=none.toml", "vision.params.task is unknown"),
        ("plot.task=none.toml", "component plot is unknown"),
        ("pilot.task={goal_slope=0.1}", "pilot.params.task must be that of simulator; give it once, in [task]"),
        ("pilot.task=3", "pilot.params.task must be a table; got 3"),
    ],
)
def test_a_bad_task_on_the_command_line_is_refused(override, words):
    with pytest.raises(ConfigurationError) as refused:
        load(SIM, [override])
    assert words in str(refused.value)


def test_a_launch_file_can_not_name_what_is_no_file(tmp_path):
    with pytest.raises(ConfigurationError, match=r"own.toml: task.file must be the path of a task file; got 3"):
        load(with_task(tmp_path, "file = 3"))


def test_a_task_belongs_to_nobody_alone():
    assert [owner_of(text) for text in ("task=a.b", "pilot.task=a.b", "task.beta_cells=3", "pilot.x=task", "task")] == [
        "task", "task", "task", "pilot", "task",
    ]  # fmt: skip
