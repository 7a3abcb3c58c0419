"""A system with keys on three hosts, and who else comes to its door."""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import zenoh

from cli.authority import Authority
from runtime.bus import _config, free_endpoint, never_drop, ready_key
from runtime.credentials import Credentials
from runtime.guard import guarded
from runtime.launch import load
from runtime.link import Link
from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from runtime.system import System
from runtime.wire import encoding_of, pack_stamp
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from tests.keys import made
from tests.runtime.system import wait_for
from tests.runtime.test_two_halves import Pair, follow, handled, on, pair

pytestmark = pytest.mark.xdist_group("live")
PATIENCE_S = 10.0
HOSTS = ("robot", "laptop", "desk")
RUN = 7


class Scene(NamedTuple):
    robot: Supervisor
    laptop: Supervisor
    desk: Supervisor
    system: System
    endpoint: str
    keys: Path

    @property
    def all(self) -> tuple[Supervisor, ...]:
        return self.robot, self.laptop, self.desk


@pytest.fixture(scope="module")
def scene(tmp_path_factory) -> Iterator[Scene]:
    """World and echo on the robot, student on the laptop, witness (a tap) on the desk; TLS, all links at the robot."""
    directory = tmp_path_factory.mktemp("guarded")
    keys = made(directory / "keys", *HOSTS, "visitor")
    plain = pair(directory)
    file = Path(plain.robot.file)
    head, _, tail = file.read_text(encoding="utf-8").rpartition('host = "laptop"')
    file.write_text(f'{head}host = "desk"{tail}', encoding="utf-8")
    robot, *others = (load(file, host=h, recording=directory / "heard.jsonl", keys=str(keys)) for h in HOSTS)
    endpoint = free_endpoint().replace("tcp/", "tls/")
    with pytest.MonkeyPatch.context() as patch, ExitStack() as stack:
        half = guarded(Link(endpoint), robot)
        halves = [stack.enter_context(on("robot", Pair(robot, robot, ""), directory, patch, link=half))]
        for system in others:
            half = guarded(Link("", endpoint), system)
            halves.append(stack.enter_context(on(system.host, Pair(robot, system, ""), directory, patch, link=half)))
        begun = Scene(*halves, robot, endpoint, keys)
        follow(lambda: handled(begun.laptop, "student") > 10 and handled(begun.robot, "echo") > 10, *halves)
        yield begun


@contextmanager
def intruder(scene: Scene, guard: dict[str, object]) -> Iterator[zenoh.Session]:
    """A router of somebody's own, with no rules at all, that dials the robot."""
    options = {"connect/exit_on_failure": False, "connect/timeout_ms": 0, **guard}
    with zenoh.open(_config("router", [free_endpoint()], [scene.endpoint], options)) as session:
        never_drop(session)
        yield session


def with_keys(keys: Path, host: str) -> dict[str, Any]:
    return Credentials(keys / host).options()


def attack(scene: Scene, session: zenoh.Session) -> list[zenoh.LivelinessToken]:
    """Announce a run as the robot's components and speak as they do; then as their own runs, which a recorder hears."""
    realm = scene.system.realm
    tokens = [
        session.liveliness().declare_token(ready_key(realm, 1, name, RUN)) for name in ("echo", "world", "nobody")
    ]
    for sequence in range(20):
        for key, message in (("echo/drive", BaseCommand(v_mps=1.0)), ("world/image", CompressedImage(format="none"))):
            (own,) = scene.robot._presence.runs(1, key.partition("/")[0])
            for run in (RUN, own):
                stamp, encoding = pack_stamp(run, 10**6 + sequence, 0), encoding_of(type(message))
                session.put(f"{realm}/{key}", message.SerializeToString(), attachment=stamp, encoding=encoding)
        time.sleep(0.005)
    return tokens


def goes_on(scene: Scene) -> None:
    """Frames are answered as before, and nobody has heard anything that had to be refused."""
    before = handled(scene.robot, "echo")
    follow(lambda: handled(scene.robot, "echo") > before + 6, *scene.all)
    assert [half.refused + half.lost for half in scene.all] == [0, 0, 0]
    assert not any(half._presence.is_announced(1, "", RUN) for half in scene.all)


def hears(session: zenoh.Session, realm: str) -> list[str]:
    heard: list[str] = []
    session.declare_subscriber(f"{realm}/**", lambda sample: heard.append(str(sample.key_expr)))
    session.liveliness().declare_subscriber(
        f"{realm}/@ready/*/*/*", lambda sample: heard.append(str(sample.key_expr)), history=True
    )
    return heard


def linked(session: zenoh.Session) -> bool:
    return bool(list(session.info.routers_zid()))


