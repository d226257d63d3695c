"""What all tests share. Hypothesis draws the same cases every time: a test that fails, fails again."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

settings.register_profile("overreach", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("overreach")
