"""What a laptop's recording lacks of what the robot's holds, and whether its gap records say exactly that."""

from __future__ import annotations

from typing import NamedTuple

from runtime.recording import Recording

Sequences = dict[tuple[str, int], set[int]]
"""By key and run."""


class Account(NamedTuple):
    """Message by message, of each key and run of which the recording has anything."""

    lacking: int
    """Messages between the first and the last of their run that are not there."""
    told: int
    """Messages that its gap records name."""
    wrong: int
    """Keys and runs of which the two are not the same messages."""
    sent: int
    """Of those told, the ones that the robot's own recording holds: they were said."""


def account(robot: Recording, laptop: Recording) -> Account:
    """Compare the laptop's recording with its own gap records, and both with the robot's."""
    there, heard, told = _sequences(robot), _sequences(laptop), _told(laptop)
    lacking = {key: set(range(min(numbers), max(numbers) + 1)) - numbers for key, numbers in heard.items()}
    return Account(
        lacking=sum(map(len, lacking.values())),
        told=sum(map(len, told.values())),
        wrong=sum(lacking.get(key, set()) != told.get(key, set()) for key in {*lacking, *told}),
        sent=sum(len(numbers & there.get(key, set())) for key, numbers in told.items()),
    )


def _sequences(recording: Recording) -> Sequences:
    found: Sequences = {}
    for message in recording.messages():
        found.setdefault((message.topic, message.run), set()).add(message.sequence)
    return found


def _told(recording: Recording) -> Sequences:
    found: Sequences = {}
    for message in recording.messages({"recorder/gap"}):
        gap = message.decoded()
        missing = range(gap.first_missing, gap.first_missing + gap.count)
        found.setdefault((gap.key, gap.run), set()).update(missing)
    return found
