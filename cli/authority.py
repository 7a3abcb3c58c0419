"""A small certificate authority for the hosts of one system: who holds a certificate of it may take part."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from runtime.credentials import AUTHORITY, CERTIFICATE, KEY
from runtime.params import ConfigurationError

SIGNING_KEY = "authority-key.pem"
"""Private key of the authority; no host needs it."""
_NAME = "Berth"
_SKEW = timedelta(days=1)
"""A robot's clock may be behind when it starts."""
_USES = ("digital_signature", "content_commitment", "key_encipherment", "data_encipherment", "key_agreement",
         "key_cert_sign", "crl_sign", "encipher_only", "decipher_only")  # fmt: skip


@dataclass(frozen=True)
class Authority:
    """Signs the certificates of hosts."""

    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey

    @staticmethod
    def new(days: int, now: datetime) -> Authority:
        """An authority that nobody knows yet, valid so many days from now."""
        key = ec.generate_private_key(ec.SECP256R1())
        draft = _draft(_NAME, _named(_NAME), key, days, now)
        draft = draft.add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        draft = draft.add_extension(_usage("key_cert_sign"), critical=True)
        draft = draft.add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        return Authority(draft.sign(key, SHA256()), key)

    @staticmethod
    def read(directory: Path) -> Authority:
        """The authority of a directory that `write` wrote.

        Raises:
            ConfigurationError: there is none.
        """
        try:
            certificate = x509.load_pem_x509_certificate((directory / AUTHORITY).read_bytes())
            key = load_pem_private_key((directory / SIGNING_KEY).read_bytes(), None)
        except (OSError, ValueError, TypeError):
            raise ConfigurationError(
                f"{directory}: must hold {AUTHORITY} and {SIGNING_KEY}; see `berth keys init`"
            ) from None
        if not isinstance(key, ec.EllipticCurvePrivateKey) or key.public_key() != certificate.public_key():
            raise ConfigurationError(f"{directory / SIGNING_KEY}: must be the key of {AUTHORITY}")
        return Authority(certificate, key)

    def write(self, directory: Path) -> None:
        """Write certificate and private key."""
        _write(directory / AUTHORITY, self.certificate.public_bytes(Encoding.PEM), 0o644)
        _write(directory / SIGNING_KEY, _pem(self.key), 0o600)

    def admit(self, host: str, directory: Path, days: int, now: datetime) -> None:
        """Write a host's key and certificate, and the authority's certificate, into a directory of its own.

        Args:
            host: name in the launch file; it becomes the certificate's common name.
            directory: to make for it.
            days: that the certificate is valid from now; never longer than the authority.
            now: wall-clock time.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        days = min(days, (self.certificate.not_valid_after_utc - now).days)
        issuer = self.certificate.subject
        draft = _draft(host, issuer, key, days, now)
        draft = draft.add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        draft = draft.add_extension(_usage("digital_signature"), critical=True)
        uses = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]
        draft = draft.add_extension(x509.ExtendedKeyUsage(uses), critical=False)
        draft = draft.add_extension(x509.SubjectAlternativeName([x509.DNSName(host)]), critical=False)
        signer = x509.AuthorityKeyIdentifier.from_issuer_public_key(self.key.public_key())
        certificate = draft.add_extension(signer, critical=False).sign(self.key, SHA256())
        directory.mkdir(mode=0o700)
        _write(directory / AUTHORITY, self.certificate.public_bytes(Encoding.PEM), 0o644)
        _write(directory / CERTIFICATE, certificate.public_bytes(Encoding.PEM), 0o644)
        _write(directory / KEY, _pem(key), 0o600)


def check_free(paths: Sequence[Path]) -> None:
    """Refuse to overwrite.

    Raises:
        ConfigurationError: names the first path that is taken.
    """
    for path in paths:
        if os.path.lexists(path):
            raise ConfigurationError(f"{path}: must not exist yet; keys are never overwritten")


def _draft(
    name: str, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, days: int, now: datetime
) -> x509.CertificateBuilder:
    draft = x509.CertificateBuilder(issuer, _named(name), key.public_key(), x509.random_serial_number())
    return draft.not_valid_before(now - _SKEW).not_valid_after(now + timedelta(days=days))


def _named(name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])


def _usage(use: str) -> x509.KeyUsage:
    return x509.KeyUsage(**{name: name == use for name in _USES})


def _pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())


def _write(path: Path, data: bytes, mode: int) -> None:
    """Into a new file that never was open to more than `mode` says."""
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, mode), "wb") as stream:
        stream.write(data)
