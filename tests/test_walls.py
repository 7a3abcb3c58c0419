"""The walls of the house: who may import whom, and who may see the truth."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
OUTSIDE_WORLD = {
    "zenoh", "mcap", "serial", "threading", "multiprocessing", "subprocess", "time", "socket", "asyncio", "pathlib",
    "datetime", "random", "os", "io", "tempfile", "shutil", "queue", "concurrent", "selectors", "signal",
}  # fmt: skip
PURE = {"docking", "runtime.params", "runtime.contract"}
TAPS = {"recorder", "viewer"}


def imports(file):
    """Dotted names that a file imports."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            whole = node.module.count(".") == 0 and (ROOT / node.module).is_dir()
            yield from (f"{node.module}.{alias.name}" for alias in node.names) if whole else (node.module,)


def sources(*folders):
    return [
        file
        for folder in folders
        for file in sorted((ROOT / folder).rglob("*.py"))
        if not file.name.endswith("_pb2.py") and "devices" not in file.relative_to(ROOT).parts
    ]


def component_of(file):
    parts = file.relative_to(ROOT).parts
    return parts[1] if len(parts) > 2 else ""


def is_below(module, packages):
    return any(module == package or module.startswith(package + ".") for package in packages)


@pytest.mark.parametrize("file", sources("components", "docking"), ids=lambda f: str(f.relative_to(ROOT)))
def test_components_and_docking_do_not_touch_the_world(file):
    if component_of(file) in TAPS:
        return
    touched = {module for module in imports(file) if module.split(".")[0] in OUTSIDE_WORLD}
    assert not touched


@pytest.mark.parametrize("file", sources("components"), ids=lambda f: str(f.relative_to(ROOT)))
def test_components_never_import_one_another(file):
    own = f"components.{component_of(file)}"
    neighbours = {m for m in imports(file) if m.startswith("components.") and not is_below(m, {own})}
    assert not neighbours


@pytest.mark.parametrize("file", sources("components"), ids=lambda f: str(f.relative_to(ROOT)))
def test_only_ports_component_and_messages_know_messages_and_the_runtime(file):
    if component_of(file) in TAPS:
        return
    allowed = PURE if file.name not in {"ports.py", "component.py", "messages.py"} else PURE | {"schemas"}
    ours = {m for m in imports(file) if m.split(".")[0] in {"runtime", "schemas", "cli", "experiments", "report"}}
    assert {m for m in ours if not is_below(m, allowed)} == set()


@pytest.mark.parametrize("file", sources("docking"), ids=lambda f: str(f.relative_to(ROOT)))
def test_docking_is_pure(file):
    allowed = {"docking", "runtime.params", "numpy", "numba", "math", "dataclasses", "typing", "collections", "json",
               "struct", "hashlib", "functools", "itertools", "enum", "__future__"}  # fmt: skip
    if file.name == "env.py":
        allowed |= {"gymnasium"}
    assert {m for m in imports(file) if not is_below(m, allowed)} == set()


@pytest.mark.parametrize("file", sources("runtime"), ids=lambda f: str(f.relative_to(ROOT)))
def test_the_runtime_names_no_component_and_knows_no_task(file):
    foreign = {"components", "docking", "cli", "report", "experiments", "numpy", "numba", "filterpy"}
    assert {m for m in imports(file) if is_below(m, foreign)} == set()
    names = {folder.name for folder in (ROOT / "components").iterdir() if folder.is_dir()} - {"base", "head", "camera"}
    texts = {
        node.value
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and "\n" not in node.value
    }
    assert not texts & names


@pytest.mark.parametrize("file", sources("components", "docking", "runtime", "report", "experiments"),
                         ids=lambda f: str(f.relative_to(ROOT)))  # fmt: skip
def test_nothing_imports_the_command(file):
    assert not {m for m in imports(file) if m == "cli" or m.startswith("cli.")}


def test_only_the_command_view_knows_the_viewers():
    foreign = {"rerun", "rerun_cli", "rerun_bindings", "foxglove"}
    for file in sources("components", "docking", "runtime", "schemas", "report", "experiments", "cli"):
        if any(word in file.read_text(encoding="utf-8") for word in ("rerun", "foxglove", "viewer")):
            assert not {m for m in imports(file) if is_below(m, foreign)}, file
            assert file == ROOT / "cli" / "view.py" or not {m for m in imports(file) if is_below(m, {"viewer"})}, file


def test_the_core_of_a_viewer_knows_no_viewer_and_touches_nothing():
    shells = {"front", "live", "loopback", "program", "recorded", "reel"}
    for file in sources("viewer"):
        translates = file.stem.startswith(("rerun_", "foxglove_"))
        mine = {m for m in imports(file) if is_below(m, {"rerun", "foxglove", "rerun_cli"})}
        assert translates or file.stem == "program" or not mine, file
        if not translates and file.stem not in shells:
            assert not {m for m in imports(file) if m.split(".")[0] in OUTSIDE_WORLD}, file


def test_no_component_reads_the_truth():
    readers = [file for file in sources("components") if "schemas.truth_pb2" in set(imports(file))]
    assert {component_of(file) for file in readers} <= {"simulator"}


def test_ports_import_nothing_slow():
    slow = {"numpy", "numba", "cv2", "filterpy", "scipy", "zenoh", "mcap"}
    for file in (ROOT / "components").glob("*/ports.py"):
        assert not {m for m in imports(file) if m.split(".")[0] in slow}, file


def test_no_source_uses_what_is_forbidden():
    for file in sources("components", "docking", "runtime", "cli", "report", "experiments"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        called = {node.func.id for node in ast.walk(tree)
                  if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}  # fmt: skip
        assert not called & {"eval", "exec", "compile"}, file
        assert not {m.split(".")[0] for m in imports(file)} & {"pickle", "marshal", "shelve", "dill"}, file
