"""ps, topic, logs and stop beside a running system; what the user does wrong is one line and exit code 2."""

import json
import subprocess
import sys

import pytest

from cli.main import VERBS
from runtime.runfile import find
from runtime.supervise import Supervisor
from tests.runtime.system import run_until, small_system, wait_for


def berth(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "cli.main", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.fixture(scope="module")
def realm(tmp_path_factory):
    """A running system."""
    system = small_system(tmp_path_factory.mktemp("looking"), ["world.frames=0"], clock="real")
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        yield system.realm


def test_ps_tells_what_runs_and_what_is_up(realm):
    runs = {run["realm"]: run for run in json.loads(berth("ps", "--json").stdout)}
    assert runs[realm]["up"] == ["world", "echo", "witness"]


def test_topic_list_names_every_key_and_its_schema(realm):
    topics = json.loads(berth("topic", "list", "--realm", realm, "--json").stdout)
    assert topics["echo/drive"] == "berth.BaseCommand"
    assert topics["world/status"] == "berth.Status"


def test_topic_echo_shows_messages_and_cuts_long_bytes(realm):
    shown = json.loads(berth("topic", "echo", "world/image", "-n", "1", "--realm", realm, "--json").stdout)
    assert shown["message"]["format"] == "none"
    assert shown["message"]["data"] == "0000000000000000... (1000 bytes)"


def test_topic_hz_counts_what_comes(realm):
    rates = json.loads(berth("topic", "hz", "world/image", "-w", "1", "--realm", realm, "--json").stdout)
    assert 4.0 <= rates["world/image"]["hz"] <= 12.0


def test_topic_info_names_the_fields(realm):
    info = json.loads(berth("topic", "info", "echo/drive", "--realm", realm, "--json").stdout)
    assert info["fields"]["v_mps"] == "double"


def test_logs_are_there_for_every_component(realm):
    assert berth("logs", "--realm", realm).returncode == 0
    assert "component ghost must have a log there" in berth("logs", "ghost", "--realm", realm).stderr


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("stop", "--realm", "no/such"), "realm no/such must be running"),
        (("topic", "list", "--realm", "no/such"), "realm no/such must be running"),
        (("logs", "--realm", "no/such"), "realm no/such must have run"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(words, says):
    result = berth(*words)
    assert result.returncode == 2
    assert result.stdout == ""
    assert says in result.stderr
    assert result.stderr.count("\n") == 1


def test_an_unknown_key_is_refused_with_the_known_ones(realm):
    result = berth("topic", "echo", "echo/dirve", "--realm", realm)
    assert (result.returncode, "world/image" in result.stderr) == (2, True)


def test_stop_stops_a_supervisor_by_its_run_file(tmp_path):
    small_system(tmp_path)
    code = (
        "import signal, sys; from pathlib import Path; from runtime.launch import load\n"
        "from runtime.supervise import Supervisor\n"
        f"system = load({str(tmp_path / 'small.toml')!r}, ['world.frames=0'], recording=Path({str(tmp_path)!r}, 'w'))\n"
        "supervisor = Supervisor(system)\n"
        "signal.signal(signal.SIGTERM, lambda *_: supervisor.stop_soon('interrupted'))\n"
        "with supervisor:\n"
        "    print(system.realm, flush=True)\n"
        "    while supervisor.poll(): pass\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as supervisor:
        realm = supervisor.stdout.readline().strip()
        assert find(realm).pid == supervisor.pid
        result = berth("stop", "--realm", realm, "--json")
        assert json.loads(result.stdout) == {"stopped": [realm], "still_running": []}
        assert wait_for(lambda: supervisor.poll() is not None, 5.0)


def test_help_lists_only_verbs_that_are_there():
    listed = berth("--help").stdout
    assert "topic" in listed
    assert all(target.startswith("cli.") for target in VERBS.values())
