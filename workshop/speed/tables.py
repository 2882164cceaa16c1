"""The list of all tables with their sources: `python -m workshop tables`."""

from collections.abc import Iterable
from pathlib import Path

from workshop.speed.provenance import LIST, ROOT, TABLES, Table, find_pages, list_tables
from workshop.speed.publish import format_table, publish

HEAD = ["table", "written by `make -C workshop ...`", "digest of its sources", "these sources"]


def write_list(folder: Path) -> None:
    """Write the list into the pages of a folder of documentation."""
    publish({LIST: format_list_of_tables(list_tables(find_pages(folder)))}, folder)


def format_list_of_tables(tables: Iterable[Table]) -> str:
    """Return the list, with a row for each table."""
    return format_table(
        HEAD,
        [
            [
                f"{each.name}, in {each.page.resolve().relative_to(ROOT).as_posix()}",
                f"`{TABLES[each.name][0]}`",
                f"`{each.sources}`",
                "yes" if each.is_of_these_sources() else "no, earlier ones",
            ]
            for each in sorted(tables, key=lambda each: each.name)
        ],
    )
