"""Public conformance suites: what every plug must pass, for those who write one."""
