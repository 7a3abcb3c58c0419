"""A headless Chromium, driven over a pipe in the DevTools protocol: JSON objects with a zero byte after each."""

import base64
import json
import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
_FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe",
)  # fmt: skip

_PLUG = """
import os, sys
import fcntl
high = [fcntl.fcntl(int(end), fcntl.F_DUPFD, 10) for end in sys.argv[1:3]]
os.dup2(high[0], 3); os.dup2(high[1], 4)
os.execvp(sys.argv[3], sys.argv[3:])
"""
"""The protocol's two ends are file descriptors 3 and 4 by definition."""


class Browser:
    """One page. Use as a context manager."""

    def __init__(self, profile: Path, width_px: int = 1600, height_px: int = 1000) -> None:
        to_child, self._to = os.pipe()
        self._from, from_child = os.pipe()
        words = [
            CHROMIUM,
            *_FLAGS,
            f"--window-size={width_px},{height_px}",
            f"--user-data-dir={profile}",
            "about:blank",
        ]
        self._log = (profile.parent / "chromium.log").open("wb")
        self._process = subprocess.Popen(
            [sys.executable, "-c", _PLUG, str(to_child), str(from_child), *words],
            pass_fds=(to_child, from_child),
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=self._log,
        )
        os.close(to_child)
        os.close(from_child)
        self._number, self._heard = 0, b""
        self.events: list[dict] = []
        target = self._page()
        self._session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network"):
            self.tell(f"{domain}.enable")

    def _page(self) -> str:
        self._session = None
        found = [t for t in self.ask("Target.getTargets")["targetInfos"] if t["type"] == "page"]
        return found[0]["targetId"]

    def tell(self, method: str, **params):
        """One command of the page; its result."""
        return self.ask(method, **params)

    def ask(self, method: str, *, deadline_s: float = 240.0, **params) -> dict:
        self._number += 1
        words = {"id": self._number, "method": method, "params": params}
        if self._session is not None:
            words["sessionId"] = self._session
        os.write(self._to, json.dumps(words).encode() + b"\0")
        until_s = time.monotonic() + deadline_s
        while time.monotonic() < until_s:
            for message in self._hear(until_s - time.monotonic()):
                if message.get("id") == self._number:
                    assert "error" not in message, message
                    return message["result"]
                self.events.append(message)
        raise AssertionError(f"no answer to {method}")

    def _hear(self, timeout_s: float) -> list[dict]:
        ready, _, _ = select.select([self._from], [], [], max(0.0, timeout_s))
        if not ready:
            return []
        said = os.read(self._from, 1 << 20)
        assert said, "chromium has ended"
        *whole, self._heard = (self._heard + said).split(b"\0")
        return [json.loads(words) for words in whole]

    def open(self, url: str, deadline_s: float = 240.0) -> None:
        """Go to a page and wait until all that it names is there."""
        self.tell("Page.navigate", url=url)
        until_s = time.monotonic() + deadline_s
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            assert time.monotonic() < until_s, f"{url} does not load"
            self.events += self._hear(1.0)

    def evaluate(self, script: str):
        """Value of an expression in the page."""
        return self.tell("Runtime.evaluate", expression=script, returnByValue=True)["result"].get("value")

    def screenshot(self) -> bytes:
        """PNG of what is seen."""
        return base64.b64decode(self.tell("Page.captureScreenshot", format="png")["data"])

    def requests(self) -> list[str]:
        """Addresses that the page has asked for."""
        return [e["params"]["request"]["url"] for e in self.events if e.get("method") == "Network.requestWillBeSent"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self._log.close()
