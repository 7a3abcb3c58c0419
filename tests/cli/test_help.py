"""Help, completion, colour: what a person meets first."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from cli.layout import WIDTH, line_of, lines_of
from cli.main import app
from docs.reference.commands import verbs
from tests.docs.calls import parsed

COMMANDS = list(verbs(typer.main.get_command(app), "berth"))
WITHOUT_JSON = {"berth view", "berth keys init", "berth keys add"}
"""They print no numbers."""
DEADLINE_S = 120.0


def options(command):
    return {word for param in command.params for word in param.opts}


def test_the_help_fits_a_screen_and_no_line_of_it_is_cut(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    code, out, _ = run("--help")
    lines = out.splitlines()
    assert code == 0
    assert len(lines) <= 40
    assert max(map(len, lines)) <= WIDTH
    assert not [line for line in lines[1:] if line.endswith("...")]


@pytest.mark.parametrize("words", [words for words, _ in COMMANDS])
def test_the_line_of_a_command_fits_into_80_columns_too(words):
    line = line_of(dict(COMMANDS)[words].help)
    assert len(line) <= 80 - len("  experiment  ")


@pytest.mark.parametrize(("words", "command"), COMMANDS, ids=[words for words, _ in COMMANDS])
def test_every_command_says_what_it_does_and_has_an_example_that_it_understands(words, command):
    assert line_of(command.help)
    first, *others = lines_of((command.epilog or "").partition("Example:")[2])
    assert first.startswith(words.removesuffix(" contract"))
    for line in (first, *others):
        name, *rest = shlex.split(line)
        assert name == "berth"
        assert parsed(rest)


@pytest.mark.parametrize(("words", "command"), COMMANDS, ids=[words for words, _ in COMMANDS])
def test_every_command_that_prints_numbers_prints_them_as_json_too(words, command):
    assert ("--json" in options(command)) == (words not in WITHOUT_JSON)


def test_the_line_of_a_command_is_its_first_clause():
    assert line_of("Make a\nsession; exit code 3 if not. More.") == "Make a session"
    assert line_of("Show it.") == "Show it"
    assert line_of("") == ""


def test_where_there_is_no_terminal_there_is_no_colour(run):
    code, out, err = run("info", Path(__file__).parents[2] / "recordings" / "docking.mcap")
    assert (code, "\x1b" in out + err) == (0, False)


def test_one_command_teaches_the_shell_to_complete_verbs_and_options(tmp_path):
    """Typed in bash: install, begin a new shell, press Tab."""
    programs = Path(sys.executable).parent
    environment = {**os.environ, "HOME": str(tmp_path), "PATH": f"{programs}:{os.environ['PATH']}"}

    def bash(script):
        done = subprocess.run(
            ["bash", "-c", script], env=environment, capture_output=True, text=True, timeout=DEADLINE_S, check=True
        )
        return done.stdout

    tab = "source ~/.bash_completions/berth.sh; _berth_completion berth; echo ${COMPREPLY[@]}"
    assert "installed" in bash("berth --install-completion; true")
    assert bash(f"COMP_WORDS=(berth rel); COMP_CWORD=1; {tab}").split() == ["relearn"]
    assert bash(f"COMP_WORDS=(berth run --dur); COMP_CWORD=2; {tab}").split() == ["--duration"]
