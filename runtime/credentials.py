"""What a host shows to prove who it is: its authority, its certificate and its private key, checked before use.

Standard library only: the check is a handshake of the host with itself, in memory, by the rules of both ends.
"""

from __future__ import annotations

import os
import ssl
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from runtime.params import ConfigurationError

AUTHORITY, CERTIFICATE, KEY = "authority.pem", "certificate.pem", "key.pem"
_STEPS = 4
"""A handshake of TLS 1.3 takes two turns of each end; a refusal shows in the turn after."""
_Subject = tuple[tuple[tuple[str, str], ...], ...]


@dataclass(frozen=True)
class Credentials:
    """Three PEM files of one host, in a directory of their own."""

    directory: Path

    @property
    def authority(self) -> Path:
        """Certificate of whom this host trusts."""
        return self.directory / AUTHORITY

    @property
    def certificate(self) -> Path:
        """Of this host; its common name is the host's name."""
        return self.directory / CERTIFICATE

    @property
    def key(self) -> Path:
        """Private."""
        return self.directory / KEY

    def options(self) -> dict[str, object]:
        """Settings of zenoh: both ends prove who they are, and a link ends when a certificate does.

        The address that was dialled is not compared with the certificate: robots change their addresses. Who answers
        is known by the certificate's common name, which the access control of both ends goes by.
        """
        certificate, key = str(self.certificate.absolute()), str(self.key.absolute())
        return {
            "transport/link/tls": {
                "root_ca_certificate": str(self.authority.absolute()),
                "listen_certificate": certificate,
                "listen_private_key": key,
                "connect_certificate": certificate,
                "connect_private_key": key,
                "enable_mtls": True,
                "verify_name_on_connect": False,
                "close_link_on_expiration": True,
            },
            "transport/link/protocols": ["tcp", "tls"],
        }


def checked_credentials(keys: str | Path, host: str) -> Credentials:
    """The credentials of a host, fit for use now.

    Args:
        keys: directory that `berth keys init` made, or a copy that holds this host's part of it.
        host: name in the launch file.

    Raises:
        ConfigurationError: a file is missing, open to others, no certificate or key, expired, not valid yet, of another
            authority, or of another host.
    """
    found = Credentials(Path(keys) / host)
    for path, mask, rule in (
        (found.directory, 0o022, "be writable by its owner alone (chmod go-w)"),
        (found.authority, 0o022, "be writable by its owner alone (chmod go-w)"),
        (found.certificate, 0o022, "be writable by its owner alone (chmod go-w)"),
        (found.key, 0o077, "be open to its owner alone (chmod 600)"),
    ):
        _check_mode(path, mask, rule)
    name = _shown_name(found)
    if name != host:
        raise ConfigurationError(f"{found.certificate}: its common name must be {host!r}, this host; got {name!r}")
    return found


def _check_mode(path: Path, mask: int, rule: str) -> None:
    try:
        status = path.stat()
    except OSError as error:
        raise ConfigurationError(
            f"{path}: must be there, made by `berth keys init` and copied to this host: {error.strerror}"
        ) from None
    if status.st_uid != os.getuid():
        raise ConfigurationError(f"{path}: must belong to the user who runs this (uid {os.getuid()})")
    if status.st_mode & mask:
        raise ConfigurationError(f"{path}: must {rule}; got {stat.S_IMODE(status.st_mode):04o}")


def context(protocol: int, credentials: Credentials) -> ssl.SSLContext:
    """One end of a link as zenoh has it: both show their certificates, no name is compared.

    Raises:
        ConfigurationError: the files hold no certificate or no key.
    """
    made = ssl.SSLContext(protocol)
    made.check_hostname = False
    made.verify_mode = ssl.CERT_REQUIRED
    try:
        made.load_verify_locations(credentials.authority)
    except (OSError, ssl.SSLError):
        raise ConfigurationError(f"{credentials.authority}: must hold a certificate as PEM") from None
    try:
        # The password keeps OpenSSL from asking for one on the terminal.
        made.load_cert_chain(credentials.certificate, credentials.key, password="none")  # noqa: S106
    except (OSError, ssl.SSLError) as error:
        words = "be the key of" if getattr(error, "reason", None) == "KEY_VALUES_MISMATCH" else "hold a key as PEM for"
        raise ConfigurationError(f"{credentials.key}: must {words} {credentials.certificate}") from None
    return made


def common_name(end: ssl.SSLObject | ssl.SSLSocket) -> str:
    """Name of who has shown a certificate; empty if it has no name, or more than one."""
    subject = (end.getpeercert() or {}).get("subject", ())
    names = [value for part in cast("_Subject", subject) for key, value in part if key == "commonName"]
    return names[0] if len(names) == 1 else ""


def _shown_name(credentials: Credentials) -> str:
    """The name that the other end of a link will see, after a handshake with ourselves."""
    client = context(ssl.PROTOCOL_TLS_CLIENT, credentials)
    server = context(ssl.PROTOCOL_TLS_SERVER, credentials)
    there, back = ssl.MemoryBIO(), ssl.MemoryBIO()
    ends = (client.wrap_bio(back, there), server.wrap_bio(there, back, server_side=True))
    try:
        for _ in range(_STEPS):
            for end in ends:
                _step(end)
    except ssl.SSLCertVerificationError as error:
        raise ConfigurationError(
            f"{credentials.certificate}: must be valid now and signed by {credentials.authority}; "
            f"got: {error.verify_message}"
        ) from None
    except ssl.SSLError as error:
        raise ConfigurationError(f"{credentials.certificate}: must be fit for TLS; got: {error.reason}") from None
    return common_name(ends[0])


def _step(end: ssl.SSLObject) -> None:
    try:
        end.do_handshake()
    except ssl.SSLWantReadError:
        return
