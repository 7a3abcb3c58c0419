"""Where a host may be reached, and what may not hold it back."""

import pytest

from runtime.link import Link, checked_link, is_loopback
from runtime.params import ConfigurationError

EVERYWHERE = "tcp/0.0.0.0:7447"


@pytest.mark.parametrize("endpoint", ["tcp/127.0.0.1:7447", "tcp/[::1]:7447", "tcp/localhost:7447", "tcp/127.1.2.3:1"])
def test_loopback_may_be_listened_on_without_a_word(endpoint):
    assert is_loopback(endpoint)
    assert checked_link(endpoint, "", insecure=False).listen == endpoint


@pytest.mark.parametrize("endpoint", [EVERYWHERE, "tcp/[::]:7447", "tcp/robot.local:7447", "tcp/192.168.1.2:7447"])
def test_anything_else_only_if_asked_for(endpoint):
    assert not is_loopback(endpoint)
    with pytest.raises(ConfigurationError, match="--listen must be on loopback, or stand with --keys"):
        checked_link(endpoint, "", insecure=False)
    assert checked_link(endpoint, "", insecure=True) == Link(endpoint)


@pytest.mark.parametrize("endpoint", ["7447", "tcp/7447", "udp/1.2.3.4:1", "tcp/127.0.0.1:7447#iface=x", "tcp/a:1?x=1"])
@pytest.mark.parametrize("option", ["--listen", "--connect"])
def test_what_is_no_endpoint_is_refused_whatever_else_is_said(endpoint, option):
    listen, connect = (endpoint, "") if option == "--listen" else ("", endpoint)
    with pytest.raises(ConfigurationError, match=f"{option} must be tcp/ADDRESS:PORT"):
        checked_link(listen, connect, insecure=True)


def test_with_security_only_tls_is_listened_on_or_dialled():
    assert checked_link("tls/0.0.0.0:7447", "", insecure=False, tls=True) == Link("tls/0.0.0.0:7447")
    for listen, connect in ((EVERYWHERE, ""), ("", EVERYWHERE), ("tcp/127.0.0.1:1", "")):
        with pytest.raises(ConfigurationError, match="must be tls/ADDRESS:PORT with security"):
            checked_link(listen, connect, insecure=False, tls=True)
    with pytest.raises(ConfigurationError, match="must be tcp/ADDRESS:PORT"):
        checked_link("tls/0.0.0.0:7447", "", insecure=True)
    with pytest.raises(ConfigurationError, match="--insecure must stand without security"):
        checked_link("tls/0.0.0.0:7447", "", insecure=True, tls=True)


def test_in_real_time_nothing_blocks_on_a_link_and_in_lockstep_nothing_is_dropped():
    assert Link().options("real") == {}
    link = Link(EVERYWHERE)
    (rule,) = link.options("real")["qos/network"]
    assert rule["overwrite"] == {"congestion_control": "drop"}
    assert "qos/network" not in link.options("lockstep")
