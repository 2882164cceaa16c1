"""Numbers of things in sentences."""

SINGULARS = {"are": "is", "do": "does", "have": "has", "were": "was"}


def write_count(number: int, noun: str, verb: str = "") -> str:
    """Return a number with its noun, and with its verb if one is given.

    Parameters
    ----------
    number : int
    noun : str
        In the singular; the plural ends in s.
    verb : str
        "are", "do", "have" or "were", or one that is the same for both numbers.

    Examples
    --------
    >>> from symtop_ros.base.counts import write_count
    >>> write_count(1, "sample", "are"), write_count(2, "sample", "are"), write_count(0, "event")
    ('1 sample is', '2 samples are', '0 events')
    """
    if number == 1:
        verb = SINGULARS.get(verb, verb)
    else:
        noun += "s"
    return " ".join(filter(None, (f"{number} {noun}", verb)))
