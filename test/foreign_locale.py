"""Pytest plugin: the tests run in the locale of the environment, as in a program with GTK or Qt.

pytest -p foreign_locale test/physics
"""

import locale

locale.setlocale(locale.LC_ALL, "")
