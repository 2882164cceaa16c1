# The environment of every program that make runs, here and in the workshop.
# Nothing is sent to the network, and an active ROS or other environment is not used.
export ROS_AUTOMATIC_DISCOVERY_RANGE = LOCALHOST
# ROS and Matplotlib write here, and not into the home of the user.
export ROS_LOG_DIR ?= $(CHECKOUT)/.venv/ros_log
export MPLCONFIGDIR ?= $(CHECKOUT)/.venv/matplotlib
# Zig and pip write here, too, and not where a configuration of the user says.
export ZIG_GLOBAL_CACHE_DIR = $(CHECKOUT)/.venv/zig-cache
export PIP_USER = 0
unexport PYTHONHOME PYTHONSAFEPATH
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH AMENT_PREFIX_PATH RMW_IMPLEMENTATION
