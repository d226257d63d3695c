"""Arms: the joint rates for the part of the EE velocity that is left to the arm."""
