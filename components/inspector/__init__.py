"""Small motions that tell how a robot is wired: signs, units, beams, latencies."""
