"""Rerun's viewers: what is sent, how it is reached, and that it is seen in a real browser."""

import http.client
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from runtime.params import ConfigurationError
from tests.browser import CHROMIUM, Browser
from tests.cli.running import berth, finish

rr = pytest.importorskip("rerun", reason="Rerun is not installed: make setup-view")

from viewer import rerun_session  # noqa: E402
from viewer.camera import OBJECT  # noqa: E402
from viewer.front import Front  # noqa: E402
from viewer.loopback import HOST, free_port  # noqa: E402
from viewer.program import native, served  # noqa: E402
from viewer.recorded import opened, show  # noqa: E402
from viewer.rerun_sink import TIMELINE, RerunSink  # noqa: E402
from viewer.shown import Picture, Shown  # noqa: E402

pytestmark = pytest.mark.xdist_group("live")
RECORDINGS = Path(__file__).parents[2] / "recordings"
DEADLINE_S = 300.0


class Notebook:
    """A recording that writes down what it is sent."""

    def __init__(self):
        self.columns, self.logged, self.hangs = {}, [], False

    def send_columns(self, entity, indexes, columns):
        rows = [len(column.lengths()) if hasattr(column, "lengths") else None for column in columns]
        times = [list(np.asarray(index.as_arrow_array()).astype(int)) for index in indexes]
        self.columns.setdefault(entity, []).append((times, rows))

    def flush(self, *, timeout_sec):
        if self.hangs:
            raise RuntimeError(timeout_sec)

    def log(self, entity, what, *, static):
        self.logged.append((entity, type(what).__name__, static))


@pytest.fixture(scope="module")
def sent():
    notebook = Notebook()
    sink = RerunSink(notebook, patience_s=1.0, rows=50)
    show(*opened(RECORDINGS / "docking.mcap"), sink, lambda _: None)
    return notebook


def test_every_frame_is_sent_once_with_its_session_time(sent):
    times = [time_ns for (columns,), _ in sent.columns["head/pan_deg"] for time_ns in columns]
    assert times == [frame * 125_000_000 for frame in range(197)]


def test_rows_are_sent_in_columns_not_one_by_one(sent):
    assert len(sent.columns["head/pan_deg"]) <= 8  # of 197 rows
    assert sum(map(len, sent.columns.values())) < 400  # of 4400


def test_what_stands_has_no_time(sent):
    for entity in ("plan/table", "plan/edge", "plan/can", "plan/goal"):
        assert [times for times, _ in sent.columns[entity]] == [[]]


def test_a_viewer_that_hangs_is_sent_no_more_until_it_goes_on():
    notebook = Notebook()
    sink = RerunSink(notebook, patience_s=0.0)
    picture = Picture(bytes(1_000_000), "jpeg")
    notebook.hangs = True
    for number in range(100):
        sink.show([Shown("camera/image", number, picture)])
        sink.flush()
    sent_before = len(notebook.columns["camera/image"])
    assert 8 <= sent_before < 12
    assert sink.missed == 100 - sent_before
    notebook.hangs = False
    sink.show([Shown("camera/image", 100, picture)])
    sink.flush()
    assert len(notebook.columns["camera/image"]) == sent_before + 1


def test_each_series_of_a_plot_has_a_colour_once(sent):
    styled = [entity for entity, kind, static in sent.logged if kind == "SeriesLines" and static]
    assert {"head/pan_deg", "head/tilt_deg"} <= set(styled)
    assert len(styled) == len(set(styled))


def test_a_file_for_the_viewer_holds_the_session_and_the_layout(tmp_path):
    file = tmp_path / "docking.rrd"
    with rerun_session.opened(file, "docking", "1GB", port=0, follow=False, patience_s=60.0) as (sink, url, is_closed):
        show(*opened(RECORDINGS / "docking.mcap"), sink, lambda _: None)
        assert (url, is_closed()) == ("", False)
    program = Path(sys.prefix) / "bin" / "rerun"
    said = subprocess.run([program, "rrd", "stats", file], capture_output=True, text=True, check=True).stdout
    for entity in ("/camera/image:", "/plan/robot:", "/log/trials:", "/learning/lc:", "/viewport:", "/time_panel:"):
        assert entity in said
    assert TIMELINE == "session"


@pytest.fixture(scope="module")
def front():
    program, pages = served("50MB")
    with program, Front(0, pages, program.port) as opened_front:
        yield opened_front, program


def ask(port, method, path, headers=None, body=None):
    connection = http.client.HTTPConnection(HOST, port, timeout=60.0)
    connection.request(method, path, body, headers or {})
    answer = connection.getresponse()
    return answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()


def port_of(url):
    return int(url.rstrip("/").rpartition(":")[2])


def test_the_first_page_is_told_to_read_through_the_same_door(front):
    port = port_of(front[0].url)
    status, headers, _ = ask(port, "GET", "/")
    assert status == 302
    assert headers["location"].startswith(f"/?url=rerun%2Bhttp%3A%2F%2F127.0.0.1%3A{port}%2Fproxy")


