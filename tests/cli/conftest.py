"""The command in this process."""

import sys

import pytest

from cli.main import main


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
