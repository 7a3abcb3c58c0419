"""When a component that has ended is started again. Pure."""

from __future__ import annotations

_FIRST_S, _LONGEST_S = 0.2, 5.0


class Restarts:
    """One component's restart policy, with back-off and limit."""

    def __init__(self, policy: str, limit: int) -> None:
        """Policy is `never`, `on-failure` or `always`; at most `limit` restarts in a session."""
        self._policy = policy
        self._limit = limit
        self.count = 0

    def delay_s(self, exit_code: int) -> float | None:
        """How long to wait before the next start; None = it stays down."""
        wanted = self._policy == "always" or (self._policy == "on-failure" and exit_code != 0)
        if not wanted or self.count >= self._limit:
            return None
        self.count += 1
        return min(_LONGEST_S, float(_FIRST_S * 2 ** (self.count - 1)))
