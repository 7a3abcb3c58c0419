"""`berth import`: bags and folders of others become sessions; what is wrong with them is one line."""

import json

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cli.intake import bag, ros2
from cli.intake.picture import PictureError, Raw, announced, as_jpeg, fitting
from components.vision import jpeg
from runtime.recording import Recording
from tests.cli import bags
from tests.cli.bags import EPOCH_S, compressed, odometry, raw, write

GENERATOR = np.random.default_rng(4)
SMOOTH = cv2.GaussianBlur(GENERATOR.integers(0, 256, (240, 320, 3), dtype=np.uint8), (0, 0), 8)
"""Blue, green, red, without sharp edges: JPEG changes it little."""
JPEG = cv2.imencode(".jpg", SMOOTH)[1].tobytes()
CAMERA = "/camera/image_raw/compressed"


def decoded(session, topic):
    return [(logged.capture_ns, logged.decoded()) for logged in Recording(session).messages({topic})]


def pixels(data: bytes):
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR).astype(int)


@pytest.mark.parametrize("words", ["ros2msg", "ros2idl"])
@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_a_bag_of_jpegs_keeps_their_bytes_and_times(run, tmp_path, words, compression):
    images = [(CAMERA, compressed(EPOCH_S + 0.125 * i, JPEG)) for i in range(5)]
    source = write(tmp_path / "bag.mcap", images, words=words, compression=compression)
    session = tmp_path / "session.mcap"
    code, out, _ = run("import", source, "-o", session, "--json")
    assert (code, json.loads(out)["images"], json.loads(out)["size_px"]) == (0, 5, "320x240")
    frames = decoded(session, "camera/image")
    assert {message.data for _, message in frames} == {JPEG}
    assert np.diff([capture_ns for capture_ns, _ in frames]).tolist() == [125_000_000] * 4


def test_the_eyes_run_over_an_imported_session_and_the_doctor_finds_nothing(run, tmp_path):
    source = write(tmp_path / "bag.mcap", [(CAMERA, compressed(EPOCH_S + i, JPEG)) for i in range(300)])
    session, seen = tmp_path / "session.mcap", tmp_path / "seen.mcap"
    assert run("import", source, "-o", session)[0] == 0
    assert run("doctor", session)[0] == 0
    _, out, _ = run("replay", session, "--component", "vision", "-o", seen, "--json")
    assert json.loads(out)["outputs"] == {"vision/view": 300}
    assert {message.fault for _, message in decoded(seen, "vision/view")} == {""}


def test_odometry_becomes_the_bases_readings(run, tmp_path):
    poses = [(1.0, 2.0, 0.5, 0.1, 0.2), (-3.0, 0.0, -2.5, -0.2, 0.0)]
    messages = [("/odom", odometry(EPOCH_S + i, *pose)) for i, pose in enumerate(poses)]
    source = write(tmp_path / "bag.mcap", [*messages, (CAMERA, compressed(EPOCH_S + 0.5, JPEG))])
    session = tmp_path / "session.mcap"
    run("import", source, "-o", session)
    states = [message for _, message in decoded(session, "base/state")]
    read = [(s.odometry_x_m, s.odometry_y_m, s.odometry_heading_rad, s.v_mps, s.omega_radps) for s in states]
    assert read == [pytest.approx(pose) for pose in poses]


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [
        ("bgr8", SMOOTH),
        ("rgb8", SMOOTH[..., ::-1]),
        ("bgra8", np.dstack([SMOOTH, np.full(SMOOTH.shape[:2], 255, np.uint8)])),
        ("rgba8", np.dstack([SMOOTH[..., ::-1], np.full(SMOOTH.shape[:2], 7, np.uint8)])),
    ],
)
def test_raw_images_keep_their_colours(encoding, shown):
    _, data = as_jpeg(Raw(320, 240, encoding, shown[0].size, np.ascontiguousarray(shown).tobytes()))
    assert np.abs(pixels(data) - SMOOTH).mean() < 3.0


@pytest.mark.parametrize("colour", ["red", "green", "blue"])
@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_each_bayer_pattern_shows_the_colour_whose_cells_are_lit(pattern, colour):
    cells = np.array([255 if letter == colour[0] else 0 for letter in pattern], np.uint8).reshape(2, 2)
    mosaic = np.tile(cells, (120, 160))
    _, data = as_jpeg(Raw(320, 240, f"bayer_{pattern}8", 320, mosaic.tobytes()))
    expected = [255 if name == colour else 0 for name in ("blue", "green", "red")]
    assert np.abs(pixels(data)[20:-20, 20:-20].mean(axis=(0, 1)) - expected).max() < 12


@pytest.mark.parametrize(("encoding", "order"), [("yuv422", (1, 0)), ("yuv422_yuy2", (0, 1))])
def test_both_orders_of_yuv_give_grey_for_grey(encoding, order):
    pairs = np.zeros((240, 320, 2), np.uint8)
    pairs[..., order[0]], pairs[..., order[1]] = SMOOTH[..., 1], 128
    _, data = as_jpeg(Raw(320, 240, encoding, 640, pairs.tobytes()))
    image = pixels(data)
    assert np.ptp(image, axis=2).max() < 10
    assert np.corrcoef(image[..., 1].ravel(), SMOOTH[..., 1].ravel())[0, 1] > 0.95


