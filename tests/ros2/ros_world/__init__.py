"""The simulated world behind an emulated ROS 2 base, in lockstep: base's commands reach it as Twist, or not at all."""
