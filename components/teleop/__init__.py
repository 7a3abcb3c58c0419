"""A person's keys or gamepad, with a dead-man key: one more commander of the base."""
