"""The robot base: drive, odometry, gripper, safety."""
