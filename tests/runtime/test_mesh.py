"""Peers that open at the same moment all meet, and no two of them by two connections."""

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack

import zenoh

from runtime.bus import free_endpoint, open_peer, open_router
from tests.runtime.system import wait_for

PEERS = 6


def connections(session: zenoh.Session) -> Counter[str]:
    return Counter(str(link.zid) for link in session.info.links())


def test_each_two_peers_have_one_connection():
    endpoint = free_endpoint()
    with ExitStack() as sessions, ThreadPoolExecutor(PEERS) as threads:
        router = sessions.enter_context(open_router(endpoint))
        peers = [sessions.enter_context(peer) for peer in threads.map(open_peer, [endpoint] * PEERS)]
        everybody = {str(session.info.zid()) for session in (router, *peers)}
        wait_for(lambda: all({*connections(peer), str(peer.info.zid())} == everybody for peer in peers), 30)
        assert {count for peer in peers for count in connections(peer).values()} == {1}