def test_the_page_may_talk_to_nobody_else(front):
    status, headers, page = ask(port_of(front[0].url), "GET", "/?url=x")
    assert (status, b"Rerun Viewer" in page) == (200, True)
    policy = dict(rule.split(" ", 1) for rule in headers["content-security-policy"].split("; "))
    assert (policy["default-src"], policy["connect-src"]) == ("'self'", "'self'")
    assert "http" not in headers["content-security-policy"]


@pytest.mark.parametrize("name", ["evil.example", "evil.example:9090", "127.0.0.1.evil.example:80", ""])
def test_a_page_from_elsewhere_can_not_read_along(front, name):
    port = port_of(front[0].url)
    assert ask(port, "GET", "/?url=x", {"Host": name})[0] == 403
    assert ask(port, "POST", "/a.B/ReadMessages", {"Host": name}, b"x")[0] == 403


def test_nobody_can_write_through_the_door(front):
    port = port_of(front[0].url)
    assert ask(port, "POST", "/rerun.sdk_comms.v1alpha1.MessageProxyService/WriteMessages", body=b"x")[0] == 403
    assert ask(port, "POST", "/a.B/ReadMessages", {"Content-Length": "99999999"}, b"x")[0] == 413
    assert ask(port, "PUT", "/", body=b"x")[0] == 501


def test_everything_listens_on_this_machine_alone(front):
    ports = {port_of(front[0].url), front[1].port}
    listening = {}
    for family in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{family}").read_text().splitlines()[1:]:
            address, port = line.split()[1].split(":")
            if int(port, 16) in ports and line.split()[3] == "0A":
                listening[int(port, 16)] = address
    assert listening == dict.fromkeys(ports, "0100007F")


def test_a_port_that_is_taken_is_named(front):
    with pytest.raises(
        ConfigurationError, match=r"--port must be one that is free here; got \d+: Address already in use"
    ):
        Front(port_of(front[0].url), 1, 2)


def test_a_program_that_fails_is_told_of_and_leaves_nothing_behind():
    program, _ = served("50MB")
    with program:
        home = program._log.parent
        assert not program.is_over
        program._log.write_text("WARN of something\nError: no graphics\n  0: backtrace\n")
        os.kill(program.pid, signal.SIGKILL)
        with pytest.raises(ConfigurationError, match="the viewer has ended: Error: no graphics; --web and --save need"):
            wait_for(lambda: program.is_over)
    assert not home.exists()


def wait_for(condition):
    until_s = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < until_s
        time.sleep(0.01)


def test_a_display_that_is_none_is_told_of_in_one_line(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":4711")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(ConfigurationError, match=r"the viewer .*: Error: .*X server"), native("50MB") as program:
        wait_for(lambda: program.is_over)


def children(pid):
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def test_a_command_that_is_killed_leaves_no_server_behind():
    watching = berth("view", RECORDINGS / "docking.mcap", "--web", "--no-open", "--port", "0")
    assert "showing" in watching.stderr.readline()
    (server,) = children(watching.pid)
    watching.kill()
    watching.communicate(timeout=DEADLINE_S)
    until_s = time.monotonic() + 30.0
    while Path(f"/proc/{server}/exe").exists():
        assert time.monotonic() < until_s
        time.sleep(0.01)


def test_without_a_display_one_line_says_what_to_do_instead(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(ConfigurationError, match="there is no display here; use --web, --foxglove or --save"):
        native("50MB")


def test_ports_that_are_given_out_are_free():
    assert 1024 < free_port() < 65536


@pytest.mark.skipif(CHROMIUM is None, reason="no browser here: apt-get install chromium")
def test_a_browser_shows_the_camera_with_the_ring_around_the_object(tmp_path):
    watching = berth("view", RECORDINGS / "docking.mcap", "--web", "--no-open", "--port", "0")
    try:
        url = re.search(r"http://\S+", watching.stderr.readline())[0]
        with Browser(tmp_path / "profile", 1000, 640) as browser:
            browser.open(url)
            until_s = time.monotonic() + DEADLINE_S
            while (ring := ring_pixels(browser.screenshot())) < 20:
                assert time.monotonic() < until_s, ring
        assert foreign(browser.events, url) <= {"csp"}  # what the page asks of others is forbidden, not merely lost
    finally:
        watching.send_signal(signal.SIGINT)
    assert finish(watching)[0] == 0


def foreign(events, url):
    """Why each request to another host than this one was not made; None if it was."""
    asked = {event["params"]["requestId"]: event["params"]["request"]["url"] for event in events
             if event.get("method") == "Network.requestWillBeSent"}  # fmt: skip
    failed = {event["params"]["requestId"]: event["params"].get("blockedReason") for event in events
              if event.get("method") == "Network.loadingFailed"}  # fmt: skip
    return {failed.get(number) for number, to in asked.items() if to.startswith("http") and not to.startswith(url)}


def ring_pixels(png):
    """Pixels of the colour that nothing else on the page has."""
    image = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
    red, green, blue, _ = OBJECT
    return int((np.abs(image.astype(int) - (blue, green, red)).max(axis=2) < 12).sum())
