"""Our CDR against Cyclone DDS's, byte for byte, and what is no message is refused."""

import dataclasses
import random
import struct

import pytest

from components.base.ports import Ros2
from components.base.ros2 import codec, twist
from components.base.ros2.bumper import Bumper, Contact
from components.base.ros2.codec import MalformedError
from components.base.ros2.odometry import odometry_of
from tests.ros2 import messages
from tests.ros2.messages import HASHES

TYPES = {
    codec.TWIST: messages.Twist,
    codec.TWIST_STAMPED: messages.TwistStamped,
    codec.ODOMETRY: messages.Odometry,
    codec.BATTERY: messages.BatteryState,
    codec.BOOL: messages.Bool,
    codec.KOBUKI: messages.BumperEvent,
    codec.HAZARDS: messages.HazardDetectionVector,
}
EACH = 1000
TEXTS = ("", "odom", "base_link", "Bücher", "x" * 41)
NUMBERS = {"int32": (-(2**31), 2**31 - 1), "uint32": (0, 2**32 - 1), "uint8": (0, 255)}


def random_float(rng, width):
    """Any bits that are a number, and sometimes an infinity."""
    form = {8: "d", 4: "f"}[width]
    value = struct.unpack(form, rng.randbytes(width))[0]
    return value if value == value else rng.choice((0.0, -0.0, float("inf")))  # noqa: PLR0124  (nan)


def random_value(rng, hint):
    name = str(hint)
    if dataclasses.is_dataclass(hint):
        return hint(*(random_value(rng, field.type) for field in dataclasses.fields(hint)))
    if hint is bool:
        return rng.random() < 0.5
    if hint is str:
        return rng.choice(TEXTS)
    count, inner = of_many(rng, hint)
    if inner is not None:
        return [random_value(rng, inner) for _ in range(count)]
    for word, (low, high) in NUMBERS.items():
        if f"'{word}'" in name:
            return rng.randint(low, high)
    return random_float(rng, 4 if "float32" in name else 8)


def of_many(rng, hint):
    """(count, type of each) of an array or a sequence."""
    for note in getattr(hint, "__metadata__", ()):
        if hasattr(note, "subtype"):
            return getattr(note, "length", None) or rng.randrange(4), note.subtype
    return 0, None


def same(ours, theirs):
    """Field by field."""
    if dataclasses.is_dataclass(theirs):
        return all(same(getattr(ours, f.name), getattr(theirs, f.name)) for f in dataclasses.fields(theirs))
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    return ours == theirs


@pytest.mark.parametrize("name", TYPES)
def test_a_thousand_random_messages_of_each_type_are_the_same_bytes_in_both_codecs(name):
    rng = random.Random(7)
    for _ in range(EACH):
        theirs = random_value(rng, TYPES[name])
        payload = theirs.serialize()
        ours = codec.decoded(name, payload)
        assert same(ours, theirs)
        assert codec.encoded(name, ours) == payload


@pytest.mark.parametrize("stamped", [False, True])
def test_commands_are_read_by_the_other_codec_as_they_were_meant(stamped):
    params, rng = Ros2(stamped=stamped, max_speed_mps=2.0, max_turn_rate_radps=8.0), random.Random(8)
    for _ in range(EACH):
        v, omega, wall_ns = rng.uniform(-1, 1), rng.uniform(-3, 3), rng.randrange(2**31 * 10**9)
        payload = twist.payload(twist.limited(v, omega, params), wall_ns, params)
        said = (messages.TwistStamped if stamped else messages.Twist).deserialize(payload)
        if stamped:
            assert (said.header.stamp.sec * 10**9 + said.header.stamp.nanosec, said.header.frame_id) == (
                wall_ns, "base_link")  # fmt: skip
        inner = said.twist if stamped else said
        assert inner == messages.Twist(messages.Vector3(x=v), messages.Vector3(z=omega))


@pytest.mark.parametrize("kind", HASHES)
def test_hashes_of_types_are_those_that_robots_show(kind):
    (name,) = (name for name, each in TYPES.items() if each is kind)
    assert codec.type_hash(name) == HASHES[kind]


