# Everything happens in an environment of its own, .venv; nothing else on the machine is touched.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
CALM := test/physics test/report/article test/report/perry test/report/precision

# Nothing here is meant for the network, and a ROS or another environment that is active stays out.
export ROS_AUTOMATIC_DISCOVERY_RANGE = LOCALHOST
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH AMENT_PREFIX_PATH RMW_IMPLEMENTATION

.PHONY: help demo test test-calm test-rest lint report clean

help:  ## this list
	@grep -E '^[a-z]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 10

demo: $(VENV)/ros  ## a top on cusps, its precession hurried through the service, and the replay
	@$(BIN)/python -m symtop_ros.demo

test: lint $(VENV)/vulkan  ## style, types and all tests, and what they cover
	@$(BIN)/coverage erase
	@$(MAKE) --no-print-directory -j2 test-calm test-rest
	@$(BIN)/coverage combine --quiet
	@$(BIN)/coverage report --skip-covered

test-calm:  # they need a core and no ROS, and give way to what is about time
	@nice -n 19 $(BIN)/coverage run -m pytest -q $(CALM)

test-rest:
	@$(BIN)/coverage run -m pytest $(addprefix --ignore=,$(CALM))

lint: $(VENV)/test
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/mypy

report: $(VENV)/report  ## speed against error on this machine, two minutes; plots in report/
	@$(BIN)/top_report

clean:  ## remove the environment and what was built
	rm -rf $(VENV) build install log *.egg-info

$(VENV)/ros: setup.py $(VENV)/bin/python
	@echo "Setting up .venv: ROS 2, NumPy, SciPy and Rerun (about 1 GB, once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback]'
	@touch $@

$(VENV)/report: setup.py $(VENV)/ros
	@echo "Setting up .venv: plots, and the peers to measure (about 2 GB, once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback,report,peers]'
	@touch $@

$(VENV)/test: setup.py $(VENV)/ros
	@echo "Setting up .venv: what the tests need (once) ..."
	$(BIN)/python -m pip install --editable '.[ros,playback,report,test,lint]'
	@touch $@

$(VENV)/vulkan: test/get_vulkan.sh $(VENV)/bin/python
	@echo "Setting up .venv: a software Vulkan driver, for pictures without a screen (once) ..."
	@sh test/get_vulkan.sh $@
	@touch $@

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "make: $(PYTHON) is older than 3.11; name another one: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { echo "make: $(PYTHON) -m venv failed (Debian: apt install python3-venv)"; exit 1; }
