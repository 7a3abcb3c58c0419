"""The same as `experiments.watched`, for the benchmarks and tests of running systems."""

from experiments.watched import (
    LAUNCH,
    START_S,
    Bystander,
    Seen,
    Watched,
    children,
    command_line,
    is_alive,
    realm_copy,
    wait_until,
    watched,
)

__all__ = [
    "LAUNCH",
    "START_S",
    "Bystander",
    "Seen",
    "Watched",
    "children",
    "command_line",
    "is_alive",
    "realm_copy",
    "wait_until",
    "watched",
]
