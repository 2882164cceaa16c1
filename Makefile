# Everything is installed into .venv, by `make test` what only some groups need when they start
# (test/groups.py). The rest of the machine is unchanged, but for pip's cache.
PYTHON ?= python3
VENV := .venv
# What is compiled at the installation.
SOURCES := setup.py build_kernel.py $(wildcard symtop_ros/physics/kernel/*.* symtop_ros/physics/kernel/*/*.hpp)
UBUNTU := .venv/ubuntu
KILTED := .venv/kilted
BIN := $(VENV)/bin
TOOLS := pytest hypothesis mpmath rosbags coverage
GROUPS := page nodes rest judge plain physics old-processor without-ros examples lint realtime
# A line every ten seconds, for as long as the shell of a recipe runs: pip may be silent for minutes.
TICK = ( n=0; while sleep 10 > /dev/null && kill -0 $$$$ 2> /dev/null; do n=$$((n + 10)); echo "  ... at work for $$n s"; done ) & \
  tick=$$!; trap 'kill $$tick' EXIT;
# Python compiles a module when it is first imported: 0.1 GB less than with all of them.
INSTALL = @$(TICK) $(BIN)/python -m pip install --no-compile --editable

HOUSE := $(CURDIR)
include $(dir $(abspath $(firstword $(MAKEFILE_LIST))))workshop/environment.mk

.NOTPARALLEL:  # two runs of pip would meet in one environment
.PHONY: help demo panel test $(addprefix test-,$(GROUPS)) test-long test-keys test-elsewhere test-ubuntu test-kilted lint style types types-js docs wheels kernel-wasm clean

help:  ## show this list
	@grep -E '^[a-z-]+:.*##' $(firstword $(MAKEFILE_LIST)) | sed -E 's/:.*## /\t/' | expand -t 20
	@echo "make test-GROUP runs one of: $(GROUPS)"
	@echo "make -C workshop help lists what measures, draws and counts"

demo: $(VENV)/ros  ## a top on cusps, hurried by its service, and the replay
	@$(BIN)/python -m workshop.demo

panel: $(VENV)/panel  ## the page, top.html, opened in the browser; needs no ROS and no compiler
	@$(BIN)/python -c 'from symtop_ros.programs import top_panel; raise SystemExit(top_panel())'

test: $(VENV)/test  ## style, types and all tests (6 minutes with the set-up; 2 GB, once)
	@$(BIN)/python test/groups.py

# What each group needs; `make test-physics` and the like run one of them.
test-page: $(VENV)/test $(VENV)/chromium
test-nodes: $(VENV)/test $(VENV)/messages/done
test-rest: $(VENV)/test $(VENV)/vulkan
test-judge: $(VENV)/test
test-plain: $(VENV)/test
test-physics: $(VENV)/test
test-old-processor: $(VENV)/test
test-without-ros: $(VENV)/test
test-examples: $(VENV)/test
test-lint: $(VENV)/test $(VENV)/js/done
test-realtime: $(VENV)/test
$(addprefix test-,$(GROUPS)):
	@$(BIN)/python test/groups.py $(@:test-%=%)

test-long: $(VENV)/peers $(VENV)/docs $(VENV)/aarch64 $(VENV)/wine $(VENV)/zig/done test-keys test-elsewhere test-ubuntu test-kilted  ## trials that take longer (two hours), coverage, and the matrix
	@$(MAKE) --no-print-directory -C workshop coverage matrix
	@$(BIN)/python -m pytest -m long test

test-keys: $(VENV)/test $(VENV)/messages/done $(VENV)/vulkan $(VENV)/chromium  ## tests of all but wording, every template replaced by its key
	@$(BIN)/python test/groups.py --keys

test-elsewhere: $(VENV)/test  ## tests of numbers and logs as on other processors, in other countries, for a stranger (20 minutes)
	@$(BIN)/python test/elsewhere.py

test-ubuntu: $(UBUNTU)/test  ## tests of node and client with NumPy 1.26 and pytest 7.4, as on Ubuntu 24.04
	@$(UBUNTU)/bin/python -m pytest -q -m "not realtime and not long" \
	  test/client test/node/test_topics.py test/node/test_recording.py

test-kilted: $(KILTED)/test  ## tests of node, client and log on ROS 2 Kilted
	@$(KILTED)/bin/python workshop/messages.py
	@$(KILTED)/bin/python -m pytest -q -m "not realtime and not long" --ignore=test/log/test_definitions.py \
	  test/node test/client test/log test/simulation/test_simulation.py

lint: style types  ## ruff, codespell and mypy; Biome and TypeScript for the page

style: $(VENV)/test $(VENV)/js/done
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/codespell
	@sh test/check_js.sh $(VENV)/js style

types: $(VENV)/test types-js
	@$(BIN)/mypy

types-js: $(VENV)/js/done
	@sh test/check_js.sh $(VENV)/js types

docs: $(VENV)/docs  ## the HTML site of README, docs and library in site/; warnings are errors
	@$(BIN)/python -m sphinx -q -W --keep-going -c docs/site -b html . site
	@$(BIN)/top_panel --write site/top.html
	@echo "wrote site/README.html"

wheels: $(VENV)/zig/done  ## wheels with the compiled kernel for Linux, macOS and Windows, in dist/ (3 minutes)
	@$(VENV)/zig/bin/python workshop/wheels.py dist

kernel-wasm: $(VENV)/zig/done  ## the kernel in WebAssembly, symtop_ros/web/kernel.wasm (1 minute)
	@$(VENV)/zig/bin/python workshop/kernel_wasm.py