def test_padding_at_the_end_of_rows_is_left_out():
    padded = np.hstack([SMOOTH.reshape(240, -1), np.full((240, 32), 99, np.uint8)])
    assert as_jpeg(Raw(320, 240, "bgr8", 992, padded.tobytes())) == as_jpeg(
        Raw(320, 240, "bgr8", 960, SMOOTH.tobytes())
    )


@pytest.mark.parametrize(
    ("size", "down", "fitted"),
    [((320, 240), 1, (320, 240)),
     ((641, 485), 1, (640, 480)), ((4000, 3000), 3, (1328, 1000)), ((2000, 100), 2, (1000, 48))],
)  # fmt: skip
def test_the_size_is_one_that_the_eyes_take(size, down, fitted):
    assert fitting(size) == (down, fitted)


def test_a_progressive_or_grey_jpeg_or_a_png_is_made_a_baseline_one():
    progressive = cv2.imencode(".jpg", SMOOTH, [cv2.IMWRITE_JPEG_PROGRESSIVE, 1])[1].tobytes()
    grey = cv2.imencode(".jpg", SMOOTH[..., 1])[1].tobytes()
    png = cv2.imencode(".png", SMOOTH)[1].tobytes()
    for data in (progressive, grey, png):
        size, made = as_jpeg(data)
        assert jpeg.decode(made, *size).shape == (240, 320, 3)


def test_a_thumbnail_within_a_jpeg_is_not_taken_for_it():
    small = cv2.imencode(".jpg", SMOOTH[:64, :64])[1].tobytes()
    exif = b"\xff\xe1" + (len(small) + 8).to_bytes(2, "big") + b"Exif\0\0" + small
    assert announced(JPEG[:2] + exif + JPEG[2:]) == (320, 240)


def test_a_folder_is_read_in_the_order_of_its_numbers(run, tmp_path):
    folder = tmp_path / "images"
    folder.mkdir()
    for number in (10, 9, 1):
        (folder / f"f{number}.png").write_bytes(
            cv2.imencode(".png", np.full((48, 64, 3), 20 * number, np.uint8))[1].tobytes()
        )
    (folder / "notes.txt").write_text("no image", encoding="utf-8")
    session = tmp_path / "session.mcap"
    code, out, _ = run("import", folder, "-o", session, "--hz", "4", "--json")
    frames = decoded(session, "camera/image")
    assert (code, json.loads(out)["session_s"]) == (0, 0.5)
    assert [round(pixels(message.data).mean() / 20) for _, message in frames] == [1, 9, 10]


def test_a_bag_in_pieces_is_read_in_order(run, tmp_path):
    folder = tmp_path / "bag"
    folder.mkdir()
    for piece in (0, 1, 10):
        write(folder / f"bag_{piece}.mcap", [(CAMERA, compressed(EPOCH_S + piece + 0.1 * i, JPEG)) for i in range(2)])
    code, out, _ = run("import", folder, "-o", tmp_path / "session.mcap", "--json")
    assert (code, json.loads(out)["images"], json.loads(out)["session_s"]) == (0, 6, 10.1)


def test_what_can_not_be_used_is_counted_by_its_reason(run, tmp_path):
    messages = [
        (CAMERA, compressed(EPOCH_S + 1, JPEG)),
        (CAMERA, compressed(EPOCH_S + 1, JPEG)),
        (CAMERA, compressed(EPOCH_S + 2, b"GIF89a nothing")),
        (CAMERA, compressed(EPOCH_S + 3, JPEG[:300])),
        (CAMERA, compressed(EPOCH_S + 4, cv2.imencode(".jpg", SMOOTH[:120])[1].tobytes())),
        (CAMERA, (bags.COMPRESSED, b"\x00\x01\x00\x00\xff\xff")),
        (CAMERA, raw(EPOCH_S + 5, SMOOTH, "bgr8")),
        (CAMERA, odometry(EPOCH_S + 5, 0, 0, 0)),
        (CAMERA, compressed(EPOCH_S + 6, JPEG)),
    ]
    session = tmp_path / "session.mcap"
    code, out, _ = run("import", write(tmp_path / "bag.mcap", messages), "-o", session, "--json")
    table = json.loads(out)
    assert (code, table["images"], sum(table["skipped"].values())) == (3, 3, 6)
    assert {"not later than the one before", "neither JPEG nor PNG", "another size than the first", "damaged CDR",
            "another type on the same topic"} <= set(table["skipped"])  # fmt: skip


HUGE = {"width": 2**31, "height": 2**31, "step": 0, "data": np.zeros(0, np.uint8)}


