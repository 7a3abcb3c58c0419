"""Bad networks: the short form of `python -m benchmarks networks`."""

import sys

import pytest

from benchmarks.bad_network import BAD, RATE_BPS
from benchmarks.probe import Aged, Load, Probe
from tests.machines import two_machines

pytestmark = pytest.mark.xdist_group("live")
SECONDS = 5.0


@pytest.fixture(scope="module")
def aged(tmp_path_factory) -> dict[str, Aged]:
    """By what the link carries beside commands: 2 Mbit/s, 5 % of packets lost, 50 ms of jitter."""
    with two_machines(tmp_path_factory.mktemp("radio"), radio=True) as cable:
        cable.narrow(RATE_BPS)
        probe = Probe(cable)
        cable.become(BAD)
        return {pictures: probe.aged(Load(SECONDS, pictures)) for pictures in ("preview", "all")}


def test_a_bad_link_loses_no_command_beside_pictures_that_adapt(aged):
    """TCP repeats what the air has lost; on a machine that is too busy the link may be away for a second."""
    assert len(aged["preview"].ages_ms) > 0.7 * aged["preview"].sent


def test_pictures_adapt_to_the_link_so_that_commands_do_not_stand_behind_them(aged):
    """Seen: a tenth of the age, or all against half of the commands: the link itself is lost behind full pictures."""
    assert aged["preview"].pictures > 0
    assert aged["preview"].picture_bytes < aged["all"].picture_bytes / 2
    assert aged["preview"].percentile_ms(50) < aged["all"].percentile_ms(50) / 2


def test_both_clocks_of_a_machine_can_be_ahead_of_the_others(tmp_path):
    clocks = "import time; print(time.time(), time.monotonic())"
    with two_machines(tmp_path) as cable:
        cable.laptop.ahead_s = 1000.0
        words = (sys.executable, "-c", clocks)
        (wall_s, monotonic_s), (other_s, other_monotonic_s) = (
            map(float, machine.run(*words).communicate()[0].split()) for machine in (cable.laptop, cable.robot)
        )
    assert 900.0 < wall_s - other_s < 1001.0
    assert 900.0 < monotonic_s - other_monotonic_s < 1001.0
