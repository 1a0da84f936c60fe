"""Adds the counts and ratios of a benchmark's tables to a history, a line each.

    cargo xtask bench lines 10000 | python .github/scripts/counts.py lines history.csv

Seconds and megabytes are left out: they belong to the machine, and machines of a CI differ from run to run.
"""

import csv
import os
import re
import sys
from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path

HEADING = ["date", "commit", "benchmark", "row", "column", "value"]

# Headings of seconds and megabytes; stages of a run are seconds without a unit in their heading.
OF_THE_MACHINE = re.compile(r"\((s|MB)\)$|^s, |^(subspace|solutions|selection|seconds)$")

# Columns that name a row. Of the rest of a row each cell is a line of the history.
NAMES = {"", "frequencies", "sensors", "data", "dofs", "errors of the model", "unknown"}


def tables(lines: list[str]) -> Iterator[list[list[str]]]:
    """The tables of a text: those of Markdown, and those whose columns stand two blanks apart."""
    rows: list[list[str]] = []
    for line in [*lines, ""]:
        text = line.strip()
        if text.startswith("|"):
            cells = [cell.strip() for cell in text.strip("|").split("|")]
            if not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
                rows.append(cells)
            continue
        cells = re.split(r"\s{2,}", text)
        if len(cells) > 2:
            rows.append(cells)
            continue
        if len(rows) > 1:
            yield rows
        rows = []


def entries(table: list[list[str]]) -> Iterator[tuple[str, str, str]]:
    """Row, column and value of all that is neither seconds nor megabytes."""
    heading, *rows = table
    for row in rows:
        # An empty cell at the end of a row leaves no trace in the text.
        named = dict(zip(heading, row))
        name = ", ".join(value for column, value in named.items() if column in NAMES)
        for column, value in named.items():
            if column not in NAMES and not OF_THE_MACHINE.search(column):
                yield name, column, value


def main() -> int:
    benchmark, history = sys.argv[1], Path(sys.argv[2])
    lines = sys.stdin.read().splitlines()
    print("\n".join(lines))
    found = [entry for table in tables(lines) for entry in entries(table)]
    if not found:
        print(f"{benchmark}: expected a table, found none", file=sys.stderr)
        return 1
    date = datetime.now(timezone.utc).date().isoformat()
    commit = os.environ.get("GITHUB_SHA", "")
    is_new = not history.exists()
    with history.open("a", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        if is_new:
            writer.writerow(HEADING)
        writer.writerows([date, commit, benchmark, *entry] for entry in found)
    return 0


if __name__ == "__main__":
    sys.exit(main())
