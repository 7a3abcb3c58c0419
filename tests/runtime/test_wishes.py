"""Whoever asks the supervisor is answered, and does not fill it up."""

from runtime import wishes
from runtime.wishes import EPOCH, Wishes, wish_key


class Asked:
    """A query that remembers its answer."""

    key_expr = wish_key("test/realm", EPOCH)

    def __init__(self):
        self.refusals, self.granted = [], 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def reply_err(self, words):
        self.refusals.append(words)

    def reply(self, _key, _payload):
        self.granted += 1


def test_who_asks_beyond_the_bound_is_refused_at_once_and_all_others_are_granted():
    waiting, queries = Wishes(), [Asked() for _ in range(wishes._MOST + 2)]
    for query in queries:
        waiting._take(EPOCH, query)
    assert [query.refusals for query in queries[wishes._MOST :]] == [[f"{wishes._MOST} others wait already"]] * 2
    waiting.grant({EPOCH: lambda: ""})
    assert [query.granted for query in queries] == [1] * wishes._MOST + [0, 0]
