"""The command in this process."""

import sys

import pytest

from cli.main import main


@pytest.fixture(autouse=True)
def _in_time(monkeypatch):
    """On a busy machine a command says no more than on a quiet one."""
    monkeypatch.setattr("cli.doing.LINE_S", 600.0)


@pytest.fixture
def run(capsys, monkeypatch):
    """Runs `berth WORDS`; gives exit code, standard output and standard error."""

    def berth(*words) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["berth", *map(str, words)])
        with pytest.raises(SystemExit) as left:
            main()
        out, err = capsys.readouterr()
        return left.value.code, out, err

    return berth
