"""The command `berth`: one verb per file. Nothing imports it."""
