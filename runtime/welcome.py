"""Whether the host that is to be dialled will let this one in: asked once, before anything starts.

Zenoh would try again for ever and say nothing (its handshakes fail at log level only).
"""

from __future__ import annotations

import contextlib
import socket
import ssl
from collections.abc import Collection

from runtime.credentials import Credentials, common_name, context
from runtime.params import ConfigurationError

_CONNECT_S = 1.0
_REFUSAL_S = 0.5
"""In TLS 1.3 a refusal of our certificate comes after the handshake."""


def check_welcome(credentials: Credentials, endpoint: str, hosts: Collection[str]) -> None:
    """Shake hands with whoever is there; nobody there is fine, the order of starting is free.

    Args:
        credentials: of this host.
        endpoint: `tls/ADDRESS:PORT`.
        hosts: the other hosts of the system.

    Raises:
        ConfigurationError: the other host is of another authority or no part of the system, or refuses this host.
    """
    address, _, port = endpoint.partition("/")[2].rpartition(":")
    with contextlib.ExitStack() as stack:
        try:
            line = stack.enter_context(socket.create_connection((address.strip("[]"), int(port)), _CONNECT_S))
            end = stack.enter_context(context(ssl.PROTOCOL_TLS_CLIENT, credentials).wrap_socket(line))
        except ssl.SSLCertVerificationError as error:
            raise ConfigurationError(
                f"--connect {endpoint}: the host there must have keys of {credentials.authority}; "
                f"got: {error.verify_message}"
            ) from None
        except ssl.SSLError as error:
            raise ConfigurationError(f"--connect {endpoint}: the host there must speak TLS: {error.reason}") from None
        except (OSError, OverflowError):
            return
        name = common_name(end)
        if name not in hosts:
            known = ", ".join(hosts)
            raise ConfigurationError(f"--connect {endpoint}: the host there must be one of {known}; got {name!r}")
        _await_refusal(end, credentials, endpoint)


def _await_refusal(end: ssl.SSLSocket, credentials: Credentials, endpoint: str) -> None:
    end.settimeout(_REFUSAL_S)
    try:
        end.recv(1)
    except TimeoutError:
        return
    except ssl.SSLError as error:
        raise ConfigurationError(
            f"--connect {endpoint}: the host there refuses {credentials.certificate}; are its keys of the same "
            f"`berth keys init`? got: {error.reason}"
        ) from None
    except OSError:
        return
