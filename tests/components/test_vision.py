"""The eyes against the true projection, disturbances on."""

import cv2
import numpy as np
import pytest

from benchmarks.scenes import Room, decoded
from components.simulator.paint import Painter
from components.simulator.params import Params as WorldParams
from components.simulator.sensor import Sensor
from components.vision.component import Vision
from components.vision.core import Eyes
from components.vision.params import Params
from docking.angles import DEG
from runtime.contract import STOP, Event
from schemas.image_pb2 import CompressedImage
from tests.components import ray_caster

PAINTERS: dict[int, tuple[WorldParams, Painter, Sensor]] = {}


def photo(pose, motion=(0.0, 0.0), frame=0, width=320):
    """JPEG and camera of a robot at (beta, alpha, d, pan, tilt), turned away from the object by pan and tilt."""
    if width not in PAINTERS:
        params = WorldParams(width_px=width)
        PAINTERS[width] = params, Painter(params), Sensor(params, 1)
    params, painter, sensor = PAINTERS[width]
    camera = ray_caster.camera_at(params, *pose)
    generator = np.random.default_rng([1, frame])
    return sensor.expose(painter.image(camera, np.zeros(3)), np.array(motion), generator), camera


def seen(data, **params):
    """The view of a JPEG."""
    (output,) = Vision(Params(**params), 0).handle(Event(0, "image", CompressedImage(data=data), 0))
    return output.message


def jpeg(image):
    return cv2.imencode(".jpg", image)[1].tobytes()


def poses(count, nearest_m, farthest_m=2.0, widest=65 * DEG):
    """Robots that look nearly at the object: (pose, motion), every third image blurred."""
    rng = np.random.default_rng(11)
    for number in range(count):
        beta, d = rng.uniform(-widest, widest), rng.uniform(nearest_m, farthest_m)
        pan, tilt = rng.uniform(-0.1, 0.1), rng.uniform(-0.07, 0.07)
        motion = rng.uniform(-3, 3, 2) if number % 3 == 0 else np.zeros(2)
        yield (beta, 0.0, d, pan, tilt), motion


def object_errors(count, nearest_m, truth):
    errors = []
    for number, (pose, motion) in enumerate(poses(count, nearest_m)):
        data, camera = photo(pose, motion, number)
        view = seen(data)
        assert view.object_visible
        errors.append(np.hypot(*(np.array((view.object_u_px, view.object_v_px)) - truth(camera))))
    return np.array(errors)


def test_the_median_is_that_of_the_objects_outline():
    errors = object_errors(120, 0.27, lambda camera: ray_caster.middle(ray_caster.object_mask(WorldParams(), camera)))
    assert np.median(errors) < 0.6
    assert np.percentile(errors, 95) < 1.2


def test_far_off_the_median_is_the_projection_of_the_objects_centre():
    errors = object_errors(200, 0.7, lambda camera: camera.project(np.zeros((1, 3)))[0])
    assert np.median(errors) < 1.0
    assert np.percentile(errors, 95) < 2.0


def test_near_by_the_median_lies_above_the_projection_of_the_centre_by_perspective_alone():
    """The nearer upper half looks larger. At the pick-up pose this is 4 px, 0.6 deg: the goal has to be shown."""
    data, camera = photo((0.0, 0.0, 0.28, 0.0, 0.0))
    view, outline = seen(data), ray_caster.middle(ray_caster.object_mask(WorldParams(), camera))
    assert outline[1] == pytest.approx(-4.2, abs=1.0)
    assert (view.object_u_px, view.object_v_px) == pytest.approx(outline, abs=0.8)


def test_the_edge_is_the_projection_of_the_stripes_middle():
    angles, rows = [], []
    for number, (pose, motion) in enumerate(poses(250, 0.27)):
        data, camera = photo(pose, motion, number)
        view = seen(data)
        assert view.edge_visible
        row, slope = ray_caster.stripe_line(WorldParams(), camera, view.object_u_px)
        angles.append(np.arctan(view.edge_slope) - np.arctan(slope))
        rows.append(view.edge_v_px - row)
    angles = np.array(angles) / DEG
    assert np.percentile(np.abs(angles), 95) < 0.1
    assert np.abs(angles).max() < 0.3
    assert abs(angles.mean()) < 0.02
    assert np.percentile(np.abs(rows), 95) < 1.0


