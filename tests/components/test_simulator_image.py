"""The rendered image against a ray caster, and the camera's faults against their definitions."""

import cv2
import numpy as np
import pytest

from components.simulator import scene
from components.simulator.clip import clipped
from components.simulator.paint import Painter
from components.simulator.params import Params
from components.simulator.sensor import Sensor, blurred
from components.simulator.world import World
from docking.angles import DEG
from docking.starts import Start
from tests.components import ray_caster

ORIGIN = np.zeros(3)
POSES = [
    (0.0, 0.0, 2.0, 0.0, 0.0),
    (0.7, 0.3, 1.0, 0.05, 0.03),
    (-1.1, -0.5, 0.6, -0.1, 0.0),
    (1.2, 0.0, 1.5, 0.1, -0.05),
    (0.0, 0.2, 0.28, 0.1, 0.1),
    (-0.4, 0.0, 0.35, -0.25, 0.0),
]


def painted(params, camera, object_m=ORIGIN):
    return Painter(params).image(camera, np.asarray(object_m)).astype(int)


def green(image):
    return image[:, :, 1] - np.maximum(image[:, :, 0], image[:, :, 2]) > 36


def orange(image):
    return (image[:, :, 2] - image[:, :, 1] > 60) & (image[:, :, 1] - image[:, :, 0] > 40)


def agree(drawn, true):
    """Equal but for a border of one pixel, where antialiasing mixes the colours."""
    ones = np.ones((3, 3), np.uint8)
    inner, outer = cv2.erode(true.astype(np.uint8), ones), cv2.dilate(true.astype(np.uint8), ones)
    return not (drawn & (outer == 0)).any() and not (~drawn & (inner == 1)).any()


@pytest.mark.parametrize("width", [320, 640])
@pytest.mark.parametrize("pose", POSES)
def test_the_object_is_where_its_rays_meet_a_cylinder(pose, width):
    params = Params(distractors=False, width_px=width)
    camera = ray_caster.camera_at(params, *pose)
    drawn, true = green(painted(params, camera)), ray_caster.object_mask(params, camera)
    assert agree(drawn, true)
    for drawn_px, true_px in zip(np.nonzero(drawn), np.nonzero(true), strict=True):
        assert drawn_px.mean() == pytest.approx(true_px.mean(), abs=0.3)


@pytest.mark.parametrize("pose", POSES)
def test_the_stripe_is_where_its_rays_meet_the_tables_edge(pose):
    params = Params(distractors=False)
    camera = ray_caster.camera_at(params, *pose)
    drawn, true = orange(painted(params, camera)), ray_caster.stripe_mask(params, camera)
    assert np.count_nonzero(true) > 300
    assert agree(drawn, true)


def test_a_lifted_object_leaves_the_table_in_the_image():
    params = Params(distractors=False)
    camera = ray_caster.camera_at(params, 0.0, 0.0, 0.28)
    lifted = (0.0, 0.0, 0.1)
    drawn, true = green(painted(params, camera, lifted)), ray_caster.object_mask(params, camera, lifted)
    assert agree(drawn, true)
    assert np.nonzero(drawn)[0].mean() < np.nonzero(green(painted(params, camera)))[0].mean() - 10


def test_distractors_hide_nothing_of_the_object():
    for pose in POSES:
        camera = ray_caster.camera_at(Params(), *pose)
        _, _, stats, _ = cv2.connectedComponentsWithStats(green(painted(Params(), camera)).astype(np.uint8))
        alone = np.count_nonzero(green(painted(Params(distractors=False), camera)))
        assert stats[1:, cv2.CC_STAT_AREA].max() == pytest.approx(alone, rel=0.05)


@pytest.mark.parametrize("yaw", np.linspace(-np.pi, np.pi, 13))
@pytest.mark.parametrize("tilt", [0.0, 0.8, 90 * DEG])
def test_every_direction_can_be_drawn(yaw, tilt):
    params = Params(distractors=False)
    camera = ray_caster.camera_at(params, 0.0, 0.0, 0.3, yaw, 0.0)
    turned = type(camera)(camera.x_m, camera.y_m, camera.z_m, yaw, tilt, camera.focal_px)
    assert painted(Params(), turned).any()
    drawn, true = green(painted(params, turned)), ray_caster.object_mask(params, turned)
    assert agree(drawn, true)


