"""What may pass to the robot: pure functions of (state, input, now)."""
