"""Every component of the simulation, replayed; and a live session of real processes."""

import os
import secrets
import signal

import pytest

from runtime.launch import load
from runtime.recording import Recording
from runtime.replay import replay
from runtime.supervise import Supervisor
from tests.recorded_session import LAUNCH
from tests.runtime.offline import rewritten, without
from tests.runtime.system import run_until

FOLDS = [spec.name for spec in load(LAUNCH).components if not spec.tap]


@pytest.mark.xdist_group("session")
@pytest.mark.parametrize("name", FOLDS)
def test_every_output_of_a_session_is_said_again_to_the_byte(twins, name):
    report = replay(Recording(twins.first), name)
    assert not report.differs, report.first[0]
    assert not report.is_lossy
    assert report.count("identical") == sum(report.outputs.values()) > 0


@pytest.mark.xdist_group("session")
@pytest.mark.parametrize("name", ["tracker", "pilot", "learner"])
def test_a_component_is_told_nothing_of_what_it_said(twins, tmp_path, name):
    keys = load(LAUNCH).component(name).outputs.values()
    stripped = rewritten(twins.first, tmp_path / "stripped.mcap", without(*keys, "camera/image"))
    said = []
    replay(Recording(stripped), name, tell=lambda sample, _: said.append((sample.key, sample.sequence, sample.payload)))
    recorded = {(m.topic, m.sequence, m.payload) for m in Recording(twins.first).messages(keys)}
    assert len(said) == len(recorded) > 0
    assert set(said) == recorded


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    """Real processes at real time beside busy ones; one of them is killed and started again."""
    directory = tmp_path_factory.mktemp("live")
    launch, file = directory / "live.toml", directory / "live.mcap"
    launch.write_text(
        f"""
realm = "test/{secrets.token_hex(6)}"
[session]
clock = "real"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "fickle/drive" }}
params = {{ frames = 0 }}
[component.fickle]
run = "tests.runtime.parts.fickle"
restart = "on-failure"
inputs = {{ image = "world/image" }}
[component.recorder]
run = "components.recorder"
""",
        encoding="utf-8",
    )
    with Supervisor(load(launch, recording=file)) as supervisor:
        run_until(supervisor, lambda: _published(supervisor, "fickle") >= 8)
        os.kill(supervisor.pids["fickle"], signal.SIGKILL)
        run_until(supervisor, lambda: bool(supervisor.deaths) and not supervisor.missing)
        run_until(supervisor, lambda: 8 <= _published(supervisor, "fickle") < _published(supervisor, "world") - 8)
    return file


def _published(supervisor, name) -> int:
    status = supervisor.statuses.get(name)
    return 0 if status is None else status.published


def test_a_live_world_is_replayed_to_the_byte(live):
    report = replay(Recording(live), "world")
    assert (report.differs, report.is_lossy) == (False, False)
    assert report.count("identical") > 16


def test_a_killed_component_is_replayed_up_to_its_end_and_again_from_its_start(live):
    report = replay(Recording(live), "fickle")
    assert not report.differs, report.first[0]
    assert len(report.runs) == 2
    assert "without a stop" in report.runs[0].words
    assert report.runs[1].words == ""
    assert all(comparison.identical > 0 for comparison in report.comparisons)
    assert "started again" in report.notes[0]
