"""The start barrier's bookkeeping, and the keys of its tokens."""

from hypothesis import given
from hypothesis import strategies as st

from runtime.bus import parse_ready_key, ready_key
from runtime.presence import LISTENS, STARTS, Presence


@given(st.sampled_from(["berth/sim", "a", "a/b/c"]), st.sampled_from([1, 2]), st.integers(1, 2**64 - 1))
def test_a_token_s_key_tells_who_it_is(realm, stage, run):
    assert parse_ready_key(ready_key(realm, stage, "tracker", run)) == (stage, "tracker", run)


def test_the_barrier_names_who_is_missing():
    presence = Presence(("head", "tracker"))
    presence.appear(LISTENS, "head", 1)
    presence.appear(STARTS, "head", 1)
    assert presence.missing(LISTENS) == ["tracker"]
    assert not presence.wait(STARTS, 0.0)
    presence.appear(LISTENS, "tracker", 2)
    assert presence.wait(LISTENS, 0.0)


def test_a_component_is_missing_again_when_all_its_runs_are_gone():
    presence = Presence(("head",))
    presence.appear(LISTENS, "head", 1)
    presence.appear(LISTENS, "head", 2)
    presence.vanish(LISTENS, "head", 1)
    assert presence.missing(LISTENS) == []
    presence.vanish(LISTENS, "head", 2)
    assert presence.missing(LISTENS) == ["head"]


def test_strangers_do_not_keep_a_component_from_being_alone():
    presence = Presence(("recorder", "head"))
    presence.appear(LISTENS, "recorder", 1)
    presence.appear(LISTENS, "supervisor", 2)
    assert presence.is_alone("recorder")
    presence.appear(LISTENS, "head", 3)
    assert not presence.is_alone("recorder")
