"""`berth keys`: made once, never overwritten, private; and `berth run` refuses bad ones before anything starts."""

import stat
from pathlib import Path

import pytest

from cli.main import main
from runtime.credentials import checked_credentials
from tests.cli.test_mistakes import mistake  # noqa: F401  (a fixture)
from tests.keys import made
from tests.machines import ROOT

SIM2 = ROOT / "launch" / "sim2.toml"


@pytest.fixture
def keys(tmp_path, monkeypatch):
    """Calls `berth keys`."""

    def call(*words: object) -> None:
        monkeypatch.setattr("sys.argv", ["berth", "keys", *map(str, words)])
        with pytest.raises(SystemExit) as exit_:
            main()
        assert not exit_.value.code

    return call


def test_each_host_gets_keys_of_its_own_that_are_fit_for_use(keys, tmp_path, capsys):
    keys("init", "--host", "robot", "--host", "desk", "-o", tmp_path / "keys")
    assert {checked_credentials(tmp_path / "keys", host).directory.name for host in ("robot", "desk")} == {
        "robot",
        "desk",
    }
    assert (tmp_path / "keys" / "robot" / "key.pem").read_bytes() != (
        tmp_path / "keys" / "desk" / "key.pem"
    ).read_bytes()
    assert "copy it to robot" in capsys.readouterr().out


def test_private_keys_are_open_to_their_owner_alone(keys, tmp_path):
    keys("init", "-o", tmp_path / "keys")
    private = [*tmp_path.rglob("key.pem"), tmp_path / "keys" / "authority-key.pem"]
    assert [stat.S_IMODE(file.stat().st_mode) for file in private] == [0o600] * 3
    assert {file.parent.name for file in private} == {"robot", "laptop", "keys"}


def test_a_host_that_comes_later_is_of_the_same_authority(keys, tmp_path):
    keys("init", "-o", tmp_path / "keys")
    keys("add", "--host", "desk", "-o", tmp_path / "keys")
    assert len({file.read_bytes() for file in tmp_path.rglob("authority.pem")}) == 1
    checked_credentials(tmp_path / "keys", "desk")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("init", "-o", "KEYS"), "authority.pem: must not exist yet; keys are never overwritten"),
        (("add", "--host", "robot", "-o", "KEYS"), "robot: must not exist yet; keys are never overwritten"),
        (("add", "--host", "desk", "-o", "nowhere"), "nowhere: must hold authority.pem and authority-key.pem"),
        (("init", "--host", "../x"), "--host must be a lower-case word, as in the launch file; got '../x'"),
        (("init", "--host", "a", "--host", "a"), "--host must be given once for each host; got a, a"),
        (("init", "--days", "0"), "--days must be between 1 and 3653; got 0"),
        (("init", "-o", "/proc/keys"), "/proc/keys: can not be written"),
    ],
)
def test_a_mistake_is_one_line_and_changes_nothing(mistake, tmp_path, words, says):  # noqa: F811
    made(tmp_path / "KEYS", "robot")
    before = {file: file.read_bytes() for file in tmp_path.rglob("*.pem")}
    assert says in mistake("keys", *words)
    assert {file: file.read_bytes() for file in tmp_path.rglob("*.pem")} == before


def spoiled(directory: Path, host: str = "robot") -> Path:
    keys = made(directory / "keys", host)
    (keys / host / "key.pem").chmod(0o644)
    return keys


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda d: d / "none", "none/robot: must be there, made by `berth keys init`"),
        (spoiled, "robot/key.pem: must be open to its owner alone (chmod 600); got 0644"),
        (lambda d: made(d / "keys", "robot", age_days=31.0), "certificate.pem: must be valid now"),
    ],
)
def test_run_with_keys_that_are_not_fit_for_use_starts_nothing(mistake, tmp_path, make, says):  # noqa: F811
    words = ("run", SIM2, "--host", "robot", "--listen", "tls/127.0.0.1:7447", "--no-record", "--keys", make(tmp_path))
    assert says in mistake(*words)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--listen", "tcp/0.0.0.0:7447", "--keys", "KEYS"), "--listen must be tls/ADDRESS:PORT with security"),
        (("--listen", "tls/0.0.0.0:7447"), "--listen must be tcp/ADDRESS:PORT; got 'tls/0.0.0.0:7447'"),
        (("--listen", "tls/0.0.0.0:1", "--keys", "KEYS", "--insecure"), "--insecure must stand without security"),
    ],
)
def test_a_link_is_either_secure_or_on_loopback_or_asked_for_in_so_many_words(mistake, tmp_path, words, says):  # noqa: F811
    made(tmp_path / "KEYS", "robot")
    assert says in mistake("run", SIM2, "--host", "robot", "--no-record", *words)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('security = "ssl"', "security must be one of none, tls; got 'ssl'"),
        ('keys = "keys"', "keys must be a directory, and stand with security = \"tls\"; got 'keys'"),
        ('security = "tls"\nkeys = 3', 'keys must be a directory, and stand with security = "tls"; got 3'),
    ],
)
def test_a_launch_file_s_mistake_is_named(mistake, tmp_path, line, says):  # noqa: F811
    file = tmp_path / "wrong.toml"
    file.write_text(line + "\n" + SIM2.read_text(encoding="utf-8"), encoding="utf-8")
    assert f"wrong.toml: {says}" in mistake(
        "run", file, "--host", "robot", "--listen", "tls/127.0.0.1:1", "--no-record"
    )


def test_a_launch_file_can_ask_for_keys_itself(mistake, tmp_path):  # noqa: F811
    file = tmp_path / "secure.toml"
    file.write_text('security = "tls"\n' + SIM2.read_text(encoding="utf-8"), encoding="utf-8")
    words = ("run", file, "--host", "robot", "--listen", "tls/127.0.0.1:7447", "--no-record")
    assert "keys/robot: must be there, made by `berth keys init`" in mistake(*words)
