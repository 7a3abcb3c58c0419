"""Pan-tilt cameras."""
