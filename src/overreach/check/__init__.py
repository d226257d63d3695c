"""Whether a robot does what it is commanded: random streams driven in and across its workspace, and judged."""