@pytest.mark.parametrize("beta_deg", [-75, -70, 65, 70, 75])
@pytest.mark.parametrize("d", [0.4, 0.8, 1.5])
def test_steep_edges_are_not_pulled_level(beta_deg, d):
    data, camera = photo((beta_deg * DEG, 0.0, d, 0.0, 0.0))
    view = seen(data)
    _, slope = ray_caster.stripe_line(WorldParams(), camera, view.object_u_px)
    assert np.arctan(view.edge_slope) == pytest.approx(np.arctan(slope), abs=0.25 * DEG)


def test_the_mirrored_image_gives_the_mirrored_view():
    image = cv2.imdecode(np.frombuffer(photo((0.5, 0.0, 1.0, 0.05, 0.0))[0], np.uint8), cv2.IMREAD_COLOR)
    eyes = Vision(Params(), 0)._eyes
    spot, border = eyes.look(image)
    mirrored_spot, mirrored_border = eyes.look(np.ascontiguousarray(image[:, ::-1]))
    assert mirrored_spot.u_px == pytest.approx(-spot.u_px, abs=1e-9)
    assert mirrored_spot.v_px == pytest.approx(spot.v_px, abs=1e-9)
    assert mirrored_border.slope == pytest.approx(-border.slope, abs=1e-3)


def test_a_larger_image_gives_larger_pixels_and_the_same_slope():
    pose = (0.5, 0.0, 1.0, 0.05, 0.02)
    small = seen(photo(pose)[0])
    large = seen(photo(pose, width=640)[0], width_px=640, height_px=480)
    assert large.object_u_px == pytest.approx(2 * small.object_u_px, abs=1.5)
    assert large.object_v_px == pytest.approx(2 * small.object_v_px, abs=1.5)
    assert large.object_pixels == pytest.approx(4 * small.object_pixels, rel=0.1)
    assert large.edge_slope == pytest.approx(small.edge_slope, abs=3e-3)


def scene_of(*rectangles):
    """A grey image with coloured rectangles (colour, left, top, right, bottom)."""
    image = np.full((240, 320, 3), 120, np.uint8)
    image[::7, ::5] = 126
    for colour, left, top, right, bottom in rectangles:
        image[top:bottom, left:right] = colour
    return jpeg(image)


GREEN, ORANGE = (58, 152, 30), (22, 122, 242)


def test_half_an_object_is_seen_where_its_visible_half_is():
    view = seen(scene_of((GREEN, 300, 100, 320, 140)))
    assert view.object_visible
    assert view.object_u_px == pytest.approx(309.5 - 159.5, abs=1)
    assert view.object_v_px == pytest.approx(0, abs=1)
    assert not view.edge_visible


def test_the_largest_patch_is_the_object_whatever_else_is_green():
    specks = [(GREEN, x, y, x + 4, y + 4) for x in range(10, 300, 40) for y in (20, 60, 200)]
    view = seen(scene_of(*specks, (GREEN, 140, 90, 180, 150)))
    assert (view.object_u_px, view.object_v_px) == pytest.approx((0.0, 0.0), abs=1)
    assert view.object_pixels == pytest.approx(40 * 60, rel=0.1)


@pytest.mark.parametrize(
    ("top", "is_object"), [(130, True), (100, True), (80, False)]
)  # the foot 14, 44 and 64 px above the stripe's middle
def test_what_stands_far_from_the_edge_for_its_size_is_not_the_object(top, is_object):
    view = seen(scene_of((GREEN, 150, top, 166, top + 20), (ORANGE, 0, 160, 320, 168)))
    assert view.object_visible == is_object
    assert view.edge_v_px == pytest.approx(163.5 - 119.5, abs=0.6)


def crossed(rectangle, start, end):
    """A scene with a thing and an orange stripe from a point to another."""
    image = decoded(scene_of(rectangle)).copy()
    cv2.line(image, start, end, ORANGE, 8)
    return jpeg(image)


def test_the_way_to_a_steep_edge_is_measured_across_it():
    view = seen(crossed((GREEN, 200, 20, 220, 50), (160, 239), (240, 0)))
    assert view.edge_slope == pytest.approx(-3.0, abs=0.1)
    assert view.object_visible
    view = seen(crossed((GREEN, 185, 20, 205, 35), (160, 239), (240, 0)))
    assert view.edge_v_px + 119.5 - 35 > 3.0 * 20, "far below it"
    assert view.object_visible, "but near beside it"


def test_an_edge_without_an_object_is_told_at_the_middle_column():
    view = seen(crossed((GREEN, 10, 10, 30, 30), (0, 140), (319, 220)))
    assert not view.object_visible
    assert view.edge_v_px == pytest.approx(180 - 119.5, abs=1.0)


