"""What is known of a recording's chunks, kept in a file and not in memory: it is written once, at the end.

MCAP's writer keeps an object for each chunk and a number for each topic in it: 2.4 kB where there are thirty topics
(measured). Two chunks a second are 17 MB an hour, as much as all the rest of the recorder.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Self

from mcap.data_stream import RecordBuilder
from mcap.writer import Writer


class ChunkIndex:
    """Takes the place of the writer's list."""

    def __init__(self, directory: Path) -> None:
        """Make the file; it has no name, and goes with this process.

        Raises:
            OSError: there is no room.
        """
        self._file = tempfile.TemporaryFile(dir=directory)  # noqa: SIM115  (closed with the writer)

    def append(self, index: Any) -> None:
        """Note a chunk.

        Raises:
            OSError: there is no room.
        """
        record = RecordBuilder()
        index.write(record)
        self._file.write(record.end())

    def __iter__(self) -> Iterator[Self]:
        """All of them as one."""
        yield self

    def write(self, summary: RecordBuilder) -> None:
        """Give the writer all that was noted, for the end of its file."""
        self._file.seek(0)
        shutil.copyfileobj(self._file, summary)
        self._file.seek(0, 2)

    def close(self) -> None:
        """Forget it."""
        self._file.close()


def kept_in_a_file(writer: Writer, directory: Path) -> ChunkIndex:
    """Let an MCAP writer keep its index in a file; it has no option for that, hence its private name."""
    index = ChunkIndex(directory)
    vars(writer)["_Writer__chunk_indices"] = index
    return index
