"""What `berth view` says to a person's mistakes: one line each, and nothing is started or made."""

import socket
from pathlib import Path

import pytest

pytest.importorskip("rerun", reason="Rerun is not installed: make setup-view")
RECORDINGS = Path(__file__).parents[2] / "recordings"
DOCKING = RECORDINGS / "docking.mcap"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((DOCKING, "--web", "--foxglove"), "--web, --foxglove and --save: only one of them"),
        ((DOCKING, "--realm", "x"), "--realm must stand without a file"),
        ((DOCKING, "--port", "1"), "--port must stand with --web or --foxglove"),
        (("--at-end", "--web"), "--at-end must stand with a file"),
        ((DOCKING, "--layout", "x"), "--layout must stand with --foxglove"),
        ((DOCKING, "--web", "--memory-limit", "much"), "--memory-limit must be like 500MB, 2GB or 25%; got 'much'"),
        ((DOCKING, "--save", DOCKING), "docking.mcap: can not be made: File exists"),
        ((DOCKING, "--save", "/no/such/folder/x.rrd"), "/no/such/folder/x.rrd: can not be made: No such file"),
        (("--realm", "no/such", "--web"), "realm no/such must be running; see `berth ps`"),
        (("no-such.mcap", "--web"), "no-such.mcap: can not be read: No such file or directory"),
        ((RECORDINGS / "README.md", "--web"), "README.md: must be an MCAP file"),
        ((RECORDINGS / "README.md", "--foxglove"), "README.md: must be an MCAP file"),
        ((DOCKING,), "there is no display here; use --web, --foxglove or --save FILE.rrd"),
    ],
)
def test_mistakes_are_named_in_one_line(run, monkeypatch, words, said):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    code, out, err = run("view", *words)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert said in err


@pytest.mark.parametrize("way", ["--web", "--foxglove"])
def test_a_taken_port_is_named(run, way):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        code, _, err = run("view", DOCKING, way, "--port", port)
    assert (code, len(err.splitlines())) == (2, 1)
    assert f"--port must be one that is free here; got {port}" in err


def test_without_the_viewer_one_line_names_the_command_that_brings_it(run, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    from cli import view  # noqa: PLC0415

    with pytest.raises(Exception, match="berth view needs rerun; `make setup-view` brings it"):
        view.view(DOCKING, save=None)
