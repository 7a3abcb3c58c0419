"""Keys, tokens, ids and attachments against what rmw_zenoh and zenoh-bridge-ros2dds document and show."""

import struct

import pytest

from components.base.ports import Ros2
from components.base.ros2.bridge import bridge_of
from components.base.ros2.client import Client
from components.base.ros2.rmw_zenoh import RmwZenoh, gid
from components.base.ros2.topic import Topic, absolute

CHATTER = Topic("/chatter", "std_msgs/msg/String")
STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
LISTENER = "aac3178e146ba6f1fc6e6a4085e77f21"
"""Session of the listener in rmw_zenoh's design.md."""


def listener(distro="jazzy", namespace=""):
    return RmwZenoh(0, distro, namespace, "listener", LISTENER)


def test_a_topic_s_key_is_that_of_rmw_zenoh_s_design():
    assert listener().key(CHATTER) == f"0/chatter/std_msgs::msg::dds_::String_/{STRING}"


def test_humble_knows_no_hashes():
    assert listener("humble").key(CHATTER) == "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"


def test_tokens_are_those_of_rmw_zenoh_s_design():
    """Of the two entities there; numbers are ours to give."""
    node, publisher, subscription = listener().tokens([CHATTER], [CHATTER])
    end = f"%/%/listener/%chatter/std_msgs::msg::dds_::String_/{STRING}/::,10:,:,:,,"
    assert node == f"@ros2_lv/0/{LISTENER}/0/0/NN/%/%/listener"
    assert publisher == f"@ros2_lv/0/{LISTENER}/0/1/MP/{end}"
    assert subscription == f"@ros2_lv/0/{LISTENER}/0/2/MS/{end}"


def test_a_node_s_namespace_is_mangled_in_its_token():
    assert listener(namespace="/fleet/robot1").tokens([CHATTER], [])[0].endswith("/NN/%/%fleet%robot1/listener")


def test_an_entity_s_id_is_what_rmw_zenoh_s_own_hash_gives():
    """The talker's token of design.md through its simplified_xxhash3.cpp, compiled."""
    token = ("@ros2_lv/0/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/"
             f"std_msgs::msg::dds_::String_/{STRING}/::,7:,:,:,,")  # fmt: skip
    assert gid(token).hex() == "eb85fa883b7846dc448a4501890ad062"


def test_an_attachment_is_number_time_length_and_id_of_the_publisher():
    bridge = listener()
    _, publisher = bridge.tokens([CHATTER], [])
    attachment = bridge.attachment(3, 1_700_000_000_000_000_001)
    assert len(attachment) == 33
    assert struct.unpack("<qqB", attachment[:17]) == (3, 1_700_000_000_000_000_001, 16)
    assert attachment[17:] == gid(publisher)


def test_over_dds_the_name_is_the_key_and_nothing_is_attached():
    bridge = bridge_of(Ros2(), "ab12")
    assert bridge.key(Topic("/robot1/cmd_vel", "geometry_msgs/msg/Twist")) == "robot1/cmd_vel"
    assert bridge.attachment(1, 2) is None
    assert bridge.tokens([CHATTER], [CHATTER]) == ()


@pytest.mark.parametrize(
    ("namespace", "name", "whole"),
    [("", "odom", "/odom"), ("robot1", "odom", "/robot1/odom"), ("/a/b", "odom", "/a/b/odom"), ("a", "/odom", "/odom")],
)
def test_a_namespace_stands_before_every_name_that_is_not_absolute(namespace, name, whole):
    assert absolute(namespace, name) == whole


def test_messages_of_one_publisher_are_numbered_without_a_hole_from_1():
    client = Client(Ros2(bridge="rmw_zenoh"), "ab12", 0)
    samples = [client.sample(k * 10**9, 0) for k in range(3)] + list(client.farewell(0))
    assert [struct.unpack_from("<q", each.attachment)[0] for each in samples] == list(range(1, 9))
