"""Sentences of the page: in English it has other words than programs for a kick."""

from unittest.mock import patch

from symtop_ros.words import templates


def write_as_page(name, record, variant="radians"):
    """Return a record as text, by the templates of the page."""
    with patch.dict(templates.TEMPLATES, templates.read_templates("en")):
        templates._split.cache_clear()
        text = templates.write(name, record, variant)
    templates._split.cache_clear()
    return text
