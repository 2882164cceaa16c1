# Everything is installed into .venv; the rest of the machine is unchanged.
PYTHON ?= python3
VENV := .venv
# What is compiled at the installation.
SOURCES := setup.py $(wildcard symtop_ros/physics/kernel/*.?pp symtop_ros/physics/kernel/*/*.hpp)
NUMPY1 := .venv/numpy1
KILTED := .venv/kilted
BIN := $(VENV)/bin
# `make test` runs three groups of tests at a time. Those that need no node have a low priority.
NODES := test/node test/system test/load
PLAIN := test/report test/wire test/models test/testset
# These run as on a machine without ROS and Rerun.
WITHOUT_ROS := test/simulation test/session test/log test/panel test/web
WITH_ROS := test/log/test_definitions.py test/panel/test_node_source.py
# These run with NumPy 1.26 and without Rerun, as with the ROS 2 Jazzy of Ubuntu 24.04.
WITH_NUMPY1 := test/client test/node/test_services.py test/node/test_recording.py
TOOLS := pytest hypothesis mpmath rosbags coverage
REALTIME := test/node test/panel test/system test/load
MARKERS := not realtime and not long
# `make coverage` has the lines of the package counted, which takes a quarter longer.
RUN := python
TESTS = $(RUN) -m pytest -q -m "$(MARKERS)"

# Nothing is sent to the network, and an active ROS or other environment is not used.
export ROS_AUTOMATIC_DISCOVERY_RANGE = LOCALHOST
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH AMENT_PREFIX_PATH RMW_IMPLEMENTATION

# `make test-keys` has every template of wording replaced by its key.
ifdef KEYS
export PYTHONPATH := $(CURDIR)/test/keys
else
unexport PYTHONPATH
endif

.PHONY: help demo panel test coverage test-nodes test-rest test-plain test-physics test-without-ros test-examples test-realtime test-long test-keys test-kilted lint style types docs matrix report stress soak node-cost clean

help:  ## show this list
	@grep -E '^[a-z-]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 12

demo: $(VENV)/ros  ## a top on cusps, hurried by its service, and the replay
	@$(BIN)/python -m symtop_ros.demo

panel: $(VENV)/panel  ## a page in the browser to play with a top; needs no ROS
	@$(BIN)/top_panel

test: style $(VENV)/vulkan $(VENV)/chromium $(NUMPY1)/test  ## style, types and all tests (8 minutes)
	@$(MAKE) --no-print-directory -j3 test-nodes test-rest test-plain test-physics test-without-ros test-examples types
	@$(MAKE) --no-print-directory test-realtime

coverage:  ## the same with the coverage of lines and branches, of which 95 % are asked (11 minutes)
	@rm -f .venv/coverage/data*
	@$(MAKE) --no-print-directory test RUN="coverage run"
	@$(BIN)/coverage combine --quiet
	@$(BIN)/coverage report --skip-covered

test-nodes: $(NUMPY1)/test
	@$(NUMPY1)/bin/$(TESTS) $(WITH_NUMPY1)
	@$(BIN)/$(TESTS) $(NODES) $(addprefix --ignore=,$(WITH_NUMPY1))

test-rest:
	@$(BIN)/$(TESTS) test $(addprefix --ignore=,$(NODES) test/physics $(PLAIN) $(WITHOUT_ROS) $(WITH_NUMPY1))

test-plain:
	@nice -n 19 $(BIN)/$(TESTS) $(PLAIN) $(WITH_ROS)

test-physics:
	@nice -n 19 $(BIN)/$(TESTS) test/physics

test-without-ros:
	@nice -n 19 $(BIN)/$(TESTS) -p without_ros $(WITHOUT_ROS)

test-examples:
	@nice -n 19 $(BIN)/$(RUN) -m pytest -q --doctest-modules --ignore-glob='*/*_peer.py' symtop_ros

test-realtime:  # alone: these tests measure time
	@$(BIN)/$(RUN) -m pytest -m "realtime and not long" $(REALTIME)

test-long: $(VENV)/test $(VENV)/vulkan $(VENV)/chromium $(VENV)/aarch64 coverage test-keys test-kilted matrix  ## trials that take longer (two hours), coverage, and the matrix
	@$(BIN)/python -m pytest -m long test

