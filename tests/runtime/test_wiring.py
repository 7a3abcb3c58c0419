"""The graph of a system: who feeds whom, and every way in which it can not work."""

import pytest

from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.wiring import Wire, check_wiring, publishers, wires
from tests.recorded_session import LAUNCH

PARTS = {
    "world": 'run = "tests.runtime.parts.world"\ninputs = { drive = "echo/drive" }',
    "echo": 'run = "tests.runtime.parts.echo"\ninputs = { image = "world/image" }',
}


def system(tmp_path, head: str = "", **parts: str):
    """World and echo, changed."""
    text = f'realm = "test/wiring"\n{head}\n'
    text += "\n".join(f"[component.{name}]\n{body}" for name, body in {**PARTS, **parts}.items())
    (tmp_path / "wiring.toml").write_text(text, encoding="utf-8")
    return load(tmp_path / "wiring.toml")


def refused(tmp_path, head: str = "", **parts: str) -> str:
    with pytest.raises(ConfigurationError) as error:
        system(tmp_path, head, **parts)
    return str(error.value).removeprefix(f"{tmp_path}/")


def test_every_key_has_one_publisher_under_its_alias():
    found = publishers(load(LAUNCH))
    assert found["camera/image"] == ("simulator", "image")
    assert "simulator/image" not in found
    assert found["vision/view"] == ("vision", "view")


def test_wires_join_outputs_to_inputs_in_launch_order(tmp_path):
    assert wires(system(tmp_path)) == [
        Wire("echo", "drive", "echo/drive", "world", "drive"),
        Wire("world", "image", "world/image", "echo", "image"),
    ]


def test_nobody_is_wired_to_ground_truth():
    assert not [wire for wire in wires(load(LAUNCH)) if wire.key == load(LAUNCH).truth]


@pytest.mark.parametrize("component", [spec.name for spec in load(LAUNCH).components])
def test_no_component_can_be_wired_to_ground_truth(tmp_path, component):
    """Whatever its ports: an input of the truth's schema would be refused as well."""
    text = LAUNCH.read_text(encoding="utf-8")
    spec = load(LAUNCH).component(component)
    port, key = next(iter(spec.inputs.items()))
    head, mark, body = text.partition(f"[component.{component}]")
    body = body.replace(f'{port} = "{key}"', f'{port} = "simulator/truth"', 1)
    (tmp_path / "truth.toml").write_text(head + mark + body, encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"ground truth is for evaluation only"):
        load(tmp_path / "truth.toml")


def test_a_ring_with_a_delay_in_it_is_a_control_loop(tmp_path):
    check_wiring(system(tmp_path))


def test_a_ring_without_delay_is_refused_and_shown(tmp_path):
    loop = 'run = "tests.runtime.parts.loop"\ninputs = {{ drive = "{}/drive" }}'
    message = refused(tmp_path, left=loop.format("right"), right=loop.format("left"))
    assert message == (
        "wiring.toml: inputs must not form a cycle without delay; got left/drive <- right/drive <- left/drive"
    )


def test_a_component_that_feeds_itself_without_delay_is_refused(tmp_path):
    loop = 'run = "tests.runtime.parts.loop"\ninputs = { drive = "own/drive" }'
    assert "got own/drive <- own/drive" in refused(tmp_path, own=loop)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (
            {"echo": PARTS["echo"] + '\noutputs = { drive = "world/image" }'},
            "wiring.toml: echo.outputs.drive must not share a key; 'world/image' is published by world already",
        ),
        (
            {"echo": PARTS["echo"].replace("world/image", "word/image")},
            "wiring.toml: echo.inputs.image must be published by some component; got 'word/image'",
        ),
        (
            {"echo": PARTS["echo"].replace("world/image", "world/end")},
            "wiring.toml: echo.inputs.image must be a foxglove.CompressedImage; 'world/end' is a berth.SessionEnd",
        ),
        (
            {"echo": 'run = "tests.runtime.parts.echo"'},
            "wiring.toml: echo.inputs.image is missing; it must be the key of a CompressedImage",
        ),
        (
            {"echo": PARTS["echo"].replace("{ image", "{ gone")},
            "wiring.toml: echo.inputs.gone is unknown; known are image",
        ),
    ],
)
def test_a_wire_that_can_not_work_is_named(tmp_path, parts, message):
    assert refused(tmp_path, **parts) == message


@pytest.mark.parametrize("name", ["end", "trial", "truth"])
def test_a_session_key_that_nobody_publishes_is_named(tmp_path, name):
    message = refused(tmp_path, head=f'[session]\n{name} = "a/b"')
    assert message == f"wiring.toml: session.{name} must be published by some component; got 'a/b'"


def test_an_optional_input_may_stay_unwired(tmp_path):
    assert "ack" not in system(tmp_path).component("world").inputs
