"""From a gated command to rates, and the pilot that puts it all together."""
