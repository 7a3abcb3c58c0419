"""The simulated world behind the emulated robot, in lockstep: base's commands reach it as packets, or not at all."""
