"""The same Python source of the law and of the planar step, compiled by numba: one robot, or many at once."""
