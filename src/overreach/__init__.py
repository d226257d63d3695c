"""overreach: drive a whole mobile manipulator by its hand."""
__version__ = "0.1.0"
