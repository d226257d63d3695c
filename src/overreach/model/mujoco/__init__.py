"""Robots from the model files of their makers, MJCF or URDF, through MuJoCo."""
