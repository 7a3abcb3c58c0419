"""The bad radio between two machines, as far as it computes."""

from benchmarks.wire import GOOD, Packets, Quality

COUNT = 4000


def carried(quality):
    """(end, packet, delay in s) of packets sent every ms, in order of arrival."""
    packets, arrived = Packets(1), []
    packets.quality = quality
    for k in range(COUNT):
        packets.enter(k % 2, k.to_bytes(2, "big"), k / 1000)
        arrived += [(end, data, k / 1000) for end, data in packets.leave(k / 1000)]
    return arrived + [(end, data, COUNT / 1000) for end, data in packets.leave(COUNT)]


def test_a_good_wire_delivers_everything_at_once():
    arrived = carried(GOOD)
    assert [int.from_bytes(data, "big") for _, data, _ in arrived] == list(range(COUNT))
    assert all(end == int.from_bytes(data, "big") % 2 for end, data, _ in arrived)


def test_a_bad_one_loses_its_share_and_keeps_the_order_of_each_direction():
    arrived = carried(Quality(loss=0.05, jitter_s=0.05))
    assert 0.04 < 1 - len(arrived) / COUNT < 0.06
    for way in (0, 1):
        numbers = [int.from_bytes(data, "big") for end, data, _ in arrived if end == way]
        assert numbers == sorted(numbers)


def test_no_packet_is_delayed_by_more_than_the_jitter():
    packets = Packets(1)
    packets.quality = Quality(jitter_s=0.05)
    for k in range(COUNT):
        now_s = k / 1000
        packets.enter(0, b"", now_s)
        due_s = packets.due_s()
        assert due_s is not None
        packets.leave(now_s)
    assert len(packets.leave(now_s + 0.0501)) > 0
    assert packets.due_s() is None
