"""The one door through which a browser reaches the viewer: a port on 127.0.0.1 before Rerun's two.

It adds what they lack. A policy forbids the page to talk to anybody else (left alone it asks four other hosts: for
news, examples and fonts, and to tell of its use); a name other than this machine's is refused, so that no page from
elsewhere can read along; and nothing but reading is let through. One port is also all that `ssh -L` has to carry.
"""

from __future__ import annotations

import http.client
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote, urlsplit

from runtime.params import ConfigurationError
from viewer.loopback import HOST

POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; worker-src 'self' blob:; frame-ancestors 'none'"
)
_READS = "/ReadMessages"
_NAMES = frozenset({"127.0.0.1", "localhost"})
_PIECE = 65536
_QUESTION_BYTES = 65536
_PASSED_ON = ("Content-Type", "rerun-final-length", "grpc-status", "grpc-message", "Access-Control-Expose-Headers")


class Front:
    """Serves until it is left. Use as a context manager."""

    def __init__(self, port: int, pages: int, messages: int) -> None:
        """Open the door.

        Args:
            port: to listen on; 0 = any.
            pages: port of the viewer's own files.
            messages: port of what it reads.

        Raises:
            ConfigurationError: the port is taken.
        """
        try:
            self._server = _Server((HOST, port), _Handler)
        except OSError as error:
            raise ConfigurationError(f"--port must be one that is free here; got {port}: {error.strerror}") from None
        self._server.pages, self._server.messages = pages, messages
        Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def url(self) -> str:
        """To open in a browser."""
        return f"http://{HOST}:{self._server.server_address[1]}/"

    def __enter__(self) -> Self:
        """It is open already."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the door."""
        self._server.shutdown()
        self._server.server_close()


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False
    pages = 0
    messages = 0


class _Handler(BaseHTTPRequestHandler):
    server: _Server
    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        """A file of the viewer; the first page is told where to read."""
        parts = urlsplit(self.path)
        if not self._is_from_here():
            self.send_error(403, "this viewer is for this machine")
        elif parts.path == "/" and not parts.query:
            source = quote(f"rerun+http://{self.headers['Host']}/proxy", safe="")
            self.send_response(302)
            self.send_header("Location", f"/?url={source}&hide_welcome_screen=1")
            self.send_header("Content-Length", "0")
            self.end_headers()
        else:
            self._pass_on(self.server.pages, "GET", None, {})

    def do_POST(self) -> None:
        """What the viewer reads, as long as it wants to."""
        length = self.headers.get("Content-Length", "")
        if not self._is_from_here() or not self.path.endswith(_READS):
            self.send_error(403, "this viewer only reads")
        elif not length.isdigit() or int(length) > _QUESTION_BYTES:
            self.send_error(413, "too long a question")
        else:
            names = ("Content-Type", "x-grpc-web", "x-user-agent", "Accept", "grpc-timeout")
            asked = {name: self.headers[name] for name in names if self.headers[name]}
            self._pass_on(self.server.messages, "POST", self.rfile.read(int(length)), asked)

    def _is_from_here(self) -> bool:
        name = (self.headers.get("Host") or "").rpartition(":")[0] or self.headers.get("Host")
        return name in _NAMES

    def _pass_on(self, port: int, method: str, body: bytes | None, headers: dict[str, str]) -> None:
        self.close_connection = True
        inner = http.client.HTTPConnection(HOST, port)
        with suppress(OSError, http.client.HTTPException):  # either end may go at any time
            inner.request(method, self.path, body, headers)
            self._answer(inner.getresponse())
        inner.close()

    def _answer(self, answer: http.client.HTTPResponse) -> None:
        self.send_response(answer.status)
        for name in _PASSED_ON:
            if answer.getheader(name) is not None:
                self.send_header(name, str(answer.getheader(name)))
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Connection", "close")
        self.end_headers()
        while piece := answer.read1(_PIECE):
            self.wfile.write(piece)

    def log_message(self, *_: Any) -> None:
        """Say nothing."""
