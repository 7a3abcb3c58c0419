"""Policies of a session, which may be anybody's."""

from __future__ import annotations

from components.pilot.messages import table_of
from schemas.policy_pb2 import Policy


def is_policy(message: Policy | None) -> bool:
    """Whether it is one that the pilot would take."""
    try:
        return message is not None and table_of(message) is not None
    except ValueError:
        return False
