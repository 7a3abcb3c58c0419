"""Which frames have been answered: the gate that lets lockstep take its next step."""

from __future__ import annotations

from dataclasses import dataclass, field

ANSWERS = ("drive", "aim", "trial")
"""Every one of these must answer a frame before the next is taken."""
ACK_FRAMES = 16
"""The recorder, and a learner that says where it is, may be this many frames behind."""
ACKS = ("ack", "pace")
STALLS = 3
"""This many in a row end the session."""


@dataclass(slots=True)
class Gate:
    """Counts answers to the newest frame."""

    frame_ns: int
    """Time between frames."""
    newest_ns: int = 0
    """Capture time of the newest frame."""
    answered: set[str] = field(default_factory=set)
    acked_ns: dict[str, int] = field(default_factory=dict)
    """By port: the newest frame that was acknowledged; who has never done so is not waited for."""
    stalls: int = 0

    def open_frame(self, capture_ns: int) -> None:
        """A new frame is out."""
        self.newest_ns = capture_ns
        self.answered.clear()

    def answer(self, port: str, capture_ns: int) -> None:
        """Something came; only answers to the newest frame count."""
        if port in ACKS:
            self.acked_ns[port] = max(self.acked_ns.get(port, 0), min(capture_ns, self.newest_ns))
        elif capture_ns == self.newest_ns:
            self.answered.add(port)

    @property
    def missing(self) -> tuple[str, ...]:
        """Ports that the next step waits for."""
        missing = tuple(port for port in ANSWERS if port not in self.answered)
        oldest_ns = self.newest_ns - ACK_FRAMES * self.frame_ns
        return (*missing, *(port for port in ACKS if self.acked_ns.get(port, oldest_ns) < oldest_ns))
