"""The shell of a tap, without a bus."""

import itertools
import time
from types import SimpleNamespace

import pytest

from runtime.inbox import Notice
from runtime.launch import load
from runtime.tap import Tap, known_keys
from tests.runtime.system import small_system

PATIENCE_S = 5.0


class NeverSilent:
    """An inbox in which something waits always."""

    def __init__(self):
        self._until_s = time.monotonic() + PATIENCE_S

    def box(self, name, limit):
        return None

    def take(self, timeout_s):
        if time.monotonic() > self._until_s:
            pytest.fail("the tap never came back to its ticks")
        return Notice("wake")


def test_a_bus_that_is_never_silent_does_not_keep_a_recorder_from_flushing(tmp_path):
    system = small_system(tmp_path)
    ticks = []
    outlet = SimpleNamespace(key="witness/status", sequence=0, put=lambda message, capture_ns: b"")
    station = SimpleNamespace(
        system=system,
        spec=system.component("witness"),
        assignment=SimpleNamespace(origin_ns=0),
        inbox=NeverSilent(),
        stop=SimpleNamespace(asked=False),
        outlets=SimpleNamespace(status=outlet, ports={}),
        run=1,
        lane=lambda *_: None,
        subscribe=lambda _: None,
        status=lambda handled: SimpleNamespace(DESCRIPTOR=SimpleNamespace(full_name="berth.Status")),
    )
    tap = Tap(
        station, SimpleNamespace(tick=lambda time_ns: ticks.append(time.monotonic()) or (), message=lambda *_: ())
    )
    while len(ticks) < 4:
        tap._turn()
    gaps_s = [later - sooner for sooner, later in itertools.pairwise(ticks)]
    assert max(gaps_s) < 1.0


def test_what_comes_from_elsewhere_is_known_by_who_reads_it(tmp_path):
    whole = small_system(tmp_path)
    part = load(whole.file, only=("echo", "witness"), recording=tmp_path / "x")
    keys = {key: (schema.DESCRIPTOR.full_name, publisher) for key, schema, publisher in known_keys(part)}
    assert keys["world/image"] == ("foxglove.CompressedImage", "")
    assert "world/end" not in keys
    assert {key: publisher for key, _, publisher in known_keys(whole)}["world/image"] == "world"


@pytest.mark.parametrize(("left_out", "asked"), [((), {"**"}), (("world/image",), None)])
def test_a_key_that_is_left_out_is_not_asked_for(tmp_path, left_out, asked):
    """So it does not cross a link."""
    system = small_system(tmp_path)
    subscribed, lanes = set(), set()
    station = SimpleNamespace(
        system=system,
        spec=SimpleNamespace(name="witness", params={"leave_out": left_out}),
        assignment=SimpleNamespace(origin_ns=0),
        inbox=NeverSilent(),
        lane=lambda box, key, schema, publisher: lanes.add(key),
        subscribe=subscribed.add,
    )
    Tap(station, None)
    others = {key for key, _, publisher in known_keys(system) if publisher != "witness"}
    assert lanes == others - set(left_out)
    assert subscribed == (asked or lanes)
