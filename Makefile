# Berth: every target sets up what it needs first.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: demo test setup setup-view setup-dev lint docs docs-check schemas sbom audit fuzz lock bench clean

demo: setup  ## the main job: a simulated robot learns to dock, from camera images
	$(BIN)/berth run launch/minutes.toml

test: setup-dev lint  ## lint, types and tests
	$(BIN)/pytest

setup: $(VENV)/lab.stamp  ## .venv with what the demo needs
setup-view: $(VENV)/view.stamp  ## what `berth view` needs: 720 MB more
setup-dev: $(VENV)/dev.stamp

# So that a package of yours beside ours is found, too.
BESIDE := --config-settings editable_mode=compat

$(VENV)/lab.stamp: requirements/lab.lock pyproject.toml Makefile
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --require-hashes -r requirements/build.lock
	$(BIN)/python -m pip install --quiet --require-hashes -r $<
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation $(BESIDE) --editable .
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

sbom: $(VENV)/supply.stamp  ## what is locked, as CycloneDX, into build/sbom
	mkdir -p build/sbom
	for role in robot lab view dev; do \
	  PYTHONWARNINGS=ignore $(VENV)/supply/bin/cyclonedx-py requirements --pyproject pyproject.toml --output-reproducible \
	    -o build/sbom/$$role.cdx.json requirements/$$role.lock || exit 1; \
	done

audit: $(VENV)/supply.stamp  ## known holes in what is locked; asks a database on the internet
	for role in robot lab view dev; do \
	  $(VENV)/supply/bin/pip-audit --strict --disable-pip --require-hashes -r requirements/$$role.lock || exit 1; \
	done

$(VENV)/supply.stamp: requirements/supply.lock
	test -x $(VENV)/supply/bin/python || $(PYTHON) -m venv $(VENV)/supply
	$(VENV)/supply/bin/python -m pip install --quiet --require-hashes -r $<
	touch $@

fuzz: $(VENV)/fuzz.stamp  ## every decoder, a minute each, guided by coverage
	$(BIN)/python -m benchmarks.fuzz

$(VENV)/fuzz.stamp: requirements/fuzz.lock $(VENV)/dev.stamp
	$(BIN)/python -m pip install --quiet --require-hashes -r $<
	touch $@

lock:  ## resolve anew; uv is needed only here
	test -x $(VENV)/uv/bin/uv || { $(PYTHON) -m venv $(VENV)/uv && $(VENV)/uv/bin/pip install --quiet uv; }
	for role in robot lab view dev; do \
	  extra=$$([ $$role = robot ] || echo "--extra $$role"); \
	  $(VENV)/uv/bin/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
	    --no-emit-index-url --no-header pyproject.toml $$extra -o requirements/$$role.lock || exit 1; \
	done
	while read role tools; do \
	  echo $$tools | tr ' ' '\n' | $(VENV)/uv/bin/uv pip compile --quiet --universal --python-version 3.11 \
	    --generate-hashes --no-emit-index-url --no-header - -o requirements/$$role.lock || exit 1; \
	done < requirements/tools

bench: setup-dev  ## every number we claim, with its floor
	$(BIN)/python -m benchmarks

clean:
	rm -rf $(VENV) build *.egg-info
