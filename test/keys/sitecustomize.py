"""Replaces every template by its key, in each program that is started with this folder on its path.

What still works does not depend on wording. Python imports this module when it starts.
"""

from symtop_ros.words import templates

for key in templates.TEMPLATES:
    templates.TEMPLATES[key] = key
