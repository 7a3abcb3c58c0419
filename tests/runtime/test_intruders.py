"""A system with keys on two hosts, and who else comes to its door."""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import zenoh

from cli.authority import Authority
from runtime.bus import _config, free_endpoint, ready_key
from runtime.credentials import Credentials
from runtime.guard import guarded
from runtime.launch import load
from runtime.link import Link
from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from runtime.wire import encoding_of, pack_stamp
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from tests.keys import made
from tests.runtime.system import wait_for
from tests.runtime.test_two_halves import Pair, follow, handled, on, pair

pytestmark = pytest.mark.xdist_group("live")
PATIENCE_S = 10.0
RUN = 7


class Scene(NamedTuple):
    robot: Supervisor
    laptop: Supervisor
    pair: Pair
    keys: Path


@pytest.fixture(scope="module")
def scene(tmp_path_factory) -> Iterator[Scene]:
    """World and echo on the robot, student and witness (a tap) on the laptop, joined by TLS."""
    directory = tmp_path_factory.mktemp("guarded")
    keys = made(directory / "keys", "robot", "laptop", "desk")
    plain = pair(directory)
    halves = [load(plain.robot.file, host=h, recording=directory / "x", keys=str(keys)) for h in ("robot", "laptop")]
    both = Pair(*halves, free_endpoint().replace("tcp/", "tls/"))
    with pytest.MonkeyPatch.context() as patch, ExitStack() as stack:
        robot = stack.enter_context(on("robot", both, directory, patch, link=guarded(Link(both.endpoint), both.robot)))
        link = guarded(Link("", both.endpoint), both.laptop)
        laptop = stack.enter_context(on("laptop", both, directory, patch, link=link))
        follow(lambda: handled(laptop, "student") > 10 and handled(robot, "echo") > 10, robot, laptop)
        yield Scene(robot, laptop, both, keys)


@contextmanager
def intruder(scene: Scene, guard: dict[str, object]) -> Iterator[zenoh.Session]:
    """A router of somebody's own, with no rules at all, that dials the robot."""
    options = {"connect/exit_on_failure": False, "connect/timeout_ms": 0, **guard}
    with zenoh.open(_config("router", [free_endpoint()], [scene.pair.endpoint], options)) as session:
        yield session


def with_keys(keys: Path, host: str) -> dict[str, Any]:
    return Credentials(keys / host).options()


def attack(scene: Scene, session: zenoh.Session) -> list[zenoh.LivelinessToken]:
    """Announce a run as the robot's components, and speak as they do, in every way that the door asks for."""
    realm = scene.pair.robot.realm
    tokens = [session.liveliness().declare_token(ready_key(realm, 1, name, RUN)) for name in ("echo", "world")]
    for sequence in range(20):
        for key, message in (("echo/drive", BaseCommand(v_mps=1.0)), ("world/image", CompressedImage(format="none"))):
            stamp, encoding = pack_stamp(RUN, sequence, 0), encoding_of(type(message))
            session.put(f"{realm}/{key}", message.SerializeToString(), attachment=stamp, encoding=encoding)
        time.sleep(0.005)
    return tokens


def goes_on(scene: Scene) -> None:
    """Frames are answered as before, and nobody has heard anything that had to be refused."""
    before = handled(scene.robot, "echo")
    follow(lambda: handled(scene.robot, "echo") > before + 6, scene.robot, scene.laptop)
    statuses = (*scene.robot.statuses.values(), *scene.laptop.statuses.values())
    assert {status.malformed for status in statuses} == {0}
    assert RUN not in scene.robot._presence.runs(1, "echo") | scene.laptop._presence.runs(1, "echo")


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
    assert scene.laptop.lost == scene.robot.lost == 0


def test_the_link_is_tls_and_everything_else_is_loopback(scene):
    links = list(scene.robot._meeting._session.info.links())
    assert {link.auth_identifier for link in links} == {None, "laptop"}
    assert {str(link.src).partition("/")[0] for link in links if link.auth_identifier} == {"tls"}


def test_without_a_valid_certificate_of_ours_nobody_gets_a_link(scene, tmp_path):
    """A laptop without any, one of another authority that trusts ours, one of ours that has expired; and one good."""
    good = with_keys(scene.keys, "desk")
    bare = {k: v for k, v in good["transport/link/tls"].items() if not k.startswith("connect_")}
    foreign = with_keys(made(tmp_path / "foreign", "laptop"), "laptop")
    foreign["transport/link/tls"]["root_ca_certificate"] = str(scene.keys / "authority.pem")
    Authority.read(scene.keys).admit("laptop", tmp_path / "laptop", 1, datetime.now(UTC) - timedelta(days=5))
    attempts = [{"transport/link/tls": {**bare, "enable_mtls": False}}, foreign, with_keys(tmp_path, "laptop"), good]
    with ExitStack() as stack:
        *bad, desk = [stack.enter_context(intruder(scene, options)) for options in attempts]
        heard = [hears(session, scene.pair.robot.realm) for session in bad]
        assert wait_for(lambda: linked(desk), PATIENCE_S)
        goes_on(scene)
        assert [linked(session) for session in bad] == [False] * 3
        assert heard == [[]] * 3


def test_a_certificate_that_the_launch_file_does_not_name_is_noted_and_neither_hears_nor_speaks(scene):
    with intruder(scene, with_keys(scene.keys, "desk")) as session:
        heard = hears(session, scene.pair.robot.realm)
        assert wait_for(lambda: linked(session), PATIENCE_S)
        goes_on(scene)
        assert heard == []
        tokens = attack(scene, session)
        goes_on(scene)
        assert len(tokens) == 2
    log = Path(scene.robot.run.directory) / "supervisor.log"
    assert wait_for(lambda: "has a key and no part in this system" in log.read_text(encoding="utf-8"), PATIENCE_S)
    assert "desk at tls/127.0.0.1:" in log.read_text(encoding="utf-8")


def test_the_laptop_itself_can_not_speak_for_the_robot(scene):
    """Its own router lets nothing out; so this one has none of its rules, but its keys."""
    with intruder(scene, with_keys(scene.keys, "laptop")) as session:
        assert wait_for(lambda: linked(session), PATIENCE_S)
        tokens = attack(scene, session)
        goes_on(scene)
        assert len(tokens) == 2


def test_a_laptop_with_foreign_keys_is_told_so_in_one_line_before_anything_starts(scene, tmp_path):
    foreign = load(
        scene.pair.robot.file, host="laptop", keys=str(made(tmp_path / "foreign", "laptop")), recording=tmp_path / "x"
    )
    with pytest.raises(ConfigurationError, match=r"--connect tls/.*: the host there must have keys of .*authority.pem"):
        guarded(Link("", scene.pair.endpoint), foreign)


def test_a_laptop_whose_keys_the_robot_refuses_is_told_so_in_one_line(scene, tmp_path):
    foreign = made(tmp_path / "foreign", "laptop")
    (foreign / "laptop" / "authority.pem").write_bytes(
        (scene.keys / "authority.pem").read_bytes() + (foreign / "authority.pem").read_bytes()
    )
    laptop = load(scene.pair.robot.file, host="laptop", keys=str(foreign), recording=tmp_path / "x")
    with pytest.raises(ConfigurationError, match=r"the host there refuses .*certificate.pem; are its keys of the same"):
        guarded(Link("", scene.pair.endpoint), laptop)
