# Needs Python >= 3.11, make, and the PyPI and npm registries; everything else is fetched into .tools and .venv.
PYTHON ?= python3
UV     := $(or $(shell command -v uv 2>/dev/null),.tools/bin/uv)
BIN    := .venv/bin
STAMP  := .venv/.installed
NODE   := $(BIN)/python tools/node.py
KERNELS := $(wildcard app/vision/native/*.[ch])
FRONTEND := $(shell find frontend/src frontend/public frontend/index.html frontend/*.json frontend/*.ts -type f 2>/dev/null)

.DEFAULT_GOAL := setup
.PHONY: setup demo test suite lint checks types format kernels sanitize bench screenshots openapi lock clean

setup: $(STAMP)

$(STAMP): pyproject.toml requirements.lock build_hook.py build_frontend.py build_native.py $(KERNELS) $(FRONTEND)
	test -x "$(UV)" || { $(PYTHON) -m venv .tools && .tools/bin/python -m pip install --quiet "uv>=0.5"; }
	test -x $(BIN)/python || $(UV) venv --quiet --python $(PYTHON) .venv
	$(UV) pip sync --quiet --python $(BIN)/python --require-hashes requirements.lock
	$(UV) pip install --quiet --python $(BIN)/python --no-deps --editable .
	touch $@

demo: setup
	$(BIN)/clearlines demo $(ARGS)

# A thread per process, there are as many as cores. Byte code is kept: else each server would compile all it imports.
test: export OMP_NUM_THREADS = 1
test: export OPENBLAS_NUM_THREADS = 1
test: export OPENCV_FOR_THREADS_NUM = 1
test: export PYTHONDONTWRITEBYTECODE =

# Types take a minute of one processor: they are checked beside the tests, which often wait.
test: checks
	$(MAKE) --no-print-directory -j 2 suite types

suite: setup
	$(NODE) vitest run
	$(BIN)/python tools/browser.py
	$(BIN)/pytest -n 2 --dist loadfile --no-loadscope-reorder $(ARGS)

lint: checks types

types: setup
	nice -n 15 $(NODE) pyright --project ../pyproject.toml --warnings
	nice -n 15 $(NODE) tsc --noEmit

checks: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/clang-format --dry-run --Werror $(KERNELS)
	$(BIN)/python tools/kernels.py warnings
	$(NODE) biome check .

format: setup
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .
	$(BIN)/clang-format -i $(KERNELS)
	$(NODE) biome check --write .

# Compiles the detector's kernels alone, with a compiler that is there; setup does it too, and fetches one if need be.
kernels:
	$(BIN)/python build_native.py

# The detector's tests with kernels that watch their own memory access and arithmetic; Linux with gcc.
sanitize: setup
	$(BIN)/python tools/kernels.py sanitize $(ARGS)

bench: setup
	$(BIN)/python tools/bench.py $(ARGS)

screenshots: setup
	$(BIN)/python tools/browser.py
	$(BIN)/python tools/screenshots.py

# The browser tool's types follow the server's OpenAPI document; a test says so when they don't.
openapi: setup
	$(BIN)/python tools/openapi.py
	$(NODE) openapi-typescript src/api/openapi.json --output src/api/schema.ts

# Neither lock file names a registry's address.
lock:
	test -x "$(UV)" || { $(PYTHON) -m venv .tools && .tools/bin/python -m pip install --quiet "uv>=0.5"; }
	$(UV) pip compile --quiet --universal --python-version 3.11 --extra dev --generate-hashes --no-emit-index-url \
		--no-emit-find-links --custom-compile-command "make lock" --output-file requirements.lock pyproject.toml $(ARGS)
	$(BIN)/python tools/lock_frontend.py

clean:
	rm -rf .venv .tools app/static app/vision/native/_kernels.* frontend/node_modules dist
