"""When a component is started again."""

from runtime.restart import Restarts


def test_never_means_never():
    assert Restarts("never", 3).delay_s(1) is None


def test_on_failure_means_an_exit_code_that_is_not_zero():
    assert Restarts("on-failure", 3).delay_s(0) is None
    assert Restarts("on-failure", 3).delay_s(-9) == 0.2
    assert Restarts("always", 3).delay_s(0) == 0.2


def test_each_restart_waits_twice_as_long_up_to_a_limit():
    restarts = Restarts("always", 7)
    assert [restarts.delay_s(1) for _ in range(8)] == [0.2, 0.4, 0.8, 1.6, 3.2, 5.0, 5.0, None]