def test_small_things_need_an_edge_to_be_told_by():
    small, large = (GREEN, 100, 100, 108, 110), (GREEN, 100, 100, 110, 112)
    assert not seen(scene_of(small)).object_visible
    assert seen(scene_of(large)).object_visible
    assert seen(scene_of(small, (ORANGE, 0, 116, 320, 124))).object_visible


def test_in_a_room_with_a_vivid_green_thing_of_a_centimetre_there_is_no_object():
    room, eyes, blind = Room(WorldParams()), Eyes(Params()), Eyes(Params(object_gap_max=1e3, object_lone_pixels_min=1))
    images = [decoded(view.data) for view in room.empty_views(120, seed=29)]
    assert not any(eyes.look(image).spot for image in images)
    assert any(blind.look(image).spot for image in images), "the scenes would show it"


def test_the_longest_stripe_is_the_edge_whatever_else_is_orange():
    view = seen(scene_of((ORANGE, 0, 160, 320, 168), (ORANGE, 30, 30, 60, 50), (ORANGE, 200, 120, 215, 130)))
    assert view.edge_visible
    assert view.edge_slope == pytest.approx(0, abs=1e-3)
    assert view.edge_v_px == pytest.approx(163.5 - 119.5, abs=0.6)


def test_a_thing_that_touches_the_stripe_does_not_tilt_it():
    view = seen(scene_of((ORANGE, 0, 160, 320, 168), (ORANGE, 250, 130, 290, 162)))
    assert view.edge_slope == pytest.approx(0, abs=5e-3)


def test_a_vertical_stripe_has_no_slope_and_breaks_nothing():
    view = seen(scene_of((ORANGE, 100, 0, 108, 240)))
    assert not view.edge_visible or abs(view.edge_slope) > 100


@pytest.mark.parametrize(
    "rectangle",
    [(GREEN, 100, 100, 103, 103), (ORANGE, 100, 100, 110, 104), ((90, 126, 98), 100, 100, 200, 200)],
)
def test_tiny_and_dull_things_are_nothing(rectangle):
    view = seen(scene_of(rectangle))
    assert not view.object_visible
    assert not view.edge_visible
    assert view.fault == ""


def test_an_empty_wall_shows_nothing():
    view = seen(photo((0.0, 0.0, 1.5, 1.5, 0.0))[0])
    assert not view.object_visible
    assert view.fault == ""


@pytest.mark.parametrize("level", [0, 255])
def test_a_black_or_a_white_image_shows_nothing_and_says_why(level):
    view = seen(jpeg(np.full((240, 320, 3), level, np.uint8)))
    assert not view.object_visible
    assert not view.edge_visible
    assert "one colour" in view.fault


@pytest.mark.parametrize("colour", [GREEN, ORANGE])
def test_an_image_full_of_one_target_colour_breaks_nothing(colour):
    image = np.full((240, 320, 3), colour, np.uint8)
    image[-1, ::9] = 200
    view = seen(jpeg(image))
    assert not view.edge_visible or np.isfinite(view.edge_slope)


@pytest.mark.parametrize(("brightness", "visible"), [(0.0, False), (0.6, True), (1.5, True)])
def test_light_matters_little(brightness, visible):
    params = WorldParams(brightness=brightness)
    camera = ray_caster.camera_at(params, 0.3, 0.0, 1.0)
    clean = Painter(params).image(camera, np.zeros(3))
    view = seen(Sensor(params, 1).expose(clean, np.zeros(2), np.random.default_rng(0)))
    assert (view.object_visible, view.edge_visible) == (visible, visible)


def test_every_image_gets_exactly_one_view_and_nothing_else_any():
    eyes = Vision(Params(), 0)
    data, _ = photo((0.0, 0.0, 1.0, 0.0, 0.0))
    outputs = [eyes.handle(Event(0, "image", CompressedImage(data=d), 5)) for d in (data, b"", data[:99], data)]
    assert [[output.port for output in each] for each in outputs] == [["view"]] * 4
    assert outputs[0] == outputs[3]
    assert eyes.handle(Event(0, STOP)) == ()


def test_random_noise_breaks_nothing():
    rng = np.random.default_rng(0)
    for _ in range(20):
        view = seen(jpeg(rng.integers(0, 255, (240, 320, 3), np.uint8)))
        assert not view.edge_visible or np.isfinite(view.edge_slope)