def spoiled(rng, payload):
    data = bytearray(payload)
    for _ in range(rng.randrange(1, 6)):
        where = rng.randrange(len(data)) if data else 0
        action = rng.randrange(3)
        if action == 0 and data:
            data[where] = rng.randrange(256)
        elif action == 1:
            del data[where:]
        else:
            data[where:where] = rng.randbytes(rng.randrange(9))
    return bytes(data)


@pytest.mark.parametrize("name", TYPES)
def test_spoiled_bytes_are_a_message_or_refused_and_nothing_else(name):
    rng = random.Random(9)
    whole = random_value(rng, TYPES[name]).serialize()
    refused = 0
    for _ in range(2000):
        try:
            codec.decoded(name, spoiled(rng, whole))
        except MalformedError:
            refused += 1
    assert refused > 100


def test_a_message_too_large_to_be_meant_is_refused_unread():
    with pytest.raises(MalformedError, match="70000 bytes"):
        codec.decoded(codec.BOOL, bytes(70000))


def odometry(x=1.0, quaternion=(0.0, 0.0, 0.6, 0.8), v=0.1, nanosec=5):
    pose = messages.Pose(messages.Point(x, 2.0, 0.0), messages.Quaternion(*quaternion))
    speed = messages.Twist(messages.Vector3(x=v), messages.Vector3(z=0.2))
    return messages.Odometry(messages.Header(messages.Time(3, nanosec), "odom"), "base_link",
                             messages.PoseWithCovariance(pose, [0.0] * 36),
                             messages.TwistWithCovariance(speed, [0.0] * 36)).serialize()  # fmt: skip


def test_odometry_is_read_with_the_heading_about_the_vertical():
    read = odometry_of(odometry())
    assert read[:2] == (1.0, 2.0)
    assert read[3:] == (0.1, 0.2, 3_000_000_005)
    assert read.heading_rad == pytest.approx(2 * 0.6435011)


@pytest.mark.parametrize(
    "absurd",
    [{"x": float("nan")}, {"x": 1e9}, {"v": 50.0}, {"v": float("inf")}, {"quaternion": (0.0, 0.0, 0.0, 0.0)},
     {"quaternion": (0.0, 0.0, float("nan"), 1.0)}, {"nanosec": 2_000_000_000}],
)  # fmt: skip
def test_odometry_that_no_robot_means_is_refused(absurd):
    with pytest.raises(MalformedError):
        odometry_of(odometry(**absurd))


def hazards(*kinds):
    header = messages.Header(messages.Time(0, 0), "base_link")
    return messages.HazardDetectionVector(header, [messages.HazardDetection(header, kind) for kind in kinds])


@pytest.mark.parametrize(
    ("kinds", "contact"),
    [((), Contact()), ((1,), Contact(front=True)), ((2,), Contact(front=True)), ((3, 0), Contact(True, True)),
     ((0,), Contact(rear=True)), ((4,), Contact(fault="a wheel hangs in the air")), ((5,), Contact())],
)  # fmt: skip
def test_hazards_of_a_create_3_forbid_the_way_that_they_are_in(kinds, contact):
    bumper = Bumper(codec.HAZARDS)
    bumper.take(hazards(*kinds).serialize())
    assert bumper.contact == contact


def test_a_kobuki_s_bumpers_hold_until_each_is_released():
    bumper, touched = Bumper(codec.KOBUKI), []
    for which, state in ((0, 1), (1, 1), (0, 0), (1, 0)):
        bumper.take(messages.BumperEvent(which, state).serialize())
        touched.append(bumper.contact.front)
    assert touched == [True, True, True, False]
    with pytest.raises(MalformedError, match="state 7"):
        bumper.take(messages.BumperEvent(0, 7).serialize())


def test_a_plain_contact_is_a_bumper():
    bumper = Bumper(codec.BOOL)
    bumper.take(messages.Bool(True).serialize())
    assert bumper.contact == Contact(front=True)
