"""`python -m tests.camera.reads JSON`: what a V4L2 camera reads, as lines of JSON, until standard input ends."""

import json
import select
import sys
import time

from components.camera.devices.v4l2 import V4l2Camera
from components.camera.ports import V4l2
from runtime.contract import DeviceError


def tell(**words):
    sys.stdout.write(json.dumps(words) + "\n")
    sys.stdout.flush()


def main():
    try:
        camera = V4l2Camera(V4l2(**json.loads(sys.argv[1])))
    except DeviceError as error:
        tell(refused=str(error))
        return
    tell(opened=True)
    while not select.select([sys.stdin], [], [], 0)[0]:
        reading = camera.read(0.02)
        if reading is not None:
            tell(time_ns=time.monotonic_ns() - round(reading.age_s * 1e9), data=reading.message.data.hex())
    camera.close()
    tell(closed=True)


if __name__ == "__main__":
    main()
