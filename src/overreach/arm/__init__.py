"""From the EE velocity that is left to the arm to joint rates."""
