"""A launch file is untrusted: it is right, or one line says what is wrong with it."""

import json
from pathlib import Path

import pytest

from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.system import System
from runtime.wiring import wires

SIM = Path(__file__).parent.parent.parent / "launch" / "sim.toml"
SIM2 = SIM.parent / "sim2.toml"


def changed(tmp_path, *changes):
    text = SIM.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    file = tmp_path / "bad.toml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('run = "components.vision"', 'run = "components.visoin"', "vision.run must name a package with a ports.py"),
        ('run = "components.vision"', "run = 3", "vision.run must be a text; got 3"),
        ('realm = "berth/sim"', 'realm = "berth/*"', "realm must be words joined by /; got 'berth/*'"),
        ('realm = "berth/sim"', "", "realm must be words joined by /; got None"),
        ("seed = 1", "seed = -1", "session.seed must be a whole number >= 0; got -1"),
        ('clock = "lockstep"', 'clock = "fast"', "session.clock must be lockstep, real or a factor > 0; got 'fast'"),
        ('end = "pilot/end"', 'end = "pilot/fin"', "session.end must be published by some component; got 'pilot/fin'"),
        ("outputs = { image = ", "outputs = { imago = ", "simulator.outputs.imago is unknown; known are"),
        ('inputs = { image = "camera/image" }', 'inputs = { image = "camera/img" }',
         "vision.inputs.image must be published by some component; got 'camera/img'"),
        ('inputs = { image = "camera/image" }', "", "vision.inputs.image is missing; it must be the key of"),
        ('inputs = { image = "camera/image" }', 'inputs = { image = "simulator/truth" }', "ground truth is for"),
        ('inputs = { image = "camera/image" }', 'inputs = { image = "pilot/trial" }',
         "vision.inputs.image must be a foxglove.CompressedImage; 'pilot/trial' is a berth.Trial"),
        ('inputs = { view = "vision/view"', 'inputs = { sight = "vision/view"', "tracker.inputs.sight is unknown"),
        ('outputs = { image = "camera/image" }', 'outputs = { image = "pilot/trial" }', "must not share a key"),
        ('restart = "on-failure"', 'restart = "perhaps"', "learner.restart must be one of never, on-failure, always"),
        ("[task]", "[task]\nbeta_cells = 30", "task.beta_cells must be odd and at least 3, at most 501; got 30"),
        ("[task]", "[tusk]", "tusk is unknown; known are realm, session, task, component"),
        ("[component.vision]", '[component.vision]\nhost = "a/b"', "vision.host must be a lower-case word; got 'a/b'"),
        ("[component.vision]", "[component.vision]\ncolour = 1", "vision.colour is unknown"),
        ("[component.vision]", "[component.vision]\nparams = { x_y_z = 1 }", "vision.params.x_y_z is unknown"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_in_one_line(tmp_path, old, new, message):
    file = changed(tmp_path, (old, new))
    with pytest.raises(ConfigurationError) as refused:
        load(file)
    text = str(refused.value)
    assert message in text
    assert text.startswith(str(file))
    assert "\n" not in text


def test_an_unreadable_file_is_one_line(tmp_path):
    with pytest.raises(ConfigurationError, match="can not be read: No such file"):
        load(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigurationError, match="is not TOML"):
        load(tmp_path / "bytes.toml")


def test_two_tables_of_one_component_are_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="is not TOML"):
        load(changed(tmp_path, ("[component.vision]", "[component.head]\n[component.vision]")))


def test_the_system_survives_its_json():
    system = load(SIM, recording=Path("x.mcap"))
    assert System.from_json(system.to_json()).to_json() == system.to_json()
    assert json.loads(system.text)["realm"] == "berth/sim"


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("pilot", "must be COMPONENT.PARAM=VALUE"),
        ("pilot.x", "must be COMPONENT.PARAM=VALUE"),
        ("plot.train_s=1", "component plot is unknown"),
        ("pilot.train_s=fast", "pilot.params.train_s must be a number; got 'fast'"),
    ],
)
def test_a_bad_override_is_refused(override, message):
    with pytest.raises(ConfigurationError) as refused:
        load(SIM, [override])
    assert message in str(refused.value)