def test_clipping_keeps_what_is_in_view_and_cuts_the_rest():
    """A square around the camera's axis, part of it behind, against its definition: every kept corner is in view."""
    reach = np.array((0.5, 0.4))
    square = np.array(((-3.0, 0.1, -1.0), (3.0, 0.1, -1.0), (3.0, 0.1, 8.0), (-3.0, 0.1, 8.0)))
    part = clipped(square, 0.05, reach)
    assert len(part) >= 3
    assert (part[:, 2] >= 0.05 - 1e-12).all()
    assert (np.abs(part[:, :2]) <= reach * part[:, 2:] + 1e-9).all()
    assert np.allclose(part[:, 1], 0.1)
    assert part[:, 2].max() == 8.0
    assert part[:, 2].min() == pytest.approx(0.1 / 0.4)


def test_clipping_leaves_a_polygon_in_view_alone_and_nothing_of_one_behind():
    inside = np.array(((-0.1, 0.0, 1.0), (0.1, 0.0, 1.0), (0.0, 0.1, 1.0)))
    assert clipped(inside, 0.05, np.ones(2)).tolist() == inside.tolist()
    assert clipped(-inside, 0.05, np.ones(2)).shape == (0, 3)


def exposed(params, image, motion=(0.0, 0.0), seed=1, frame=0):
    data = Sensor(params, seed).expose(image, np.array(motion), np.random.default_rng([seed, frame]))
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR).astype(float)


def grey(level=128):
    return np.full((240, 320, 3), level, np.uint8)


def test_noise_has_its_deviation_and_no_bias():
    sensor = Sensor(Params(light_falloff=0.0, noise_grey=5.0), 1)
    noisy = sensor._grain(grey(), np.random.default_rng(0)).astype(float)
    assert noisy.std() == pytest.approx(5.0, rel=0.05)
    assert noisy.mean() == pytest.approx(128.0, abs=0.1)


def test_noise_differs_from_frame_to_frame():
    sensor = Sensor(Params(light_falloff=0.0), 1)
    one, other = (sensor._grain(grey(), np.random.default_rng(k)).astype(float) - 128 for k in (1, 2))
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.02


def test_light_falls_off_by_its_parameter():
    image = exposed(Params(noise_grey=0.0, light_falloff=0.4, jpeg_quality=100), grey(200))
    assert image[:8, :8].mean() == pytest.approx(200, abs=3)
    assert image[-8:, -8:].mean() == pytest.approx(120, abs=3)


@pytest.mark.parametrize("length", [0.4, 1.0, 2.5, 7.0, 12.3])
def test_blur_keeps_the_centre_and_the_light_and_spreads_like_a_box(length):
    """A box of length L, seen through a pixel, has the variance (L^2 + 1) / 12, less the pixel's own 1 / 12."""
    image = np.zeros((41, 61, 3), np.uint8)
    image[:, 30] = 240
    row = blurred(image, np.array((length, 0.0)))[20, :, 0].astype(float)
    columns = np.arange(61)
    assert row @ columns / row.sum() == pytest.approx(30, abs=0.1)
    assert row.sum() == pytest.approx(240, rel=0.05)
    assert row @ (columns - 30) ** 2 / row.sum() == pytest.approx(max(length, 1.0) ** 2 / 12, abs=0.35)


def test_a_still_camera_takes_a_sharp_image():
    image = np.random.default_rng(0).integers(0, 255, (48, 64, 3), np.uint8)
    assert blurred(image, np.array((0.1, -0.2))) is image


def test_image_motion_is_the_derivative_of_the_projection():
    params = Params(camera_forward_m=0.1, camera_left_m=0.05)
    world = World(params, Start(0.4, 0.2, 1.2), 0)
    world.place(Start(0.4, 0.2, 1.2))
    base, head = world.base, world.head
    base.v_mps, base.omega_radps, head.pan.rate_radps, head.tilt.rate_radps = 0.2, 0.3, -0.5, 0.2
    motion, camera = world.image_motion_pxps, world.camera
    point = camera.position + np.linalg.norm(camera.position) * camera.axes[2]
    step_s = 1e-5
    base.pose.move(0.2, 0.3, step_s)
    head.pan.angle_rad += -0.5 * step_s
    head.tilt.angle_rad += 0.2 * step_s
    assert world.camera.project(point[None])[0] / step_s == pytest.approx(motion, rel=1e-3)


def test_colours_of_the_distractors_are_not_the_objects():
    others = (scene.FLOOR, scene.WALL, scene.RUG, scene.TABLE, scene.APRON, scene.LEAF, scene.TERRACOTTA)
    for blue, g, red in (*others, scene.BLUE, scene.RED, scene.YELLOW):
        assert g - max(blue, red) < 36
        assert min(red - g, g - blue) < 40
