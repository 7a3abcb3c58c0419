"""Who has no checkout names one of our launch files; who has a file of that name gets his own."""

from pathlib import Path

import pytest

from runtime.brought import FOLDER, launch_file
from runtime.launch import load
from runtime.params import ConfigurationError

OURS = sorted(file.stem for file in FOLDER.glob("*.toml"))


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", OURS)
def test_a_system_that_we_bring_is_known_by_its_name_and_by_the_path_of_the_documentation(name):
    assert load(name) == load(f"launch/{name}.toml") == load(FOLDER / f"{name}.toml")


@pytest.mark.parametrize("name", ["sim", "launch/sim.toml"])
def test_an_own_file_of_that_name_goes_first(elsewhere, name):
    own = elsewhere / name
    own.parent.mkdir(exist_ok=True)
    own.touch()
    assert launch_file(name) == Path(name)


def test_a_folder_of_that_name_is_no_launch_file(elsewhere):
    (elsewhere / "sim").mkdir()
    assert launch_file("sim") == FOLDER / "sim.toml"


@pytest.mark.parametrize(
    "name", ["sin", "sim.toml", "other/sim.toml", "../launch/sim.toml", "/sim", "", ".", "\0", "a" * 300]
)
def test_whatever_else_is_not_there_is_not_guessed(name):
    assert launch_file(name) == Path(name)
    with pytest.raises(ConfigurationError, match="can not be read"):
        load(name)


def test_a_file_without_end_is_refused():
    with pytest.raises(ConfigurationError, match="/dev/zero: must be no larger than"):
        load("/dev/zero")
