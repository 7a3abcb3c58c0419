"""`berth film`, and what a command says while it works."""

from pathlib import Path

from cli.doing import doing

RECORDINGS = Path(__file__).parents[2] / "recordings"


def test_a_session_without_a_policy_has_no_film(run, tmp_path):
    code, out, err = run("film", RECORDINGS / "docking.mcap", "-o", tmp_path / "x.webp")
    assert (code, out) == (2, "")
    assert err == f"berth: {RECORDINGS / 'docking.mcap'}: must hold a policy to make a film of\n"


def test_what_takes_long_says_so_where_there_is_no_terminal_and_what_does_not_says_nothing(capsys, monkeypatch):
    now_s = iter((0.0, 1.0, 3.0, 3.0, 4.0))
    monkeypatch.setattr("cli.doing.time.monotonic", lambda: next(now_s))
    with doing("thinking", quiet=False) as told:
        for share in (0.1, 0.5, 0.9):
            told(share)
    assert capsys.readouterr().err == "thinking: 50 %\n"


def test_quiet_says_nothing(capsys):
    with doing("thinking", quiet=True) as told:
        told(0.5)
    assert capsys.readouterr() == ("", "")
