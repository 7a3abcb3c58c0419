"""Pan-tilt unit driver."""
