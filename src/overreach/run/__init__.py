"""Scenarios, run headless, and what they show."""