@pytest.mark.parametrize(
    ("messages", "words"),
    [
        ([("/odom", odometry(EPOCH_S, 0, 0, 0))], "it holds none"),
        ([("/a", compressed(EPOCH_S, JPEG)), ("/b", compressed(EPOCH_S, JPEG))], "--image must be given"),
        ([("/a", raw(EPOCH_S, SMOOTH, "bgr8", **HUGE))], "1 an absurd size"),
        ([("/a", raw(EPOCH_S, SMOOTH, "bgr8", width=10_000))], "1 an absurd size"),
        ([("/a", raw(EPOCH_S, SMOOTH, "bgr8", height=241))], "1 data that does not fit its size"),
        ([("/a", raw(EPOCH_S, SMOOTH, "rainbow"))], "unknown encoding 'rainbow'"),
        ([("/a", raw(EPOCH_S, SMOOTH[:8, :8], "bgr8"))], "smaller than 64x48 px"),
        ([("/a", (bags.COMPRESSED, b""))], "1 not plain CDR"),
    ],
)
def test_a_bag_without_a_usable_image_is_refused_in_one_line_and_nothing_is_made(run, tmp_path, messages, words):
    session = tmp_path / "session.mcap"
    code, out, err = run("import", write(tmp_path / "bag.mcap", messages), "-o", session)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert words in err
    assert not session.exists()


@pytest.mark.parametrize("content", [b"", b"text", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n" + b"\xff" * 40])
def test_what_is_no_bag_is_refused_in_one_line(run, tmp_path, content):
    (tmp_path / "bag.mcap").write_bytes(content)
    code, _, err = run("import", tmp_path / "bag.mcap", "-o", tmp_path / "session.mcap")
    assert (code, err.count("\n")) == (2, 1)


def test_missing_empty_and_foreign_sources_are_refused_in_one_line(run, tmp_path):
    (tmp_path / "empty").mkdir()
    (tmp_path / "old.db3").write_bytes(b"SQLite format 3\0")
    for source in ("nowhere.mcap", "empty", "old.db3"):
        code, _, err = run("import", tmp_path / source, "-o", tmp_path / "session.mcap")
        assert (code, err.count("\n")) == (2, 1), err


def test_a_session_is_never_overwritten(run, tmp_path):
    session = tmp_path / "session.mcap"
    session.write_bytes(b"mine")
    source = write(tmp_path / "bag.mcap", [(CAMERA, compressed(EPOCH_S, JPEG))])
    assert run("import", source, "-o", session)[0] == 2
    assert session.read_bytes() == b"mine"


def test_a_torn_bag_gives_what_it_holds_and_says_so(run, tmp_path):
    noisy = [cv2.imencode(".jpg", GENERATOR.integers(0, 256, (240, 320, 3), dtype=np.uint8))[1].tobytes()
             for _ in range(40)]  # fmt: skip
    source = write(tmp_path / "bag.mcap", [(CAMERA, compressed(EPOCH_S + i, data)) for i, data in enumerate(noisy)])
    source.write_bytes(source.read_bytes()[:-400_000])
    code, out, _ = run("import", source, "-o", tmp_path / "session.mcap", "--json")
    table = json.loads(out)
    assert code == 3
    assert 0 < table["images"] < 40
    assert table["faults"]


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_no_bytes_of_a_message_are_more_than_undecodable(data):
    name, whole = data.draw(st.sampled_from([compressed(1.0, b"12345"), raw(1.0, SMOOTH[:2, :2], "bgr8"),
                                             odometry(1.0, 0, 0, 0)]))  # fmt: skip
    damaged = bytearray(whole[: data.draw(st.integers(0, len(whole)))])
    for place, value in data.draw(st.lists(st.tuples(st.integers(0, 10**4), st.integers(0, 255)), max_size=4)):
        if damaged:
            damaged[place % len(damaged)] = value
    try:
        message = ros2.decoder_of(name)(bytes(damaged))
    except ros2.UndecodableError:
        return
    assert message.header.stamp.sec is not None


@settings(max_examples=100, deadline=None)
@given(cut=st.integers(0, len(JPEG)), flips=st.lists(st.tuples(st.integers(0, 700), st.integers(0, 255)), max_size=3))
def test_a_damaged_picture_is_a_picture_or_a_reason(cut, flips):
    damaged = bytearray(JPEG[:cut])
    for place, value in flips:
        if damaged:
            damaged[place % len(damaged)] = value
    try:
        size, made = as_jpeg(bytes(damaged))
    except PictureError:
        return
    assert announced(made) == size


def test_names_of_either_language_are_the_same_type():
    names = ("sensor_msgs/Image", "sensor_msgs/msg/Image", "sensor_msgs::msg::Image", "sensor_msgs::msg::dds_::Image")
    assert [ros2.plain_name(name) for name in names[:3]] == [ros2.RAW] * 3
    assert ros2.plain_name(names[3]) != ros2.RAW


def test_the_named_topic_of_several_is_taken(tmp_path):
    messages = [(topic, compressed(EPOCH_S, JPEG)) for topic in ("/a", "/b")]
    source = write(tmp_path / "bag.mcap", messages)
    topics = bag.topics_of([source])
    assert bag.chosen(topics, "/b", "", source) == {"/b": ros2.COMPRESSED}
