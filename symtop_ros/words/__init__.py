"""English from records: templates in `en.json`, and one rule for numbers.

A record is data: a dataclass of numbers, words, other records and tuples of these. `write` is the
only place where a sentence is made. The templates and the rule are few enough for a second program,
in another language, to write the same letters. Everything may import it.
"""

from symtop_ros.words.templates import Variant, write

__all__ = ["Variant", "write"]
