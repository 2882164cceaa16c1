#!/bin/sh
# Firefox and WebKit for the long tests of the page, installed into the system: sh test/get_browsers.sh
# as root, on Debian or Ubuntu. Without them those tests are skipped and say so. Xvfb is a screen for
# WebKit, and marionette-driver, from PyPI, drives Firefox.
set -eu
apt-get install -y --no-install-recommends webkit2gtk-driver xvfb
apt-get install -y --no-install-recommends firefox-esr || apt-get install -y firefox
"${1:-.venv/bin/python}" -m pip install marionette-driver
