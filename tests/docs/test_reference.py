"""The reference says everything that the code declares."""

import dataclasses
import importlib

import pytest
import typer

from cli.main import app
from docking.task import Task
from docs.reference import commands, components, messages
from docs.reference.parameters import _docstrings, parameters, unit
from docs.reference.tables import table
from runtime.params import positive
from tests.docs.page import ROOT


@dataclasses.dataclass
class Example:
    turn_rad: float = positive(0.5)
    """An angle."""
    ready: bool = True
    names: tuple[str, ...] = ("a", "b")
    file: str = ""


KINDS = [Task, *(importlib.import_module(f"components.{name}.ports").Params for name in components.names())]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__module__)
def test_every_parameter_is_explained(kind):
    told = {field.name for field in dataclasses.fields(kind)} - {"task", "clock"}
    words = dict(_docstrings(kind))
    assert {name for name in told if not words.get(name)} == set()
    page = components.page()
    assert {name for name in told if f"| `{name}` |" not in page} == set()


def test_every_port_and_its_message_is_on_the_page_and_has_a_heading_to_link_to():
    page, headings = components.page(), messages.page()
    for name in components.names():
        ports = importlib.import_module(f"components.{name}.ports")
        for port, declared in {**getattr(ports, "INPUTS", {}), **getattr(ports, "OUTPUTS", {})}.items():
            assert f"| `{port}` |" in page
            schema = getattr(declared, "schema", None)
            assert schema is None or f"## {schema.DESCRIPTOR.name}\n" in headings


def test_every_message_of_the_schemas_is_on_the_page_with_its_fields():
    page = messages.page()
    for file in (ROOT / "schemas").glob("*.proto"):
        module = importlib.import_module(f"schemas.{file.stem}_pb2")
        for name, message in module.DESCRIPTOR.message_types_by_name.items():
            assert f"## {name}\n" in page
            assert all(f" {field.name} = " in page for field in message.fields)


def test_every_command_and_option_is_on_the_page():
    page = commands.page()
    for words, verb in commands.verbs(typer.main.get_command(app), "berth"):
        assert f"## {words}\n" in page
        for param in verb.params:
            assert param.name == "help" or param.param_type_name == "argument" or param.opts[-1] in page


def test_units_come_from_names():
    names = {"speed_mps": "m/s", "goal_pan_rad": "rad", "k_beta_per_s": "1/s", "beta_cells": "", "lamp_k": "K"}
    assert {name: unit(name) for name in names} == names


def test_defaults_are_told_as_a_launch_file_has_them_angles_in_degrees_too():
    rows = parameters_of(Example)
    assert rows["turn_rad"][:3] == ["`0.5` (28.65°)", "rad", "> 0"]
    assert rows["turn_rad"][3] == "An angle."
    assert [rows[name][0] for name in ("ready", "names", "file")] == ["`true`", "`[a, b]`", "empty"]


def parameters_of(kind):
    """Rows of the table by parameter."""
    lines = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in parameters(kind).splitlines()[2:]]
    return {cells[0].strip("`"): cells[1:] for cells in lines}


def test_a_bar_in_a_cell_does_not_split_it():
    assert table(("a",), [("x | y",)]).splitlines()[-1] == r"| x \| y |"
    assert table(("a",), []) == ""
