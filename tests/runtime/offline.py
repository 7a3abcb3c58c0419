"""Small sessions on disk, whole and maimed, for the tests of what is done with a session afterwards."""

from collections.abc import Callable, Iterator
from pathlib import Path

from mcap.records import Attachment, Channel, Header, Metadata, Schema
from mcap.writer import CompressionType, Writer

from cli.in_process import run_in_process
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.mcap_items import Item, RawMessage
from runtime.recording import Recording

FRAMES = 40


def small_session(directory: Path, overrides=(), *, name: str = "small") -> Path:
    """A world and a component that sums, for five seconds of virtual time."""
    launch, file = directory / f"{name}.toml", directory / f"{name}.mcap"
    launch.write_text(
        f"""
realm = "test/offline"
[session]
end = "world/end"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "fickle/drive" }}
params = {{ frames = {FRAMES}, payload_bytes = 64 }}
[component.fickle]
run = "tests.runtime.parts.fickle"
inputs = {{ image = "world/image" }}
[component.recorder]
run = "components.recorder"
params = {{ chunk_bytes = 1500 }}
""",
        encoding="utf-8",
    )
    system = load(launch, overrides, recording=file)
    run_in_process(system, Watch(Progress("", quiet=True)), "now", None)
    return file


Change = Callable[[str, RawMessage], RawMessage | None]
"""(topic, message) -> the message to keep instead, or None to drop it."""


def rewritten(source: Path, target: Path, change: Change, *, attach: Callable[[bytes], bytes] = bytes) -> Path:
    """A copy with other messages, and another launch file."""
    with target.open("wb") as stream:
        writer = Writer(stream, chunk_size=1500, compression=CompressionType.LZ4)
        _copy(writer, Recording(source).items([]), change, attach)
        writer.finish()
    return target


def _copy(writer: Writer, items: Iterator[Item], change: Change, attach: Callable[[bytes], bytes]) -> None:
    topics = {}
    for item in items:
        if isinstance(item, Header):
            writer.start(item.profile, item.library)
        elif isinstance(item, Metadata):
            writer.add_metadata(item.name, item.metadata)
        elif isinstance(item, Attachment):
            writer.add_attachment(0, 0, item.name, item.media_type, attach(item.data))
        elif isinstance(item, Schema):
            writer.register_schema(item.name, item.encoding, item.data)
        elif isinstance(item, Channel):
            topics[item.id] = item.topic
            writer.register_channel(item.topic, item.message_encoding, item.schema_id, item.metadata)
        elif isinstance(item, RawMessage) and (kept := change(topics[item.channel], item)) is not None:
            writer.add_message(kept.channel, kept.log_ns, kept.payload, kept.publish_ns, kept.sequence)


def without(*topics: str, sequences: range | None = None) -> Change:
    """Drop these topics, or only these sequences of them."""

    def change(topic: str, message: RawMessage) -> RawMessage | None:
        gone = topic in topics and (sequences is None or message.sequence in sequences)
        return None if gone else message

    return change
