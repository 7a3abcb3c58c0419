"""`berth film`, and what a command says while it works."""

import threading
import time
from pathlib import Path

from cli.doing import doing

RECORDINGS = Path(__file__).parents[2] / "recordings"


def test_a_session_without_a_policy_has_no_film(run, tmp_path):
    code, out, err = run("film", RECORDINGS / "docking.mcap", "-o", tmp_path / "x.webp")
    assert (code, out) == (2, "")
    assert err == f"berth: {RECORDINGS / 'docking.mcap'}: must hold a policy to make a film of\n"


def test_what_takes_long_says_so_where_there_is_no_terminal(capsys, monkeypatch):
    monkeypatch.setattr("cli.doing.LINE_S", 10.0)
    now_s = iter((0.0, 19.0, 20.0, 20.0, 29.0))
    monkeypatch.setattr("cli.doing.time.monotonic", lambda: next(now_s))
    with doing("thinking", quiet=False) as told:
        for share in (0.1, 0.5, 0.9):
            told(share)
    assert capsys.readouterr().err == "thinking: 50 %\n"


def test_after_a_moment_it_says_what_it_is_at_even_if_nobody_tells_how_far(capsys, monkeypatch):
    monkeypatch.setattr("cli.doing.LINE_S", 0.0)
    said, deadline_s = "", time.monotonic() + 30.0
    with doing("thinking", quiet=False):
        while not said and time.monotonic() < deadline_s:
            said = capsys.readouterr().err
    assert said == "thinking ...\n"


def test_what_is_done_sooner_says_nothing(capsys, monkeypatch):
    monkeypatch.setattr("cli.doing.LINE_S", 600.0)
    with doing("thinking", quiet=False):
        pass
    assert threading.active_count() == 1 or not [t for t in threading.enumerate() if t.name.startswith("Timer")]
    assert capsys.readouterr().err == ""


def test_quiet_says_nothing(capsys):
    with doing("thinking", quiet=True) as told:
        told(0.5)
    assert capsys.readouterr() == ("", "")
