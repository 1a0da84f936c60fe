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

`crates/python/reference.py` makes this page of the docstrings and stubs of the package.
A test fails if the two differ, and doctest runs the examples.
"""

# Characters of a line, as `cargo xtask prose` asks for.
WIDTH = 100

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}\n", flags=re.MULTILINE)
ROLE = re.compile(r":\w+:`([^`]*)`")
# A full stop that another sentence follows; single letters and some abbreviations end none.
SENTENCE = re.compile(r"(?<!\b[A-Z]\.)(?<!\be\.g\.)(?<!\bi\.e\.)(?<=[.!?])[)\"*]*\s+(?=[\"(*\[]*[A-Z`])")


def plain(text: str) -> str:
    """reStructuredText's marks as Markdown's."""
    return ROLE.sub(r"`\1`", text).replace("``", "`")


def words(sentence: str) -> Iterator[str]:
    """Words; a piece of code is one word with all that touches it, and a number is one with its %."""
    word, is_code = "", False
    for at, character in enumerate(f"{sentence} "):
        is_code ^= character == "`"
        if character.isspace() and not is_code:
            if word and not sentence[at + 1 :].startswith("%"):
                yield word
                word = ""
            elif word:
                word += " "
        else:
            word += character


def prose(text: str, begin: str = "") -> str:
    """A paragraph with one sentence a line, long ones on several lines; those after the first are indented as the item is."""
    indent = "  " if begin else ""
    lines = []
    for sentence in SENTENCE.split(plain(" ".join(text.split()))):
        line = begin if not lines else indent
        for word in words(sentence):
            if line.strip(" -") and len(line) + 1 + len(word) > WIDTH:
                lines.append(line.rstrip())
                line = indent
            line += word if line in ("", indent, begin) else f" {word}"
        lines.append(line)
    return "\n".join(lines)


def examples(text: str) -> str:
    """Text in which examples are blocks of code."""
    parts = []
    for part in re.split(r"\n\s*\n", text.strip("\n")):
        parts.append(f"```text\n{part}\n```" if part.startswith(">>>") else prose(part))
    return "\n\n".join(parts)


def definitions(text: str) -> str:
    """``name`` over an indented description, as a list."""
    items = []
    for line in text.strip("\n").splitlines():
        if not line.startswith(" "):
            names = ", ".join(f"`{name.strip()}`" for name in line.split(","))
            items.append(f"{names}:")
        elif line.strip():
            items[-1] += f" {line.strip()}"
    return "\n".join(prose(item, "- ") for item in items)


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
        about = f": {docstrings[one.name]}" if docstrings.get(one.name) else ""
        yield prose(f"`{one.name}`{about}", "- ")


def properties(cls: type) -> Iterator[str]:
    """Properties that are not private."""
    for member, what in vars(cls).items():
        if isinstance(what, property) and not member.startswith("_"):
            yield prose(f"`{member}`: {inspect.cleandoc(what.__doc__ or '')}", "- ")


def methods(name: str, cls: type) -> Iterator[str]:
    """Methods that are not private, each below a heading of its own."""
    for member, what in vars(cls).items():
        is_method = inspect.isfunction(what) or isinstance(what, classmethod | staticmethod)
        if is_method and not member.startswith("_"):
            call = code(signature(member, getattr(cls, member)))
            yield f"### {name}.{member}\n\n{call}\n\n{described(what.__doc__, f'{name}.{member}')}"


def compiled(name: str, cls: type) -> Iterator[str]:
    """The members that the stub has, with the docstrings of the compiled class."""
    stub = ast.parse((pathlib.Path(frfit.__file__).with_name("_frfit.pyi")).read_text())
    (tree,) = [one for one in stub.body if isinstance(one, ast.ClassDef) and one.name == name]
    for one in tree.body:
        if isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
            about = getattr(cls, one.name).__doc__ or ""
            is_property = any(isinstance(mark, ast.Name) and mark.id == "property" for mark in one.decorator_list)
            written = ast.unparse(one.args).replace("_Real", "Real").replace("_Complex", "Complex")
            arguments = [argument for argument in written.split(", ") if argument != "self"]
            call = one.name if is_property else f"{one.name}({', '.join(arguments)})"
            yield prose(f"`{call}`: {about}", "- ")


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
        is_listed = is_dataclass(what) and "Parameters\n" not in (what.__doc__ or "")
        text.append("\n".join([*(attributes(what) if is_listed else ()), *properties(what)]))
        text += methods(name, what)
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