def test_overrides_reach_component_task_and_session():
    system = load(SIM, ["pilot.train_s=12.5", "task.beta_cells=15", "session.seed=7"])
    assert system.component("pilot").params["train_s"] == 12.5
    assert system.component("learner").params["task"]["beta_cells"] == 15
    assert system.seed == 7


def test_components_have_different_seeds_that_follow_the_session():
    one, other = load(SIM), load(SIM, seed=2)
    assert len({spec.seed for spec in one.components}) == len(one.components)
    assert all(a.seed != b.seed for a, b in zip(one.components, other.components, strict=True))


def test_without_a_recording_there_is_no_recorder():
    assert "recorder" not in {spec.name for spec in load(SIM).components}
    assert load(SIM, recording=Path("x.mcap")).recording == Path("x.mcap")


def test_only_named_components_are_kept_and_unknown_ones_refused():
    assert [spec.name for spec in load(SIM, only=("vision",)).components] == ["vision"]
    with pytest.raises(ConfigurationError, match="component visoin is unknown"):
        load(SIM, only=("visoin",))
    with pytest.raises(ConfigurationError, match="--host must be one of robot; got 'moon'"):
        load(SIM, host="moon")


def test_each_host_runs_its_components_and_knows_all():
    robot, laptop = (load(SIM2, host=host, recording=Path("x.mcap")) for host in ("robot", "laptop"))
    assert [spec.name for spec in robot.components] == [spec.name for spec in laptop.components]
    assert {spec.name for spec in laptop.here} == {"learner", "recorder"}
    assert {spec.name for spec in robot.here} == {spec.name for spec in robot.components} - {"learner", "recorder"}
    assert (robot.recording, laptop.recording) == (None, Path("x.mcap"))
    assert (robot.other_hosts, laptop.other_hosts) == (("laptop",), ("robot",))
    everything = load(SIM2, recording=Path("x.mcap"))
    assert (everything.here, everything.other_hosts) == (everything.components, ())


def test_two_machines_run_what_one_runs():
    """And a preview, which only looks on."""
    one, two = load(SIM, clock="real"), load(SIM2)
    assert [(s.name, s.run, s.inputs, s.params) for s in one.components] == [
        (s.name, s.run, s.inputs, s.params) for s in two.components if s.name != "preview"
    ]
    assert "preview/image" not in {key for spec in two.components for key in spec.inputs.values()}


@pytest.mark.parametrize("name", ["simulator", "vision", "head", "tracker", "pilot", "grasper"])
def test_who_decides_in_a_frame_what_base_does_shares_its_host(tmp_path, name):
    run = f'run = "components.{name}"'
    with pytest.raises(ConfigurationError, match=f"{name}.host must be 'robot', that of base, .*; got 'laptop'"):
        load(changed(tmp_path, (run, run + '\nhost = "laptop"')))


def test_a_cycle_without_delay_is_refused(tmp_path):
    file = tmp_path / "ring.toml"
    file.write_text(
        'realm = "t/ring"\n'
        '[component.a]\nrun = "components.head"\ninputs = { aim = "b/actuate", device = "b/state" }\n'
        '[component.b]\nrun = "components.head"\ninputs = { aim = "a/actuate", device = "a/state" }\n'
    )
    with pytest.raises(ConfigurationError, match="inputs must not form a cycle without delay; got a/state <- b/state"):
        load(file)


def test_every_wire_of_the_simulation_is_known():
    found = {(wire.key, wire.target) for wire in wires(load(SIM))}
    assert ("camera/image", "vision") in found
    assert ("base/actuate", "simulator") in found
