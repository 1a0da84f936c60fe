"""Objects in few words, for a terminal and for a notebook."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ._arrays import Real, shown

MOST = 6
"""How many of a list are named."""


def some(values: Iterable[Any], most: int = MOST) -> str:
    """The first of a list, and how many more there are."""
    listed = [str(value) for value in values]
    more = [f"and {len(listed) - most} more"] if len(listed) > most else []
    return ", ".join([*listed[:most], *more])


def counted(count: int, one: str, many: str | None = None) -> str:
    """A number and what it is of."""
    return f"{count} {one if count == 1 else many or one + 's'}"


def span(values: Any, unit: str = "Hz") -> str:
    """First and last of numbers that ascend."""
    array = np.ravel(np.asarray(values))
    if array.size == 0:
        return "none"
    ends = [f"{float(array[k]):.6g}" for k in ((0, -1) if array.size > 1 else (0,))]
    return f"{' to '.join(ends)} {unit}".rstrip()


def with_std(value: float, std: float) -> str:
    """A number with as many digits as its standard deviation leaves."""
    if not np.isfinite(value):
        return "none"
    if not np.isfinite(std) or std <= 0.0:
        return f"{value:.6g}"
    # Two digits of the deviation, and of the value as many as stand above them.
    digits = int(np.floor(np.log10(max(abs(value), std)) - np.floor(np.log10(std)))) + 2
    return f"{value:#.{min(max(digits, 2), 12)}g} ± {std:#.2g}".replace(". ", " ").removesuffix(".")


def typical(values: Real, stds: Real, where: Any) -> tuple[float, float]:
    """The median value, and the median standard deviation."""

    def median(array: Real) -> float:
        finite = array[where & np.isfinite(array)]
        return float(np.median(finite)) if finite.size else float("nan")

    return median(values), median(stds)


def array(values: Any) -> str:
    """The shape of an array, not its numbers."""
    shape = np.shape(values)
    return " x ".join(map(str, shape)) if shape else shown(values)


def arguments(name: str, one: Any, given: Sequence[str], others: Iterable[str]) -> str:
    """A call that says what an object was made of: some arguments in any case, others where they are not the default."""
    fields = type(one).__dataclass_fields__
    parts = [shown(getattr(one, key)) for key in given]
    for key in others:
        value = getattr(one, key)
        default = fields[key].default
        if value is not default and value != default:
            parts.append(f"{key}={shown(value)}")
    return f"{name}({', '.join(parts)})"


def escaped(text: object) -> str:
    """Text that a page may hold."""
    return html.escape(str(text), quote=True)


def html_table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; texts are escaped."""

    def line(cells: Iterable[object], mark: str) -> str:
        return "<tr>" + "".join(f"<{mark}>{escaped(cell)}</{mark}>" for cell in cells) + "</tr>"

    body = "".join(line(cells, "td") for cells in rows)
    return f"<table><thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"


def html_of(title: str, *parts: str) -> str:
    """A title over parts that are HTML already."""
    return f"<div><p><strong>{escaped(title)}</strong></p>{''.join(parts)}</div>"


def html_list(lines: Iterable[str]) -> str:
    """Lines of text as a list; no list without lines."""
    items = "".join(f"<li>{escaped(line)}</li>" for line in lines)
    return f"<ul>{items}</ul>" if items else ""
