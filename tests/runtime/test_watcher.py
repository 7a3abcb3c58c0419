"""What a supervisor hears of its system: only runs that were announced are believed, up to their last word."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
import zenoh

from runtime.bus import direct, free_endpoint, open_peer, open_router
from runtime.params import ConfigurationError
from runtime.presence import LISTENS, Presence
from runtime.supervise import Supervisor
from runtime.watcher import Watcher
from runtime.wire import encoding_of, pack_stamp
from schemas.session_pb2 import SessionEnd, Status
from tests.runtime.system import run_until, small_system, wait_for

pytestmark = pytest.mark.xdist_group("live")
KEY = "test/watcher/end"
RUN, OTHER_RUN = 7, 8
LAST = 99


class Wire:
    """A publisher, and what a watcher at the other end of it has believed."""

    def __init__(self, session: zenoh.Session, heard: list[tuple[str, int]], failures: list[BaseException]) -> None:
        self.session = session
        self.heard = heard
        self.failures = failures

    def say(self, reason: str, run: int, *, encoding: str = encoding_of(SessionEnd)) -> None:
        payload = SessionEnd(reason=reason).SerializeToString()
        self.session.put(KEY, payload, attachment=pack_stamp(run, 0, LAST), encoding=encoding)

    def put(self, payload: bytes, attachment: bytes | None) -> None:
        self.session.put(KEY, payload, attachment=attachment, encoding=encoding_of(SessionEnd))

    def heard_up_to(self, reason: str, run: int) -> list[tuple[str, int]]:
        """All that was believed, once something good has come through behind it."""
        self.say(reason, run)
        assert wait_for(lambda: (reason, LAST) in self.heard, 20.0)
        return self.heard


@contextmanager
def wire(presence: Presence, publisher: str = "pilot", call=None) -> Iterator[Wire]:
    heard: list[tuple[str, int]] = []
    failures: list[BaseException] = []
    endpoint = free_endpoint()
    take = call or (lambda message, capture_ns: heard.append((message.reason, capture_ns)))
    watcher = Watcher(SessionEnd, publisher, presence, take, failures.append)
    with open_router(endpoint) as router, open_peer(endpoint) as session:
        router.declare_subscriber(KEY, direct(watcher.receive))
        matching = session.declare_publisher(KEY)
        assert wait_for(lambda: matching.matching_status.matching, 20.0)
        yield Wire(session, heard, failures)


def announced(name: str, run: int = RUN) -> Presence:
    presence = Presence((name,))
    presence.appear(LISTENS, name, run)
    return presence


def test_only_an_announced_run_of_the_key_s_publisher_is_believed():
    presence = announced("pilot")
    presence.appear(LISTENS, "tracker", OTHER_RUN)
    with wire(presence) as pilot:
        pilot.say("nobody's", 1)
        pilot.say("tracker's", OTHER_RUN)
        assert pilot.heard_up_to("pilot's", RUN) == [("pilot's", LAST)]


def test_a_key_of_an_unknown_publisher_is_believed_from_whoever_is_announced():
    with wire(announced("player", OTHER_RUN), publisher="") as player:
        player.say("nobody's", 1)
        assert player.heard_up_to("player's", OTHER_RUN) == [("player's", LAST)]


def test_the_last_word_of_a_run_may_come_after_its_leave():
    presence = announced("pilot")
    with wire(presence) as pilot:
        pilot.heard_up_to("first", RUN)
        presence.vanish(LISTENS, "pilot", RUN)
        assert pilot.heard_up_to("last", RUN) == [("first", LAST), ("last", LAST)]


def test_what_is_malformed_is_passed_over():
    with wire(announced("pilot")) as pilot:
        pilot.put(b"\xff\xff", pack_stamp(RUN, 0, 0))
        pilot.put(b"", None)
        pilot.put(b"", b"short")
        pilot.say("another schema", RUN, encoding=encoding_of(Status))
        assert pilot.heard_up_to("good", RUN) == [("good", LAST)]
        assert pilot.failures == []


def test_an_exception_of_the_one_who_is_called_is_not_swallowed():
    def fail(message, capture_ns):
        raise ConfigurationError(message.reason)

    with wire(announced("pilot"), call=fail) as pilot:
        pilot.say("told to fail", RUN)
        assert wait_for(lambda: pilot.failures, 20.0)
        assert [str(failure) for failure in pilot.failures] == ["told to fail"]


def test_a_stranger_neither_ends_a_session_nor_speaks_for_its_components(tmp_path):
    system = small_system(tmp_path, ["world.frames=0"], clock="real")
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        with open_peer(supervisor.run.endpoint) as stranger:
            for key, message in (("world/end", SessionEnd(reason="lie")), ("echo/status", Status(component="echo"))):
                payload, encoding = message.SerializeToString(), encoding_of(type(message))
                publisher = stranger.declare_publisher(f"{system.realm}/{key}", encoding=encoding)
                assert wait_for(lambda it=publisher: it.matching_status.matching, 20.0)
                publisher.put(payload, attachment=pack_stamp(RUN, 0, 0))
            before = supervisor.statuses["echo"].handled
            run_until(supervisor, lambda: supervisor.statuses["echo"].handled > before + 8)
        assert supervisor.end_reason == ""
