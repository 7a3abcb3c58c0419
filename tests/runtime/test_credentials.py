"""Keys that are not fit for use are refused, by name, before anything starts."""

import shutil
from datetime import UTC, datetime
from pathlib import Path

import pytest
from cryptography.x509 import load_pem_x509_certificate

from cli.authority import Authority
from runtime.credentials import checked_credentials
from runtime.params import ConfigurationError
from tests.keys import made


@pytest.fixture
def keys(tmp_path) -> Path:
    return made(tmp_path / "keys", "robot", "laptop")


def refused(keys: Path, words: str) -> None:
    with pytest.raises(ConfigurationError, match=words) as found:
        checked_credentials(keys, "robot")
    assert "\n" not in str(found.value)


def test_keys_as_they_are_made_are_fit_for_use(keys):
    found = checked_credentials(keys, "robot")
    assert found.options()["transport/link/tls"]["enable_mtls"] is True
    assert found.options()["transport/link/tls"]["root_ca_certificate"] == str(keys / "robot" / "authority.pem")


@pytest.mark.parametrize("name", ["authority.pem", "certificate.pem", "key.pem"])
def test_a_missing_file_is_named(keys, name):
    (keys / "robot" / name).unlink()
    refused(keys, f"robot/{name}: must be there, made by `berth keys init` and copied to this host: No such file")


def test_a_host_without_keys_is_named(tmp_path):
    refused(tmp_path, "robot: must be there, made by `berth keys init`")


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660, 0o777])
def test_a_private_key_that_others_can_read_is_refused(keys, mode):
    (keys / "robot" / "key.pem").chmod(mode)
    refused(keys, rf"key.pem: must be open to its owner alone \(chmod 600\); got {mode:04o}")


@pytest.mark.parametrize("name", ["authority.pem", "certificate.pem", "."])
def test_what_others_can_write_is_refused(keys, name):
    (keys / "robot" / name).chmod(0o722)
    refused(keys, r"must be writable by its owner alone \(chmod go-w\); got 0722")


def test_an_expired_certificate_is_refused(tmp_path):
    refused(
        made(tmp_path / "old", "robot", age_days=31.0), "certificate.pem: must be valid now.*certificate has expired"
    )


def test_a_certificate_of_the_future_is_refused(tmp_path):
    refused(made(tmp_path / "new", "robot", age_days=-3.0), "certificate.pem: must be valid now.*is not yet valid")


def test_a_certificate_of_another_authority_is_refused(keys, tmp_path):
    other = made(tmp_path / "other", "robot")
    shutil.copy(other / "robot" / "authority.pem", keys / "robot" / "authority.pem")
    refused(keys, "certificate.pem: must be valid now and signed by .*authority.pem; got: ")


def test_another_host_s_keys_are_refused(keys):
    shutil.rmtree(keys / "robot")
    (keys / "laptop").rename(keys / "robot")
    refused(keys, "certificate.pem: its common name must be 'robot', this host; got 'laptop'")


def test_another_certificate_s_key_is_refused(keys):
    (keys / "robot" / "key.pem").write_bytes((keys / "laptop" / "key.pem").read_bytes())
    refused(keys, "key.pem: must be the key of .*certificate.pem")


@pytest.mark.parametrize("junk", [b"", b"-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n", b"\xff" * 99])
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("authority.pem", "authority.pem: must hold a certificate as PEM"),
        ("certificate.pem", "must hold a key as PEM for"),
        ("key.pem", "key.pem: must hold a key as PEM for"),
    ],
)
def test_what_is_no_pem_is_refused(keys, name, words, junk):
    (keys / "robot" / name).write_bytes(junk)
    refused(keys, words)


def test_an_authority_can_not_be_used_as_a_host(keys):
    """Who has the signing key needs no trick; nobody else shall be able to use the authority's certificate as one."""
    shutil.copy(keys / "authority.pem", keys / "robot" / "certificate.pem")
    shutil.copy(keys / "authority-key.pem", keys / "robot" / "key.pem")
    refused(keys, "certificate.pem: (must be|its common name must be)")


def test_a_certificate_is_never_valid_longer_than_its_authority(tmp_path):
    now = datetime.now(UTC)
    authority = Authority.new(10, now)
    authority.admit("robot", tmp_path / "robot", 1000, now)
    certificate = load_pem_x509_certificate((tmp_path / "robot" / "certificate.pem").read_bytes())
    assert certificate.not_valid_after_utc <= authority.certificate.not_valid_after_utc
