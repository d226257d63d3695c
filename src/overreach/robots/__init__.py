"""Robots: the Protocol that a driver implements, and the simulation."""
