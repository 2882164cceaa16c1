# Everything is installed into .venv, by each target what it needs. The rest of the machine is
# unchanged, but for pip's cache.
PYTHON ?= python3
BIN := .venv/bin
CHECKOUT := $(CURDIR)
include workshop/environment.mk

# `$(SET_UP) NAME` makes what is missing or no longer fits. It runs with the Python of .venv, unless
# that has none, or make was given a different Python.
ASKED := $(if $(filter-out file,$(origin PYTHON)),--asked)
OLD = import sys; sys.version_info < (3, 11) and sys.exit(sys.version.split()[0])
SET_UP = @python='$(PYTHON)'; \
  [ -n '$(ASKED)' ] || ! $(BIN)/python -IS -c '' 2> /dev/null || python=$(BIN)/python; \
  command -v "$$python" > /dev/null || \
    { echo "make: PYTHON must be Python 3.11 or later, got $$python: not found"; exit 1; }; \
  version=$$("$$python" -IS -c '$(OLD)' 2>&1) || \
    { echo "make: PYTHON must be Python 3.11 or later, got $$python: $$version; name one: make PYTHON=python3.12"; exit 1; }; \
  "$$python" -IS workshop/set_up.py $(ASKED)

# Of three processes one waits for nodes and pages while two compute. A file stays in one, which
# keeps what its tests share.
PYTEST := $(BIN)/python -m pytest -q
TOGETHER := -n 3 --dist loadfile
UNTIMED := not realtime and not long
# A hold, the question, a clamp, a pull, a step of the lesson and a fit, on pages that are slowed down.
SLOWED := holds.py first_minute.py clamp.py \
  charts.py::test_the_axle_of_a_top_that_waits_sets_its_tilt_and_of_one_that_runs_is_pushed \
  lesson.py::test_a_keyboard_does_a_step_on_a_phone \
  fit.py::test_the_page_fits_in_a_thread_and_its_motion_runs_meanwhile

.NOTPARALLEL:  # two runs of pip would meet in one environment
.PHONY: help demo panel test test-all test-rest test-slow test-old-processor test-without-ros test-realtime test-long test-keys test-elsewhere test-newcomer test-ubuntu test-kilted test-cyclone lint style types docs wheels kernel-wasm clean

help:  ## show this list
	@grep -E '^[a-z-]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 20
	@echo "make -C workshop help lists what measures, draws and counts"

demo:  ## a top on cusps, hurried by its service, and the replay
	$(SET_UP) ros
	@$(BIN)/python -m workshop.demo

panel:  ## the page, top.html, opened in the browser; needs no ROS and no compiler
	$(SET_UP) panel
	@$(BIN)/python -c 'from symtop_ros.programs import top_panel; raise SystemExit(top_panel())'

test:  ## quick tests (5 minutes on two free cores; 1.5 GB, once)
	$(SET_UP) quick chromium
	@HEADLESS_SHELL=1 $(PYTEST) $(TOGETHER) --durations=10 --cpu 1 test

test-all: test test-rest  ## the quick tests, and all that `make test-rest` has (20 minutes; 2 GB, once)

# Each runs, whatever came of those before it.
test-rest:  ## slow tests, tests as on other machines and in real time, style and types
	@$(MAKE) --no-print-directory --keep-going \
	  test-slow test-old-processor test-without-ros style types test-realtime

test-slow:
	$(SET_UP) test chromium messages vulkan
	@$(PYTEST) $(TOGETHER) -m slow test

# On an old processor BLAS, NumPy and the C library round otherwise.
test-old-processor:
	$(SET_UP) test
	@$(BIN)/python test/processors.py Nehalem $(PYTEST) $(TOGETHER) -m "numbers and $(UNTIMED)" test/physics test/run

# As on a laptop without ROS and Rerun.
test-without-ros:
	$(SET_UP) test chromium
	@$(PYTEST) $(TOGETHER) -p without_ros -m "$(UNTIMED)" test/run/simulation test/run/session test/run/log test/page/panel

# One after the other: they measure the time.
test-realtime:
	$(SET_UP) test chromium
	@$(PYTEST) -m realtime test

test-long: test-keys test-elsewhere test-newcomer test-ubuntu test-kilted  ## trials that take longer (two hours), coverage, and the matrix
	$(SET_UP) peers docs aarch64 wine zig gpu
	@$(MAKE) --no-print-directory -C workshop coverage matrix
	@$(PYTEST) -m long test
	@SLOWED_PAGES=20 $(PYTEST) -m "$(UNTIMED)" $(foreach each,$(SLOWED),test/page/web/test_page_$(each))

test-keys:  ## tests of all but wording, every template replaced by its key
	$(SET_UP) test
	@PYTHONPATH=test/keys $(PYTEST) $(TOGETHER) -m "$(UNTIMED) and not wording" test

test-elsewhere:  ## tests of numbers and logs as on other processors, in other countries, for a stranger (20 minutes)
	$(SET_UP) test
	@$(BIN)/python test/elsewhere.py

test-newcomer:  ## the README and all documents typed by a new user; Pythons, pulls, a moved folder, no network (40 minutes)
	$(SET_UP) test
	@$(BIN)/python test/newcomer.py

test-ubuntu:  ## tests of node and client with NumPy 1.26 and pytest 7.4, as on Ubuntu 24.04
	$(SET_UP) ubuntu
	@.venv/ubuntu/bin/python -m pytest -q -m "$(UNTIMED)" \
	  test/ros/client test/ros/node/test_topics.py test/ros/node/test_recording.py

test-kilted:  ## tests of node, client and log on ROS 2 Kilted
	$(SET_UP) kilted
	@.venv/kilted/bin/python workshop/messages.py
	@.venv/kilted/bin/python -m pytest -q -m "$(UNTIMED)" --ignore=test/run/log/test_definitions.py \
	  test/ros/node test/ros/client test/run/log test/run/simulation/test_simulation.py

test-cyclone:  ## tests of the node on CycloneDDS; CYCLONE=FOLDER: its libraries, as docs/ros.md says
	$(SET_UP) test
	@$(BIN)/python test/cyclone.py '$(CYCLONE)'

lint: style types  ## ruff, clang-format, codespell and mypy; Biome and TypeScript for the page

style types:
	$(SET_UP) test js
	@$(BIN)/python test/lint.py $@

docs:  ## the HTML site of README, docs and library in site/; warnings are errors
	$(SET_UP) docs
	@$(BIN)/python -m sphinx -q -W --keep-going -c docs/site -b html . site
	@$(BIN)/top_panel --write site/top.html
	@echo "wrote site/README.html"

wheels:  ## wheels with the compiled kernel for Linux, macOS and Windows, in dist/ (3 minutes)
	$(SET_UP) zig
	@.venv/zig/bin/python workshop/wheels.py dist

kernel-wasm:  ## the kernel in WebAssembly, symtop_ros/page/web/kernel.wasm (1 minute)
	$(SET_UP) zig
	@.venv/zig/bin/python workshop/kernel_wasm.py

clean:  ## remove the environment and all that was built; logs/ and report/ stay
	rm -rf .venv site build dist install log *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find symtop_ros test workshop examples docs -name __pycache__ -prune -exec rm -rf {} +
	find symtop_ros -name 'libsymtop.*' -delete

# For those below this folder: what a set-up has is fetched or made, if it does not fit.
set-up-%:
	$(SET_UP) $*
