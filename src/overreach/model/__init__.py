"""What a robot is: lengths, limits, mount, workspace."""
