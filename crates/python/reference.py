"""The site's page of the Python package, made of its docstrings and stubs: python reference.py > docs/site/src/python-api.md"""

from __future__ import annotations

import ast
import inspect
import pathlib
import re
import sys
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import frfit
from frfit import _frfit

HEAD = """# Python: reference

This page is made of the docstrings and stubs of the package by `crates/python/reference.py`; a test fails where it is another. Their examples are run by doctest.
"""

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}\n", flags=re.MULTILINE)
ROLE = re.compile(r":\w+:`([^`]*)`")


def plain(text: str) -> str:
    """reStructuredText's marks as Markdown's."""
    return ROLE.sub(r"`\1`", text).replace("``", "`")


def examples(text: str) -> str:
    """Text in which examples are blocks of code."""
    parts = []
    for part in re.split(r"\n\s*\n", text.strip("\n")):
        parts.append(f"```text\n{part}\n```" if part.startswith(">>>") else plain(part))
    return "\n\n".join(parts)


def definitions(text: str) -> str:
    """``name`` over an indented description, as a list."""
    lines = []
    for line in text.strip("\n").splitlines():
        if not line.startswith(" "):
            names = ", ".join(f"`{name.strip()}`" for name in line.split(","))
            lines.append(f"- {names}:")
        elif line.strip():
            lines[-1] += f" {plain(line.strip())}"
    return "\n".join(lines)


def described(doc: str | None, name: str) -> str:
    """A docstring in numpy's style as Markdown."""
    if not doc or not doc.strip():
        raise SystemExit(f"{name} has no docstring")
    first, *sections = SECTION.split(inspect.cleandoc(doc) + "\n")
    text = [examples(first)]
    for title, body in zip(sections[::2], sections[1::2], strict=True):
        text.append(f"**{title}**")
        text.append(definitions(body) if title in ("Parameters", "Raises") else examples(body))
    return "\n\n".join(part for part in text if part)


def signature(name: str, what: Any) -> str:
    """``name(arguments) -> result``, long ones an argument a line."""
    found = inspect.signature(what)
    shown = []
    for one in found.parameters.values():
        if one.name == "self":
            continue
        if one.kind is one.KEYWORD_ONLY and "*" not in shown:
            shown.append("*")
        kind = "" if one.annotation is one.empty else f": {one.annotation}"
        default = "" if one.default is one.empty else f" = {one.default!r}" if kind else f"={one.default!r}"
        shown.append(one.name + kind + default)
    result = "" if found.return_annotation in (found.empty, None, "None") else f" -> {found.return_annotation}"
    line = f"{name}({', '.join(shown)}){result}"
    return line if len(line) <= 80 else f"{name}(\n    " + ",\n    ".join(shown) + f",\n){result}"


def code(text: str) -> str:
    return f"```text\n{text}\n```"


def attributes(cls: type) -> Iterator[str]:
    """The fields of a dataclass, each with the docstring below it if there is one."""
    tree = ast.parse(inspect.cleandoc(inspect.getsource(cls))).body[0]
    assert isinstance(tree, ast.ClassDef)
    docstrings = {}
    for one, after in zip(tree.body, [*tree.body[1:], None], strict=True):
        if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name):
            is_text = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
            docstrings[one.target.id] = " ".join(after.value.value.split()) if is_text else ""
    for one in fields(cls):
        about = f": {plain(docstrings[one.name])}" if docstrings.get(one.name) else ""
        yield f"- `{one.name}`{about}"


def members(name: str, cls: type) -> Iterator[str]:
    """Properties and methods that are not private."""
    for member, what in vars(cls).items():
        if member.startswith("_"):
            continue
        if isinstance(what, property):
            yield f"- `{member}`: {plain(inspect.cleandoc(what.__doc__ or ''))}"
        elif inspect.isfunction(what) or isinstance(what, classmethod | staticmethod):
            call = signature(member, getattr(cls, member))
            yield f"- `{call}`: {' '.join(described(what.__doc__, f'{name}.{member}').split())}"


def compiled(name: str, cls: type) -> Iterator[str]:
    """The members that the stub has, with the docstrings of the compiled class."""
    stub = ast.parse((pathlib.Path(frfit.__file__).with_name("_frfit.pyi")).read_text())
    (tree,) = [one for one in stub.body if isinstance(one, ast.ClassDef) and one.name == name]
    for one in tree.body:
        if isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
            about = plain(" ".join((getattr(cls, one.name).__doc__ or "").split()))
            is_property = any(isinstance(mark, ast.Name) and mark.id == "property" for mark in one.decorator_list)
            written = ast.unparse(one.args).replace("_Real", "Real").replace("_Complex", "Complex")
            arguments = [argument for argument in written.split(", ") if argument != "self"]
            call = one.name if is_property else f"{one.name}({', '.join(arguments)})"
            yield f"- `{call}`: {about}"


def entry(name: str) -> str:
    what = getattr(frfit, name)
    text = [f"## {name}"]
    if inspect.isfunction(what):
        text += [code(signature(name, what)), described(what.__doc__, name)]
    elif issubclass(what, Exception):
        bases = ", ".join(base.__name__ for base in what.__bases__)
        text += [f"An exception: {bases}.", described(what.__doc__, name)]
    elif getattr(_frfit, name, None) is what:
        text += [described(what.__doc__, name), "\n".join(compiled(name, what))]
    else:
        if name not in RESULTS:
            text.append(code(signature(name, what)))
        text.append(described(what.__doc__, name))
        if is_dataclass(what) and "Parameters\n" not in (what.__doc__ or ""):
            text.append("\n".join(attributes(what)))
        text.append("\n".join(members(name, what)))
    return "\n\n".join(part for part in text if part)


# What a call returns: no caller makes one, so that its signature is of no use.
RESULTS = {"Identification", "Estimate", "Finding", "Impact", "MeasuredFrf", "Modes", "OtherExplanation", "Uff", "UffSummary"}


def page() -> str:
    """The page; functions first, then classes, then exceptions."""

    def rank(name: str) -> tuple[int, str]:
        what = getattr(frfit, name)
        return (0 if inspect.isfunction(what) else 2 if issubclass(what, Exception) else 1, name.lower())

    names = sorted((name for name in frfit.__all__ if not name.startswith("__")), key=rank)
    return HEAD + "\n" + "\n\n".join(entry(name) for name in names) + "\n"


if __name__ == "__main__":
    sys.stdout.write(page())
