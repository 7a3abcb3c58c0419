"""Makes docs/view.png: `python -m tests.viewer.picture RECORDING docs/view.png [SECONDS]`, then look at it."""

import re
import signal
import sys
import tempfile
import time
from pathlib import Path

from tests.browser import Browser
from tests.cli.running import berth

SECONDS = 60.0
"""Until everything is drawn; more on a busy machine."""


def main(recording: str, file: str, seconds: str = str(SECONDS)) -> None:
    """Show the recording's end in a browser and take its picture."""
    watching = berth("view", recording, "--web", "--no-open", "--port", "0", "--at-end")
    url = re.search(r"http://\S+", watching.stderr.readline())[0]
    with tempfile.TemporaryDirectory() as folder, Browser(Path(folder) / "profile", 1600, 1000) as browser:
        browser.open(url)
        until_s = time.monotonic() + float(seconds)
        while time.monotonic() < until_s:
            Path(file).write_bytes(browser.screenshot())
            time.sleep(1.0)
    watching.send_signal(signal.SIGINT)
    watching.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
