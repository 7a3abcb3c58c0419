"""The generated modules are those of the .proto files."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_generated_modules_are_up_to_date(tmp_path):
    protos = sorted(str(file.relative_to(ROOT)) for file in (ROOT / "schemas").glob("*.proto"))
    command = [sys.executable, "-m", "grpc_tools.protoc", "-I", ".", f"--python_out={tmp_path}",
               f"--pyi_out={tmp_path}", *protos]  # fmt: skip
    subprocess.run(command, cwd=ROOT, check=True)
    made = sorted(tmp_path.rglob("*_pb2.py*"))
    assert made
    for file in made:
        assert file.read_text() == (ROOT / file.relative_to(tmp_path)).read_text(), f"run `make schemas`: {file.name}"


def test_no_map_fields_because_their_bytes_have_no_order():
    for file in (ROOT / "schemas").glob("*.proto"):
        assert "map<" not in file.read_text(encoding="utf-8")
