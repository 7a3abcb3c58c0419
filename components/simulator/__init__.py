"""The world: plant, camera image, head, gripper, disturbances."""
