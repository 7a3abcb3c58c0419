"""Session time."""

from hypothesis import given
from hypothesis import strategies as st

from runtime.clock import LOG_SKEW_NS, FrameClock, LogTimes, PacedClock, Pacer, TickSchedule

S = 1_000_000_000


def test_the_first_tick_is_due_at_time_zero():
    assert TickSchedule(50).due(0) == 0


def test_late_ticks_coalesce_into_one_and_are_counted():
    schedule = TickSchedule(50)
    schedule.due(0)
    assert schedule.due(19_999_999) is None
    assert schedule.due(125_000_000) == 120_000_000
    assert schedule.coalesced == 5
    assert schedule.due(125_000_000) is None


@given(st.lists(st.integers(0, 10 * S), min_size=1), st.sampled_from([1.0, 8.0, 50.0, 64.0]))
def test_no_tick_comes_twice_early_or_never(times, hz):
    schedule = TickSchedule(hz)
    now, handed = 0, []
    for time in sorted(times):
        now = time
        due = schedule.due(now)
        if due is not None:
            assert due <= now < due + schedule.period_ns
            handed.append(due)
    assert handed == sorted(set(handed))
    boundaries = now // schedule.period_ns + 1
    assert len(handed) + schedule.coalesced == boundaries


@given(st.integers(0, 10**15), st.floats(0.1, 50.0), st.integers(0, 10**12))
def test_a_paced_clock_and_its_inverse_agree(origin, pace, session):
    clock = PacedClock(origin, pace)
    assert abs(clock.session_ns(clock.monotonic_ns(session)) - session) <= pace + 1


def test_session_time_does_not_begin_before_the_origin():
    assert PacedClock(5 * S).session_ns(3 * S) == 0


def test_lockstep_time_is_the_newest_capture_time():
    clock = FrameClock()
    assert [clock.advance(capture) for capture in (3, 1, 7, 7, 2)] == [3, 3, 7, 7, 7]


def test_a_pacer_lets_frames_go_at_their_wall_time():
    pacer = Pacer(2.0)
    assert pacer.wait_ns(0, 100 * S) == 0
    assert pacer.wait_ns(1 * S, 100 * S) == S // 2


def test_a_late_frame_does_not_hurry_those_after_it():
    pacer = Pacer(1.0)
    pacer.wait_ns(0, 0)
    assert pacer.wait_ns(1 * S, 5 * S) == 0
    assert pacer.wait_ns(2 * S, 5 * S) == 1 * S


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 16)), min_size=1))
def test_in_lockstep_a_message_is_logged_at_its_capture_time_though_others_were_heard_two_seconds_ahead(heard):
    """Each component says its next frame; nobody is heard more than 16 frames before another."""
    times, said = LogTimes(), dict.fromkeys("abc", 0)
    for name, frames in heard:
        for _ in range(frames):
            if said[name] < min(said.values()) + 16:
                capture_ns = said[name] * S // 8
                assert times.log_ns(name, 1, capture_ns) == capture_ns
                said[name] += 1


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(1, 3), st.integers(0, 20 * S)), min_size=1))
def test_log_time_keeps_the_order_of_each_channel_and_lags_by_no_more_than_the_skew(heard):
    times, logged, newest = LogTimes(), {}, 0
    for name, run, capture_ns in heard:
        log_ns = times.log_ns(name, run, capture_ns)
        newest = max(newest, log_ns)
        assert log_ns >= capture_ns
        assert log_ns >= logged.get((name, run), 0)
        assert log_ns >= newest - LOG_SKEW_NS
        logged[name, run] = log_ns


def test_a_new_epoch_is_logged_after_everything_before_it():
    times = LogTimes()
    first = [times.log_ns("a", 1, k * S) for k in range(60)]
    second = [times.log_ns(name, 2, k * S) for k in range(60) for name in "ab"]
    assert first == [k * S for k in range(60)]
    assert set(second) == {59 * S}
    assert times.log_ns("a", 2, 60 * S) == 60 * S
