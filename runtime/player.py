"""Puts a log on the bus, message by message, at its own pace or another."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from functools import partial
from threading import Event

from runtime.answers import Answers
from runtime.clock import SECOND_NS
from runtime.contract import ComponentError
from runtime.epoch import Epoch
from runtime.playhead import Playhead
from runtime.playlist import Playlist
from runtime.recording import Logged
from runtime.stage import CLOCK_KEY, Stage
from runtime.wire import Stamp, new_run
from schemas.session_pb2 import Playback

_CLOCK_NS = SECOND_NS // 10
_SLICE_S = 0.05
_SEEK_NS = 5 * SECOND_NS
_OWNER = "player"


class Player:
    """Plays one playlist on one stage."""

    def __init__(
        self,
        playlist: Playlist,
        stage: Stage,
        playhead: Playhead,
        *,
        loop: bool = False,
        clock: bool = True,
        seeks: bool = True,
        answers: Answers | None = None,
        stall_s: float = 10.0,
        capture: Callable[[int], int] | None = None,
    ) -> None:
        """Nothing is played before `run`.

        Args:
            playlist: what to play.
            stage: where.
            playhead: when.
            loop: begin anew at the end.
            clock: tell on `player/clock` where it is.
            seeks: obey `back` and `forward`.
            answers: wait for a running system's answer to each frame.
            stall_s: how long; wall time.
            capture: capture time in the log -> the one to play a message with; None = the same.
        """
        self._playlist = playlist
        self._stage = stage
        self._head = playhead
        self._loop = loop
        self._tells_clock = clock
        self._seeks = seeks
        self._answers = answers
        self._stall_ns = round(stall_s * SECOND_NS)
        self._capture = capture or (lambda capture_ns: capture_ns)
        self._owners = playlist.owners
        self._epoch = Epoch(0)
        self._clock_stamp = Stamp(new_run(), 0, 0)
        self._clock_due_ns = 0
        self._waits_since_ns = 0
        self._words: deque[str] = deque(maxlen=64)
        self._bell = Event()
        self._sought_ns: int | None = None
        self._reason = ""
        self.played = 0
        """Messages put on the bus."""
        if answers is not None:
            for key in answers.keys:
                stage.listen(key, self._ringing(partial(answers.hear, key)))
            stage.listen("*/status", self._ringing(answers.hear_time))

    @property
    def epochs(self) -> int:
        """Passes begun."""
        return self._epoch.number

    def command(self, word: str) -> None:
        """Ask for `pause` (or go on), `step`, `back`, `forward` or `quit`; from any thread."""
        self._words.append(word)
        self._bell.set()

    def stop(self, reason: str) -> None:
        """End soon; from any thread and from a signal handler. The first reason counts."""
        self._reason = self._reason or reason

    def run(self) -> str:
        """Play to the end; returns its reason.

        Raises:
            ComponentError: the running system does not answer.
        """
        since_ns = self._playlist.start_ns
        while not self._reason:
            before = self.played
            self._begin(since_ns)
            self._play_from(since_ns)
            if self._sought_ns is not None:
                since_ns, self._sought_ns = self._sought_ns, None
            elif not self._loop or self.played == before:
                self.stop("end of the log")
            else:
                since_ns = self._playlist.start_ns
        self._stage.leave()
        return self._reason

    def _begin(self, since_ns: int) -> None:
        """A new epoch: whoever spoke in the last one is gone."""
        self._stage.leave()
        if self._epoch.number > 0:
            self._stage.forget()
            if self._answers is not None:
                self._answers.reset()
            self._stage.begin_epoch(lambda: bool(self._reason))
        self._epoch = Epoch(self._epoch.number + 1)
        self._clock_stamp = Stamp(new_run(), 0, since_ns)
        self._clock_due_ns = 0
        self._head.seek(since_ns)

    def _play_from(self, since_ns: int) -> None:
        for logged in self._playlist.messages(since_ns):
            if not self._await(logged):
                return
            capture_ns = self._capture(logged.capture_ns)
            stamp = self._epoch.stamp(logged, capture_ns)
            self._stage.put(logged.topic, logged.schema, logged.payload, self._owners[logged.topic], stamp)
            self.played += 1
            self._head.passed(logged.time_ns)
            if self._answers is not None:
                self._answers.show(logged.topic, logged.capture_ns)

    def _await(self, logged: Logged) -> bool:
        """Wait until a message is due; False if something else is to be done first."""
        self._waits_since_ns = time.monotonic_ns()
        while True:
            self._obey()
            if self._reason or self._sought_ns is not None:
                return False
            now_ns = time.monotonic_ns()
            self._tell_clock(now_ns)
            wait_ns = self._head.wait_ns(logged.time_ns, now_ns)
            if wait_ns == 0 and self._is_answered(logged, now_ns):
                return True
            self._bell.wait(min(wait_ns / SECOND_NS, _SLICE_S) if wait_ns else _SLICE_S)
            self._bell.clear()

    def _is_answered(self, logged: Logged, now_ns: int) -> bool:
        if self._answers is None:
            return True
        missing = self._answers.missing(logged.topic, logged.capture_ns)
        if missing and now_ns > self._waits_since_ns + self._stall_ns:
            raise ComponentError(
                f"no answer on {missing} after {self._stall_ns / SECOND_NS:g} s; {logged.topic} of "
                f"{logged.capture_ns / SECOND_NS:.3f} s waits for it"
            )
        return not missing

    def _obey(self) -> None:
        while self._words:
            word = self._words.popleft()
            self._clock_due_ns = 0
            if word == "pause":
                self._head.toggle()
            elif word == "step":
                self._head.step()
            elif word == "quit":
                self.stop("quit")
            elif word in {"back", "forward"} and self._seeks:
                jump_ns = _SEEK_NS if word == "forward" else -_SEEK_NS
                self._sought_ns = max(self._playlist.start_ns, self._head.time_ns + jump_ns)
            self._waits_since_ns = time.monotonic_ns()

    def _tell_clock(self, now_ns: int) -> None:
        if not self._tells_clock or now_ns < self._clock_due_ns:
            return
        self._clock_due_ns = now_ns + _CLOCK_NS
        head = self._head
        message = Playback(epoch=self.epochs, time_ns=head.time_ns, rate=head.rate, paused=head.paused)
        stamp = self._clock_stamp._replace(capture_ns=head.time_ns)
        self._stage.put(CLOCK_KEY, "berth.Playback", message.SerializeToString(deterministic=True), _OWNER, stamp)
        self._clock_stamp = stamp._replace(sequence=stamp.sequence + 1)

    def _ringing(self, note: Callable[[int], None]) -> Callable[[int], None]:
        def hear(capture_ns: int) -> None:
            note(capture_ns)
            self._bell.set()

        return hear
