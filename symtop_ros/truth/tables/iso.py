"""Times of the form of ISO 8601, with any number of decimals."""

import re
from datetime import UTC, datetime

ISO = re.compile(
    r"(\d{4}-\d\d-\d\d)[T ](\d\d:\d\d:\d\d)(?:[.,](\d+))?\s*(Z|[+-]\d\d:?\d\d)?", re.IGNORECASE
)
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def write_seconds(text: str) -> str:
    """Return a time of ISO 8601 as seconds since 1970, with its own decimals; else the text.

    Without an offset it is UTC.

    Examples
    --------
    >>> write_seconds("1970-01-02T00:00:00.123456789Z")
    '86400.123456789'
    >>> write_seconds("1970-01-01 01:00:00+01:00")
    '0.0'
    >>> write_seconds("12.5")
    '12.5'
    """
    found = ISO.fullmatch(text)
    if not found:
        return text
    day, clock, decimals, offset = found.groups()
    zone = (offset or "+00:00").upper().replace("Z", "+00:00")
    moment = datetime.fromisoformat(f"{day}T{clock}{zone}")
    return f"{int((moment - EPOCH).total_seconds())}.{decimals or '0'}"
