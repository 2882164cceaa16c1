# Everything is installed into .venv, by `make test` what only some groups need when they start
# (test/groups.py). The rest of the machine is unchanged, but for pip's cache.
PYTHON ?= python3
VENV := .venv
# What is compiled at the installation.
SOURCES := setup.py build_kernel.py $(wildcard symtop_ros/physics/kernel/*.* symtop_ros/physics/kernel/*/*.hpp)
NUMPY1 := .venv/numpy1
KILTED := .venv/kilted
BIN := $(VENV)/bin
TOOLS := pytest hypothesis mpmath rosbags coverage
GROUPS := nodes rest judge plain physics old-processor without-ros examples lint realtime
# A line every ten seconds, for as long as the shell of a recipe runs: pip may be silent for minutes.
TICK = ( n=0; while sleep 10 > /dev/null && kill -0 $$$$ 2> /dev/null; do n=$$((n + 10)); echo "  ... at work for $$n s"; done ) & \
  tick=$$!; trap 'kill $$tick' EXIT;
INSTALL = @$(TICK) $(BIN)/python -m pip install --editable

# Nothing is sent to the network, and an active ROS or other environment is not used.
export ROS_AUTOMATIC_DISCOVERY_RANGE = LOCALHOST
# ROS and Matplotlib write here, and not into the home of the user.
export ROS_LOG_DIR ?= $(CURDIR)/$(VENV)/ros_log
export MPLCONFIGDIR ?= $(CURDIR)/$(VENV)/matplotlib
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH AMENT_PREFIX_PATH RMW_IMPLEMENTATION

.NOTPARALLEL:  # two runs of pip would meet in one environment
.PHONY: help demo panel test coverage coverage-js $(addprefix test-,$(GROUPS)) test-long test-keys test-elsewhere test-kilted lint style types types-js docs matrix report scores derivatives filters article lesson maps pictures stress soak node-cost wheels kernel-wasm clean

help:  ## show this list
	@grep -E '^[a-z-]+:.*##' $(firstword $(MAKEFILE_LIST)) | sed -E 's/:.*## /\t/' | expand -t 20

demo: $(VENV)/ros  ## a top on cusps, hurried by its service, and the replay
	@$(BIN)/python -m workshop.demo

panel: $(VENV)/panel  ## the page, top.html, opened in the browser; needs no ROS and no compiler
	@$(BIN)/python -m symtop_ros.panel.main

test: $(VENV)/test  ## style, types and all tests (9 minutes; 3 GB, once)
	@$(BIN)/python test/groups.py

coverage: $(VENV)/test $(VENV)/messages/done $(VENV)/vulkan $(VENV)/chromium $(NUMPY1)/test  ## the same with the coverage of lines and branches, and with load, lesson and demonstration in full, of which 96 % are asked (18 minutes)
	@rm -rf .venv/coverage/data* $(VENV)/coverage/page
	@PAGE_COVERAGE=$(CURDIR)/$(VENV)/coverage/page $(BIN)/python test/groups.py --coverage
	@$(BIN)/coverage run -m pytest -q -m long test/load test/test_lesson.py test/test_demo.py
	@$(BIN)/coverage combine --quiet
	@$(BIN)/coverage report --skip-covered
	@$(BIN)/python -m workshop.page_coverage $(VENV)/coverage/page

coverage-js: $(VENV)/test $(VENV)/chromium  ## coverage of the lines of the page's modules, of which 90 % are asked (4 minutes)
	@rm -rf $(VENV)/coverage/page
	@PAGE_COVERAGE=$(CURDIR)/$(VENV)/coverage/page $(BIN)/python -m pytest -q -m "not long" test/web test/panel
	@$(BIN)/python -m workshop.page_coverage $(VENV)/coverage/page

test-nodes: $(VENV)/test $(VENV)/messages/done $(NUMPY1)/test  ## the node, its faults and load, the client; partly with NumPy 1.26
test-rest: $(VENV)/test $(VENV)/vulkan  ## documents, programs, playback, article
test-judge: $(VENV)/test  ## check of logs, sensor, judge of estimates
test-plain: $(VENV)/test  ## report, messages, models, test set
test-physics: $(VENV)/test  ## the library
test-old-processor: $(VENV)/test  ## tests of numbers with the instructions of a processor of 2008
test-without-ros: $(VENV)/test $(VENV)/chromium  ## simulation, session, log, page: as without ROS and Rerun
test-examples: $(VENV)/test  ## examples in docstrings
test-lint: $(VENV)/test $(VENV)/js/done  ## the same as lint
test-realtime: $(VENV)/test $(VENV)/chromium  ## tests that measure time, one after the other
$(addprefix test-,$(GROUPS)):
	@$(BIN)/python test/groups.py $(@:test-%=%)

test-long: $(VENV)/aarch64 $(VENV)/zig/done coverage test-keys test-elsewhere test-kilted matrix  ## trials that take longer (two hours), coverage, and the matrix
	@$(BIN)/python -m pytest -m long test

test-keys: $(VENV)/test $(VENV)/messages/done $(VENV)/vulkan $(VENV)/chromium $(NUMPY1)/test  ## tests of all but wording, every template replaced by its key
	@$(BIN)/python test/groups.py --keys

