"""Which topics of a session to record or to play. Pure."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from runtime.params import ConfigurationError


@dataclass(frozen=True)
class Selection:
    """Names and patterns of keys below the realm.

    Raises:
        ConfigurationError: a pattern is no regular expression.
    """

    topics: tuple[str, ...] = ()
    """Exact keys."""
    include: str = ""
    """Regular expression that is searched in the key. With topics: one of both must fit."""
    exclude: str = ""
    """Regular expression of keys to leave out, whatever the others say."""
    _patterns: list[re.Pattern[str] | None] = field(default_factory=list, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Refuse what is no pattern."""
        self._patterns.extend([_compiled("-e", self.include), _compiled("-x", self.exclude)])

    def takes(self, key: str) -> bool:
        """Whether a key is selected; everything is if nothing was asked for."""
        include, exclude = self._patterns
        if exclude is not None and exclude.search(key):
            return False
        if not self.topics and include is None:
            return True
        return key in self.topics or (include is not None and include.search(key) is not None)

    def check(self, known: Iterable[str], where: str) -> None:
        """Refuse a selection that names an unknown key or selects nothing.

        Raises:
            ConfigurationError: it does.
        """
        keys = list(known)
        for topic in self.topics:
            if topic not in keys:
                raise ConfigurationError(f"--topics must be keys of {where}: {', '.join(keys)}; got {topic!r}")
        if not any(map(self.takes, keys)):
            raise ConfigurationError(f"--topics, -e and -x must leave a key of {where}: {', '.join(keys)}")


def _compiled(option: str, pattern: str) -> re.Pattern[str] | None:
    try:
        return re.compile(pattern) if pattern else None
    except re.error as error:
        raise ConfigurationError(f"{option} must be a regular expression: {error}; got {pattern!r}") from None
