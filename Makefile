# Berth: every target sets up what it needs first.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: demo test setup setup-view setup-dev lint docs docs-check schemas lock bench clean

demo: setup  ## the main job: a simulated robot learns to dock, from camera images
	$(BIN)/berth run launch/minutes.toml

test: setup-dev lint  ## lint, types and tests
	$(BIN)/pytest

setup: $(VENV)/lab.stamp  ## .venv with what the demo needs
setup-view: $(VENV)/view.stamp  ## what `berth view` needs: 720 MB more
setup-dev: $(VENV)/dev.stamp

$(VENV)/lab.stamp: requirements/lab.lock pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --require-hashes -r requirements/build.lock
	$(BIN)/python -m pip install --quiet --require-hashes -r $<
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	touch $@

$(VENV)/view.stamp: requirements/view.lock $(VENV)/lab.stamp
	$(BIN)/python -m pip install --quiet --require-hashes -r $<
	touch $@

$(VENV)/dev.stamp: requirements/dev.lock $(VENV)/lab.stamp
	$(BIN)/python -m pip install --quiet --require-hashes -r $<
	touch $@

lint: setup-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: setup-dev  ## the documentation, into build/docs; a broken link or page is an error
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict

docs-check: setup-dev  ## every command of the documentation, whole (half an hour)
	$(BIN)/python -m tests.docs

schemas: setup-dev  ## regenerate schemas/*_pb2.py
	$(BIN)/python -m grpc_tools.protoc -I . --python_out=. --pyi_out=. schemas/*.proto

lock:  ## resolve anew; uv is needed only here
	test -x $(VENV)/uv/bin/uv || { $(PYTHON) -m venv $(VENV)/uv && $(VENV)/uv/bin/pip install --quiet uv; }
	for role in robot lab view dev; do \
	  extra=$$([ $$role = robot ] || echo "--extra $$role"); \
	  $(VENV)/uv/bin/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
	    --no-emit-index-url --no-header pyproject.toml $$extra -o requirements/$$role.lock || exit 1; \
	done
	echo 'setuptools==80.9.0' | $(VENV)/uv/bin/uv pip compile --quiet --universal --generate-hashes \
	  --no-emit-index-url --no-header - -o requirements/build.lock

bench: setup-dev  ## every number we claim, with its floor
	$(BIN)/python -m benchmarks

clean:
	rm -rf $(VENV) build *.egg-info
