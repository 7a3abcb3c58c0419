"""A slow twin of the renderer and a judge of the eyes: what each pixel's own ray meets first, by closed forms."""

import numpy as np

from docking import plant
from docking.pinhole import Camera

FLAT = 1e-12


def camera_at(params, beta, alpha, d, pan=0.0, tilt=0.0):
    """Camera of a robot that looks at the object, turned away by pan and tilt."""
    x, y, _ = pose = plant.pose(beta, alpha, d)
    head = np.arctan2(params.camera_up_m, d) + tilt
    return Camera(x, y, params.camera_up_m, pose[2] + alpha + pan, head, params.scaled_focal_px)


def pixels(params):
    """Pixel centres from the image centre, `[height * width, 2]`, row by row."""
    u = np.arange(params.width_px) - (params.width_px - 1) / 2
    v = np.arange(params.height_px) - (params.height_px - 1) / 2
    return np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)


def object_mask(params, camera, object_m=(0.0, 0.0, 0.0)):
    """Where the object is seen, `[height, width]` bool: a ray against a cylinder and its two lids."""
    rays, here = camera.rays(pixels(params)), camera.position - np.asarray(object_m)
    radius, half = params.object_diameter_m / 2, params.object_height_m / 2
    a, b = (rays[:, :2] ** 2).sum(axis=1) + FLAT, rays[:, :2] @ here[:2]
    inside = b**2 - a * (here[:2] @ here[:2] - radius**2)
    way = (-b - np.sqrt(np.maximum(inside, 0.0))) / a
    mantle = (inside >= 0) & (way > 0) & (np.abs(here[2] + way * rays[:, 2]) <= half)
    lid_way = (half - here[2]) / np.where(np.abs(rays[:, 2]) < FLAT, FLAT, rays[:, 2])
    lid = (lid_way > 0) & (np.hypot(*(here[:2, None] + lid_way * rays[:, :2].T)) <= radius)
    return (mantle | lid).reshape(params.height_px, params.width_px)


def stripe_mask(params, camera):
    """Where the stripe is seen, `[height, width]` bool: a ray against the upright plane of the table's edge."""
    rays, here = camera.rays(pixels(params)), camera.position
    way = (-params.edge_offset_m - here[0]) / np.where(np.abs(rays[:, 0]) < FLAT, FLAT, rays[:, 0])
    y, z = here[1] + way * rays[:, 1], here[2] + way * rays[:, 2]
    top = params.table_z_m
    seen = (way > 0) & (z <= top) & (z >= top - params.stripe_height_m) & (np.abs(y) <= params.table_width_m / 2)
    return seen.reshape(params.height_px, params.width_px)


def middle(mask):
    """Median column and row of a mask, from the image centre."""
    rows, columns = np.nonzero(mask)
    height, width = mask.shape
    return np.median(columns) - (width - 1) / 2, np.median(rows) - (height - 1) / 2


def stripe_line(params, camera, u_px):
    """(row, slope) at which the middle line of the stripe crosses column u, by the projection alone."""
    along = np.array((0.0, 1.0, 0.0))
    right, _, _ = camera.axes
    point = np.array((-params.edge_offset_m, 0.0, params.stripe_z_m))
    # u depth = f right: linear in the position along the edge.
    plane = camera.focal_px * right - u_px * camera.axes[2]
    point = point - along * (plane @ (point - camera.position)) / (plane @ along)
    return camera.project(point[None])[0, 1], camera.slope(point, along)
