"""One picture under way at a time, and how good the next one may be. Pure."""

from __future__ import annotations

FULL = 100
"""Quality of a picture as the camera made it."""
FIRST = FULL // 2
"""Nothing is known of the link yet."""


class Window:
    """Additive increase and multiplicative decrease of the quality; the rate follows from the window of one.

    The next picture is sent when the last one is acknowledged, so never more than one waits in a queue on the way, and
    a slow link gets fewer of them. All times are of this host's clock. Until somebody has acknowledged a picture there
    is nobody to ask: one is sent every `lost_ns`, at the quality it begins with.
    """

    def __init__(self, delay_ns: int, lost_ns: int, step: int, least: int) -> None:
        """Nothing was sent.

        Args:
            delay_ns: from sending to acknowledgement; what takes longer was too much.
            lost_ns: what is not acknowledged by then is lost.
            step: quality gained by a picture that came in time.
            least: lowest quality.
        """
        self.quality = FIRST
        self._delay_ns, self._lost_ns, self._step, self._least = delay_ns, lost_ns, step, least
        self._under_way: tuple[int, int] | None = None
        """(capture time, time of sending)."""
        self._is_heard = False

    def opens(self, time_ns: int) -> bool:
        """Whether a picture may be sent now; gives up one that is lost."""
        if self._under_way is None:
            return True
        if time_ns - self._under_way[1] < self._lost_ns:
            return False
        if self._is_heard:
            self._decrease()
        self._under_way = None
        return True

    def sent(self, capture_ns: int, time_ns: int) -> None:
        """A picture is under way."""
        self._under_way = capture_ns, time_ns

    def acknowledged(self, capture_ns: int, time_ns: int) -> None:
        """A picture has arrived; one that was given up changes nothing."""
        self._is_heard = True
        if self._under_way is None or self._under_way[0] != capture_ns:
            return
        if time_ns - self._under_way[1] > self._delay_ns:
            self._decrease()
        else:
            self.quality = min(FULL, self.quality + self._step)
        self._under_way = None

    def _decrease(self) -> None:
        self.quality = max(self._least, self.quality // 2)
