"""A stranger's program: reads a session by somebody else's MCAP reader and the schemas embedded in the file alone.

    python -I stranger.py READER FILE

It can not import anything of ours, and prints what it found as JSON.
"""

import hashlib
import io
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.json_format import MessageToDict
from google.protobuf.message_factory import GetMessageClass
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image
from pybag.mcap.record_reader import McapChunkedReader

OURS = {"runtime", "schemas", "components", "docking", "report", "cli", "experiments"}


class Refuse:
    """Nothing of ours can be imported, installed or not."""

    def find_spec(self, name: str, *_: Any) -> None:
        if name.partition(".")[0] in OURS:
            raise ImportError(name)


class Row(NamedTuple):
    """One message, decoded."""

    topic: str
    schema: str
    sequence: int
    publish_ns: int
    log_ns: int
    message: Any


class Contents(NamedTuple):
    """A whole file."""

    count: int
    """Of messages, as the file's own statistics say."""
    attachments: list[str]
    metadata: list[str]
    rows: list[Row]


def by_mcap(file: str) -> Contents:
    """The reader of the format's authors, and their decoder."""
    with Path(file).open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        rows = [
            Row(channel.topic, schema.name, message.sequence, message.publish_time, message.log_time, decoded)
            for schema, channel, message, decoded in reader.iter_decoded_messages()
        ]
        names = [a.name for a in reader.iter_attachments()], [m.name for m in reader.iter_metadata()]
        return Contents(reader.get_summary().statistics.message_count, *names, rows)


def by_pybag(file: str) -> Contents:
    """pybag, which shares no code with it; messages are decoded with protobuf itself, from a pool of their own."""
    with McapChunkedReader.from_file(file, enable_crc_check=True) as reader:
        kinds = {number: _class_of(schema.name, schema.data) for number, schema in reader.get_schemas().items()}
        channels = reader.get_channels()
        rows = [
            Row(
                (channel := channels[message.channel_id]).topic,
                reader.get_schemas()[channel.schema_id].name,
                message.sequence,
                message.publish_time,
                message.log_time,
                kinds[channel.schema_id].FromString(message.data),
            )
            for message in reader.get_messages()
        ]
        count = reader.get_statistics().message_count
    # pybag 0.13 takes an attachment's CRC over its data alone; the format has it over all fields before it.
    with McapChunkedReader.from_file(file, enable_crc_check=False) as reader:
        names = [a.name for a in reader.get_attachments()], [m.name for m in reader.get_metadata()]
    return Contents(count, *names, rows)


def _class_of(name: str, data: bytes) -> Any:
    """From a FileDescriptorSet in which every file comes after those that it imports: nothing else is known."""
    pool = DescriptorPool()
    for file in FileDescriptorSet.FromString(data).file:
        pool.Add(file)
    return GetMessageClass(pool.FindMessageTypeByName(name))


def images(rows: list[Row]) -> Iterator[tuple[int, int]]:
    """(width, height) of every image, opened from the bytes of its message by two libraries."""
    for row in rows:
        if row.schema == "foxglove.CompressedImage":
            pixels = cv2.imdecode(np.frombuffer(row.message.data, np.uint8), cv2.IMREAD_COLOR)
            image = Image.open(io.BytesIO(row.message.data))
            image.load()
            assert image.size == pixels.shape[1::-1]
            assert image.format.lower() == row.message.format
            yield image.size


def digest(message: Any) -> str:
    """Of every field that is set in a message, by name; a field that a later release adds changes nothing."""
    fields = MessageToDict(message, preserving_proto_field_name=True)
    return hashlib.sha256(json.dumps(fields, sort_keys=True).encode()).hexdigest()[:16]


def main() -> None:
    """Read, and tell."""
    sys.meta_path.insert(0, Refuse())
    reader, file = sys.argv[1:]
    contents = {"mcap": by_mcap, "pybag": by_pybag}[reader](file)
    told = [(*row[:4], digest(row.message)) for row in contents.rows]
    times = [row.log_ns for row in contents.rows]
    found = {
        "rows": sorted(told),
        "count": contents.count,
        "in_order": times == sorted(times),
        "attachments": contents.attachments,
        "metadata": contents.metadata,
        "images": sorted(set(images(contents.rows))),
        "ours": sorted(name for name in sys.modules if name.split(".")[0] in OURS),
    }
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
