"""One link of a bare chain: a process that gets bytes on one key and puts bytes on the next. No runtime of ours.

    python -m benchmarks.chain ENDPOINT IN OUT BYTES [look]
    python -m benchmarks.chain ENDPOINT source OUT FILE

`look` decodes each payload as a JPEG and runs vision on it, the OpenCV calls that no chain can do without. A source
puts the file's content eight times a second.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from pathlib import Path

import zenoh

from runtime.bus import open_peer

PERIOD_S = 0.125


def link(endpoint: str, key_in: str, key_out: str, size: int, work: Callable[[bytes], object]) -> None:
    """Forward until standard input ends."""
    payload = bytes(size)
    with open_peer(endpoint) as session:
        publisher = session.declare_publisher(key_out, congestion_control=zenoh.CongestionControl.BLOCK)

        def receive(sample: zenoh.Sample) -> None:
            data = sample.payload.to_bytes()
            work(data)
            attachment = sample.attachment
            publisher.put(payload, attachment=attachment.to_bytes() if attachment is not None else b"")

        session.declare_subscriber(key_in, zenoh.handlers.Callback(receive, indirect=False))
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        sys.stdin.read()


def source(endpoint: str, key_out: str, payload: bytes) -> None:
    """Put a payload eight times a second until standard input ends; the attachment is the frame's number."""
    stop = threading.Event()

    def await_end() -> None:
        sys.stdin.read()
        stop.set()

    threading.Thread(target=await_end, daemon=True).start()
    with open_peer(endpoint) as session:
        publisher = session.declare_publisher(key_out, congestion_control=zenoh.CongestionControl.BLOCK)
        frame = 0
        while not stop.wait(PERIOD_S):
            publisher.put(payload, attachment=frame.to_bytes(8, "little"))
            frame += 1


def looker() -> Callable[[bytes], object]:
    """What vision does with an image."""
    import cv2  # noqa: PLC0415  (the other links need none of it)

    from components.vision import core, jpeg, ports  # noqa: PLC0415

    cv2.setNumThreads(1)
    params = ports.Params()
    eyes = core.Eyes(params)
    return lambda data: eyes.look(jpeg.decode(data, params.width_px, params.height_px))


def main() -> None:
    """Run one link."""
    endpoint, key_in, key_out, size = sys.argv[1:5]
    if key_in == "source":
        source(endpoint, key_out, Path(size).read_bytes())
    else:
        link(endpoint, key_in, key_out, int(size), looker() if "look" in sys.argv[5:] else lambda _: None)


if __name__ == "__main__":
    main()
