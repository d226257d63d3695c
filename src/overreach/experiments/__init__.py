"""Scenarios, headless runs and what they show."""