test-elsewhere: $(VENV)/test  ## tests of numbers and logs as on other processors, in other countries, for a stranger (20 minutes)
	@$(BIN)/python test/elsewhere.py

matrix: $(VENV)/ros  ## the node with each ROS 2, Python and NumPy of docs/ros.md (20 minutes)
	@$(BIN)/python workshop/matrix.py

test-kilted: $(KILTED)/test  ## tests of node, client and log on ROS 2 Kilted
	@$(KILTED)/bin/python workshop/messages.py
	@$(KILTED)/bin/python -m pytest -q -m "not realtime and not long" --ignore=test/log/test_definitions.py \
	  test/node test/client test/log test/simulation/test_simulation.py

lint: style types  ## ruff, codespell and mypy; Biome and TypeScript for the page

style: $(VENV)/test $(VENV)/js/done  ## ruff, codespell and Biome
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/codespell
	@sh test/check_js.sh $(VENV)/js style

types: $(VENV)/test types-js  ## mypy (strict) and types-js
	@$(BIN)/mypy

types-js: $(VENV)/js/done  ## types of the page's modules (strict), by TypeScript
	@sh test/check_js.sh $(VENV)/js types

docs: $(VENV)/docs  ## the HTML site of README, docs and library in site/; warnings are errors
	@$(BIN)/python -m sphinx -q -W --keep-going -c docs/site -b html . site
	@$(BIN)/top_panel --write site/top.html
	@echo "wrote site/README.html"

# The workshop: what is written goes to report/, and ARGS=--help lists the options of a target.
WORKSHOP = @XDG_CACHE_HOME=$(CURDIR)/$(VENV)/cache $(BIN)/python -m workshop

report: $(VENV)/peers  ## speed against error on this machine (some minutes; 2 GB, once)
	$(WORKSHOP) speed $(ARGS)

scores: $(VENV)/peers  ## scores of these programs in the test set (20 minutes)
	$(WORKSHOP) testset $(ARGS)

derivatives: $(VENV)/peers  ## derivatives by top and start, compared with heyoka (a minute)
	$(WORKSHOP) derivatives $(ARGS)

filters: $(VENV)/peers  ## attitude filters fed with the top's noisy sensor (4 minutes)
	$(WORKSHOP) filters $(ARGS)

article: $(VENV)/report  ## the article's figures, its motions in 3D, and its claims
	$(WORKSHOP) article $(ARGS)

lesson: $(VENV)/report  ## the pictures of the lesson; ARGS=--sheets: sheets to print
	$(WORKSHOP) lesson $(ARGS)

maps: $(VENV)/report  ## where hurrying the precession raises the top
	$(WORKSHOP) maps $(ARGS)

pictures: $(VENV)/test $(VENV)/vulkan $(VENV)/chromium  ## the pictures in docs/ but plots of measurements, and the steps of docs/lesson.md
	$(WORKSHOP) pictures $(ARGS)
	@$(BIN)/python -m workshop.pictures.page $(ARGS)

stress: $(VENV)/report  ## the node under load: clients, subscribers, late joiners (3 minutes)
	@$(BIN)/python -m workshop.load.stress $(ARGS)

soak: $(VENV)/report  ## the node for an hour with requests at random, its logs checked
	@$(BIN)/python -m workshop.load.soak $(ARGS)

node-cost: $(VENV)/report  ## cost of the node compared with bare rclpy nodes (9 minutes)
	@$(BIN)/python -m workshop.load.node_cost $(ARGS)

wheels: $(VENV)/zig/done  ## wheels with the compiled kernel for x86-64 and ARM, in dist/ (2 minutes)
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

$(VENV)/report: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots (once) ..."
	$(INSTALL) '.[ros,playback,report]'
	@touch $@

$(VENV)/peers: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots, and the programs to compare with (about 2 GB, once) ..."
	$(INSTALL) '.[ros,playback,report,peers]'
	@touch $@

$(VENV)/test: setup.py $(VENV)/ros
	@echo "Setting up .venv: test tools (once) ..."
	$(INSTALL) '.[ros,playback,report,test,lint,docs]'
	@touch $@

$(VENV)/messages/done: workshop/messages.py $(wildcard test/interfaces/*/*/*) $(VENV)/test
	@echo "Setting up $(VENV)/messages: messages that PyPI does not have (once) ..."
	@$(TICK) $(BIN)/python workshop/messages.py
	@mkdir -p $(@D)
	@touch $@

$(VENV)/docs: setup.py $(VENV)/ros
	@echo "Setting up .venv: Sphinx (once) ..."
	$(INSTALL) '.[ros,playback,docs]'
	@touch $@

$(NUMPY1)/test: setup.py $(VENV)/bin/activate
	@echo "Setting up $(NUMPY1): ROS 2 Jazzy, NumPy 1.26 and pytest 7.4 (about 300 MB, once) ..."
	@$(TICK) $(BIN)/python -m venv --clear $(NUMPY1)
	@$(TICK) $(NUMPY1)/bin/python -m pip install --editable '.[jazzy]' 'numpy<2' 'pytest==7.4.4' $(TOOLS)
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