clean:  ## remove the environment and all that was built; logs/ and report/ stay
	rm -rf $(VENV) site build dist install log *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find symtop_ros test workshop examples docs -name __pycache__ -prune -exec rm -rf {} +
	find symtop_ros -name 'libsymtop.*' -delete

$(VENV)/ros: $(SOURCES) $(VENV)/bin/activate
	@echo "Setting up .venv: ROS 2, NumPy, SciPy and Rerun (about 1 GB, once) ..."
	$(INSTALL) '.[ros,playback]'
	@touch $@

# The page has the kernel as WebAssembly: it needs no compiler, and runs from the checkout.
$(VENV)/panel: $(VENV)/bin/activate
	@echo "Setting up .venv: NumPy and PyYAML (about 100 MB, once) ..."
	@$(TICK) $(BIN)/python -m pip install 'numpy>=1.24' 'pyyaml>=5.4'
	@touch $@

# What build_kernel.py imports; from Python 3.12 on an environment is made without it.
$(VENV)/setuptools: $(VENV)/bin/activate
	@echo "Setting up .venv: setuptools (once) ..."
	@$(TICK) $(BIN)/python -m pip install 'setuptools>=61'
	@touch $@

$(VENV)/report: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots (once) ..."
	$(INSTALL) '.[ros,playback,report]'
	@touch $@

$(VENV)/peers: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots, and the programs to compare with (about 2 GB, once) ..."
	$(INSTALL) '.[ros,playback,report,peers]'
	@touch $@

# All at once, with what $(VENV)/ros has: each installation compiles the kernel.
$(VENV)/test: $(SOURCES) $(VENV)/bin/activate
	@echo "Setting up .venv: ROS 2, NumPy, SciPy, Rerun, plots and test tools (about 1.5 GB, once) ..."
	$(INSTALL) '.[ros,playback,report,test,lint]'
	@touch $(VENV)/ros $@

$(VENV)/messages/done: workshop/messages.py $(wildcard test/interfaces/*/*/*) $(VENV)/test
	@echo "Setting up $(VENV)/messages: messages that PyPI does not have (once) ..."
	@$(TICK) $(BIN)/python workshop/messages.py
	@mkdir -p $(@D)
	@touch $@

$(VENV)/docs: setup.py $(VENV)/ros
	@echo "Setting up .venv: Sphinx (once) ..."
	$(INSTALL) '.[ros,playback,docs]'
	@touch $@

$(UBUNTU)/test: setup.py $(VENV)/bin/activate
	@echo "Setting up $(UBUNTU): ROS 2 Jazzy, NumPy 1.26 and pytest 7.4 (about 300 MB, once) ..."
	@$(TICK) $(BIN)/python -m venv --clear $(UBUNTU)
	@$(TICK) $(UBUNTU)/bin/python -m pip install --editable '.[jazzy]' 'numpy<2' 'pytest==7.4.4' $(TOOLS)
	@touch $@

$(KILTED)/test: setup.py $(VENV)/bin/activate
	@echo "Setting up $(KILTED): ROS 2 Kilted (about 300 MB, once) ..."
	@$(TICK) $(BIN)/python -m venv --clear $(KILTED)
	@$(TICK) $(KILTED)/bin/python -m pip install --editable '.[kilted]' $(TOOLS)
	@touch $@

$(VENV)/vulkan: test/get_vulkan.sh $(VENV)/bin/activate
	@echo "Setting up .venv: a software Vulkan driver, for pictures without a screen (once) ..."
	@$(TICK) sh test/get_vulkan.sh $@
	@touch $@

$(VENV)/chromium: test/get_chromium.sh $(VENV)/bin/activate
	@echo "Setting up .venv: a browser, for the tests of the page (once) ..."
	@$(TICK) sh test/get_chromium.sh $@
	@touch $@

$(VENV)/aarch64: test/get_aarch64.sh $(VENV)/bin/activate
	@echo "Setting up .venv: a compiler and an emulator for ARM (once) ..."
	@$(TICK) sh test/get_aarch64.sh $@
	@touch $@

$(VENV)/wine: test/get_wine.sh $(VENV)/bin/activate
	@echo "Setting up .venv: Wine, for the kernel on Windows (100 MB, once) ..."
	@$(TICK) sh test/get_wine.sh $@
	@touch $@

$(VENV)/js/done: test/get_js.sh $(VENV)/bin/activate
	@echo "Setting up $(VENV)/js: TypeScript and Biome (210 MB, once) ..."
	@$(TICK) sh test/get_js.sh $(VENV)/js $(BIN)/python
	@touch $@

# Pinned: another Zig is another compiler.
$(VENV)/zig/done: $(VENV)/bin/activate
	@echo "Setting up $(VENV)/zig: a compiler for wheels and WebAssembly (about 400 MB, once) ..."
	@$(TICK) $(BIN)/python -m venv --clear $(VENV)/zig
	@$(TICK) $(VENV)/zig/bin/python -m pip install 'ziglang==0.15.2' 'setuptools>=70.1'
	@touch $@

# The last file that venv writes: without it an environment is incomplete, and made again.
$(VENV)/bin/activate:
	@command -v $(PYTHON) > /dev/null || \
	  { echo "make: PYTHON must be a Python 3.11 or later, got $(PYTHON): not found"; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "make: $(PYTHON) is older than 3.11; name another one: make PYTHON=python3.12"; exit 1; }
	@echo "Setting up .venv: Python ..."
	@$(PYTHON) -m venv --clear $(VENV) || \
	  { echo "make: $(PYTHON) -m venv failed (Debian and Ubuntu: apt install python3-venv)"; exit 1; }
