"""Run files."""

import os
from pathlib import Path

import pytest

from runtime.params import ConfigurationError
from runtime.runfile import claim, find, newest_logs, private_directory, running


@pytest.fixture(autouse=True)
def _private(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


def held(realm: str):
    return claim(realm, "tcp/127.0.0.1:1", "now", "a.toml", ("head",), {"head/state": "berth.HeadState"})


def test_a_claimed_realm_is_found_while_it_is_held():
    with held("berth/a") as run:
        assert running() == [run]
        assert find() == run
        assert run.pid == os.getpid()
    assert running() == []


def test_a_realm_is_held_once():
    with held("berth/a"), pytest.raises(ConfigurationError, match="realm must not run yet"), held("berth/a"):
        pass
    with held("berth/a"):
        pass


def test_realms_are_told_apart():
    with held("berth/a"), held("berth/b"):
        with pytest.raises(ConfigurationError, match="--realm must be one of berth/a, berth/b"):
            find()
        assert find("berth/b").realm == "berth/b"
    with pytest.raises(ConfigurationError, match="nothing is running"):
        find()


def test_a_run_file_that_nobody_holds_is_not_believed():
    with held("berth/a"):
        text = (private_directory() / "berth+a.run.json").read_text(encoding="utf-8")
    (private_directory() / "berth+a.run.json").write_text(text, encoding="utf-8")
    assert running() == []
    with held("berth/a"):
        pass


def test_a_directory_that_others_may_enter_is_refused():
    private_directory().chmod(0o755)
    with pytest.raises(ConfigurationError, match="directory of this user alone"):
        private_directory()


def test_logs_outlive_their_run_but_not_for_ever():
    directories = []
    for _ in range(20):
        with held("berth/a") as run:
            directories.append(run.directory)
    assert str(newest_logs("berth/a")) in directories
    assert sum(Path(directory).is_dir() for directory in directories) == 17
    with pytest.raises(ConfigurationError, match="must have run on this host"):
        newest_logs("berth/other")