test-keys: $(VENV)/test $(VENV)/chromium $(NUMPY1)/test  ## tests of all but wording, every template replaced by its key
	@$(MAKE) --no-print-directory KEYS=1 MARKERS="$(MARKERS) and not wording" \
	  test-nodes test-rest test-plain test-physics test-without-ros

matrix: $(VENV)/ros  ## the node with each ROS 2, Python and NumPy of docs/ros.md (20 minutes)
	@$(BIN)/python test/matrix.py

test-kilted: $(KILTED)/test  ## tests of node, client and log on ROS 2 Kilted
	@$(KILTED)/bin/python -m pytest -q -m "$(MARKERS)" --ignore=test/log/test_definitions.py \
	  test/node test/client test/log test/simulation/test_simulation.py

lint: style types

style: $(VENV)/test
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/codespell

types: $(VENV)/test
	@$(BIN)/mypy

docs: $(VENV)/docs  ## the HTML site of README, docs and library in site/; warnings are errors
	@$(BIN)/python -m sphinx -q -W --keep-going -c docs/site -b html . site
	@echo "wrote site/README.html"

report: $(VENV)/report  ## speed against error on this machine (some minutes); plots in report/
	@$(BIN)/top_report speed

stress: $(VENV)/report  ## the node under load: clients, subscribers, late joiners (3 minutes)
	@$(BIN)/python test/load/stress.py

soak: $(VENV)/report  ## the node for an hour with requests at random, its logs checked
	@$(BIN)/python test/load/soak.py

node-cost: $(VENV)/report  ## cost of the node compared with bare rclpy nodes (9 minutes)
	@$(BIN)/python test/load/node_cost.py

clean:  ## remove the environment and everything that was built
	rm -rf $(VENV) site build install log *.egg-info

$(VENV)/ros: $(SOURCES) $(VENV)/bin/python
	@echo "Setting up .venv: ROS 2, NumPy, SciPy and Rerun (about 1 GB, once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback]'
	@touch $@

$(VENV)/panel: $(SOURCES) $(VENV)/bin/python
	@echo "Setting up .venv: the page of top_panel (about 300 MB, once) ..."
	$(BIN)/python -m pip install --editable '.[panel]'
	@touch $@

$(VENV)/report: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots, and the programs to compare with (about 2 GB, once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback,report,peers]'
	@touch $@

$(VENV)/test: setup.py $(VENV)/ros
	@echo "Setting up .venv: test tools (once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback,panel,report,test,lint,docs]'
	@touch $@

$(VENV)/docs: setup.py $(VENV)/ros
	@echo "Setting up .venv: Sphinx (once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback,panel,docs]'
	@touch $@

$(NUMPY1)/test: setup.py $(VENV)/bin/python
	@echo "Setting up $(NUMPY1): ROS 2 Jazzy and NumPy 1.26 (about 300 MB, once) ..."
	@$(PYTHON) -m venv $(NUMPY1)
	$(NUMPY1)/bin/python -m pip install --editable '.[jazzy]' 'numpy<2' $(TOOLS)
	@touch $@

$(KILTED)/test: setup.py $(VENV)/bin/python
	@echo "Setting up $(KILTED): ROS 2 Kilted (about 300 MB, once) ..."
	@$(PYTHON) -m venv $(KILTED)
	$(KILTED)/bin/python -m pip install --editable '.[kilted]' $(TOOLS)
	@touch $@

$(VENV)/vulkan: test/get_vulkan.sh $(VENV)/bin/python
	@echo "Setting up .venv: a software Vulkan driver, for pictures without a screen (once) ..."
	@sh test/get_vulkan.sh $@
	@touch $@

$(VENV)/chromium: test/get_chromium.sh $(VENV)/bin/python
	@echo "Setting up .venv: a browser, for the tests of the page (once) ..."
	@sh test/get_chromium.sh $@
	@touch $@

$(VENV)/aarch64: test/get_aarch64.sh $(VENV)/bin/python
	@echo "Setting up .venv: a compiler and an emulator for ARM (once) ..."
	@sh test/get_aarch64.sh $@
	@touch $@

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "make: $(PYTHON) is older than 3.11; name another one: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { echo "make: $(PYTHON) -m venv failed (Debian: apt install python3-venv)"; exit 1; }
