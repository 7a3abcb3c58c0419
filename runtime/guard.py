"""Who may come in: a link that only hosts of this system with their keys can use, each for its own part."""

from __future__ import annotations

import dataclasses

from runtime.admission import access_control, check_topology
from runtime.credentials import checked_credentials
from runtime.link import Link
from runtime.system import System
from runtime.welcome import check_welcome


def guarded(link: Link, system: System) -> Link:
    """The link with this host's credentials and the rights of its neighbours.

    Args:
        link: with `tls/` endpoints.
        system: with `host` and `keys`.

    Raises:
        ConfigurationError: the credentials are not fit for use, the other host refuses them, or this host must not
            listen or connect.
    """
    check_topology(system, listens=bool(link.listen), connects=bool(link.connect))
    credentials = checked_credentials(system.keys, system.host)
    if link.connect:
        check_welcome(credentials, link.connect, system.other_hosts)
    return dataclasses.replace(link, guard={**credentials.options(), "access_control": access_control(system)})