def test_a_system_with_keys_works_as_one_without(scene):
    goes_on(scene)
    assert [half.lost for half in scene.all] == [0, 0, 0]


def test_a_recorder_on_a_third_machine_hears_the_second_through_the_first(scene):
    """`student/word` is said on the laptop; the desk is linked with the robot alone."""
    assert [link.auth_identifier for link in links(scene.desk) if link.auth_identifier] == ["robot"]
    file = Path(load(scene.system.file, recording=Path("x")).file).parent / "heard.jsonl"
    assert wait_for(lambda: '"student/word"' in file.read_text(encoding="utf-8"), PATIENCE_S)


def test_the_link_is_tls_and_everything_else_is_loopback(scene):
    found = {(link.auth_identifier, str(link.src).partition("/")[0]) for link in links(scene.robot)}
    assert found == {(None, "tcp"), ("laptop", "tls"), ("desk", "tls")}
    assert all(str(link.src).startswith("tcp/127.0.0.1:") for link in links(scene.robot) if not link.auth_identifier)


def links(half: Supervisor) -> list[zenoh.Link]:
    return list(half._meeting._session.info.links())


def test_without_a_valid_certificate_of_ours_nobody_gets_a_link(scene, tmp_path):
    """A laptop without any, one of another authority that trusts ours, one of ours that has expired; and one good."""
    good = with_keys(scene.keys, "visitor")
    bare = {k: v for k, v in good["transport/link/tls"].items() if not k.startswith("connect_")}
    foreign = with_keys(made(tmp_path / "foreign", "laptop"), "laptop")
    foreign["transport/link/tls"]["root_ca_certificate"] = str(scene.keys / "authority.pem")
    Authority.read(scene.keys).admit("laptop", tmp_path / "laptop", 1, datetime.now(UTC) - timedelta(days=5))
    attempts = [{"transport/link/tls": {**bare, "enable_mtls": False}}, foreign, with_keys(tmp_path, "laptop"), good]
    with ExitStack() as stack:
        *bad, visitor = [stack.enter_context(intruder(scene, options)) for options in attempts]
        heard = [hears(session, scene.system.realm) for session in bad]
        assert wait_for(lambda: linked(visitor), PATIENCE_S)
        goes_on(scene)
        assert [linked(session) for session in bad] == [False] * 3
        assert heard == [[]] * 3


def test_a_certificate_that_the_launch_file_does_not_name_is_noted_and_neither_hears_nor_speaks(scene):
    with intruder(scene, with_keys(scene.keys, "visitor")) as session:
        heard = hears(session, scene.system.realm)
        assert wait_for(lambda: linked(session), PATIENCE_S)
        goes_on(scene)
        assert heard == []
        tokens = attack(scene, session)
        goes_on(scene)
        assert len(tokens) == 3
    log = Path(scene.robot.run.directory) / "supervisor.log"
    assert wait_for(lambda: "has a key and no part in this system" in log.read_text(encoding="utf-8"), PATIENCE_S)
    assert "visitor at tls/127.0.0.1:" in log.read_text(encoding="utf-8")


@pytest.mark.parametrize("host", ["laptop", "desk"])
def test_a_host_of_the_system_can_not_speak_for_another(scene, host):
    """Its own router lets nothing out; so this one has none of its rules, but its keys."""
    with intruder(scene, with_keys(scene.keys, host)) as session:
        assert wait_for(lambda: linked(session), PATIENCE_S)
        tokens = attack(scene, session)
        goes_on(scene)
        assert len(tokens) == 3


def test_a_laptop_with_foreign_keys_is_told_so_in_one_line_before_anything_starts(scene, tmp_path):
    foreign = load(
        scene.system.file, host="laptop", keys=str(made(tmp_path / "foreign", "laptop")), recording=tmp_path / "x"
    )
    with pytest.raises(ConfigurationError, match=r"--connect tls/.*: the host there must have keys of .*authority.pem"):
        guarded(Link("", scene.endpoint), foreign)


def test_a_laptop_whose_keys_the_robot_refuses_is_told_so_in_one_line(scene, tmp_path):
    foreign = made(tmp_path / "foreign", "laptop")
    (foreign / "laptop" / "authority.pem").write_bytes(
        (scene.keys / "authority.pem").read_bytes() + (foreign / "authority.pem").read_bytes()
    )
    laptop = load(scene.system.file, host="laptop", keys=str(foreign), recording=tmp_path / "x")
    with pytest.raises(ConfigurationError, match=r"the host there refuses .*certificate.pem; are its keys of the same"):
        guarded(Link("", scene.endpoint), laptop)
