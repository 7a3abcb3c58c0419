"""`berth experiment`: the options reach the campaign, errors name the option."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from cli.experiment import experiment
from experiments import law_comparison
from runtime.params import ConfigurationError

APP = typer.Typer()
APP.command()(experiment)


def run(*arguments: str) -> str:
    result = CliRunner().invoke(APP, list(arguments), catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_json_is_one_object_with_rows_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(law_comparison, "_CEILING", "LC, best-tuned")  # the real one takes seconds
    text = run("docking-law", "--goal", "dock", "-o", str(tmp_path), "--backend", "threading", "--json")
    told = json.loads(text)
    assert told["experiment"] == "docking-law"
    assert Path(told["csv"]).read_text().count("\n") == len(told["rows"]) + 1
    assert all(Path(path).exists() for path in told["pictures"])
    assert all("(dock)" in row["controller"] for row in told["rows"])
    again = run("docking-law", "--goal", "dock", "-o", str(tmp_path), "--backend", "threading")
    assert str(tmp_path / "docking-law.csv") in again.replace("\n", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["ceiling", "--goal", "moon"], "--goal must be cell or dock"),
        (["ceiling", "--turn-rate-dps", "0"], "--turn-rate-dps must be > 0"),
        (["ceiling", "--speed-mps", "nan"], "--speed-mps must be > 0"),
        (["ceiling", "--delay-samples", "-1"], "--delay-samples must be 0 to 100"),
        (["curves", "--plant-noise", "2"], "--plant-noise must be in"),
        (["curves", "--seeds", "x"], "--seeds must be a count"),
        (["nothing"], "experiment must be one of"),
        (["table2", "--neural"], "--neural belongs to schools"),
    ],
)
def test_a_wrong_option_is_named(arguments: list[str], words: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=words):
        CliRunner().invoke(APP, [*arguments, "-o", str(tmp_path)], catch_exceptions=False)


def test_the_command_line_imports_nothing_heavy_before_it_is_called() -> None:
    code = "import sys, cli.experiment; print({'numba','numpy','matplotlib','joblib','scipy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
