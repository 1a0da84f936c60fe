"""Arguments: checked, and made what the compiled part takes.

Arrays become one-dimensional float64 and complex128, copied only where they are not. What is no number is refused here
by the argument's name: NumPy would read dates, flags and texts as numbers.
"""

from __future__ import annotations

import difflib
import functools
import inspect
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ParamSpec, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import InputError

Real: TypeAlias = NDArray[np.float64]
Complex: TypeAlias = NDArray[np.complex128]
Whole: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]

_KINDS = {
    "b": "booleans",
    "c": "complex numbers",
    "S": "bytes",
    "U": "text",
    "M": "dates (datetime64)",
    "m": "durations (timedelta64)",
    "O": "Python objects",
    "V": "records",
}


def refuse(name: str, expected: str, found: str) -> InputError:
    """The exception for an argument that is not as it has to be."""
    error = InputError(f"{name}: expected {expected}, found {found}")
    error.key, error.expected, error.found = name, expected, found
    return error


def shown(value: object) -> str:
    """A value in few characters."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def nearest(text: str, names: Iterable[str]) -> str | None:
    """The name that was probably meant; ``None`` where none is near."""
    # The comparison takes time in proportion to both lengths.
    if len(text) > 256:
        return None
    by_lower = {name.lower(): name for name in names}
    found = difflib.get_close_matches(text.lower(), by_lower, 1)
    return by_lower[found[0]] if found else None


def hinted(text: str, names: Iterable[str]) -> str:
    """An unknown word as an error shows it, with the nearest known one."""
    near = nearest(text, names)
    quoted = f'"{shown(text)[1:-1]}"'
    return quoted if near is None else f'{quoted} ("{near}" is nearest)'


def one_of(value: Any, name: str, choices: Sequence[str], expected: str | None = None) -> str:
    """One of some words."""
    found = word(value, name)
    if found not in choices:
        listed = ", ".join(f'"{choice}"' for choice in choices[:-1]) + f' or "{choices[-1]}"'
        raise refuse(name, expected or listed, hinted(found, choices))
    return found


def only_keys(mapping: Mapping[Any, Any], name: str, known: Sequence[str], expected: str) -> None:
    """Refuses keys that are not known, with the nearest known one."""
    for key in mapping:
        if key not in known:
            raise refuse(name, expected, hinted(key, known) if isinstance(key, str) else shown(key))


_P = ParamSpec("_P")
_R = TypeVar("_R")
_C = TypeVar("_C", bound=type)


def hints(call: Callable[_P, _R]) -> Callable[_P, _R]:
    """The same call; an argument of a name that it does not have is a TypeError with the nearest name."""
    names = [one.name for one in inspect.signature(call).parameters.values() if one.name != "self"]
    title = call.__qualname__.removesuffix(".__init__")

    @functools.wraps(call)
    def hinting(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        for key in kwargs:
            if key not in names:
                near = nearest(key, names)
                said = f"; {near!r} is nearest" if near else f"; there are {', '.join(names)}"
                raise TypeError(f"{title}() has no argument {key!r}{said}")
        return call(*args, **kwargs)

    return hinting


def hints_of(made: _C) -> _C:
    """The same for a class."""
    # By its name: for the type checker a method is not to be assigned.
    setattr(made, "__init__", hints(vars(made)["__init__"]))
    return made


def numbers(values: Any, name: str, *, kinds: str = "iuf", expected: str = "real numbers") -> NDArray[Any]:
    """An array of numbers of these kinds, of any shape."""
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        raise refuse(name, expected, "masked values")
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        raise refuse(name, f"an array of {expected}", shown(values)) from None
    if array.dtype.kind not in kinds:
        found = _KINDS.get(array.dtype.kind, str(array.dtype))
        raise refuse(name, expected, f"{found}, {shown(values)}")
    return array


def _vector(array: NDArray[Any], name: str) -> NDArray[Any]:
    """A vector, also where it stands as a row or a column of a table."""
    if sum(size != 1 for size in array.shape) > 1:
        raise refuse(name, "one dimension", f"an array of {' x '.join(map(str, array.shape))}")
    vector: NDArray[Any] = np.atleast_1d(array).ravel()
    return vector


def real(values: ArrayLike, name: str) -> Real:
    """A vector of float64."""
    return np.asarray(_vector(numbers(values, name), name), dtype=np.float64)


def complex_(values: ArrayLike, name: str) -> Complex:
    """A vector of complex128."""
    found = numbers(values, name, kinds="iufc", expected="real or complex numbers")
    return np.asarray(_vector(found, name), dtype=np.complex128)


def number(value: Any, name: str, expected: str = "a real number") -> float:
    """One real number."""
    array = numbers(value, name, expected=expected)
    if array.size != 1:
        raise refuse(name, expected, shown(value))
    return float(array.reshape(()))


def optional_number(value: Any, name: str, expected: str = "a real number") -> float | None:
    """One real number, or nothing."""
    return None if value is None else number(value, name, expected)


def pair(value: Any, name: str) -> tuple[float, float]:
    """Two real numbers."""
    array = numbers(value, name, expected="two real numbers")
    if array.shape != (2,):
        raise refuse(name, "two real numbers", shown(value))
    return float(array[0]), float(array[1])


def optional_pair(value: Any, name: str) -> tuple[float, float] | None:
    """Two real numbers; ``None`` where none were given."""
    return None if value is None else pair(value, name)


def whole(value: Any, name: str, expected: str = "a whole number") -> int:
    """A whole number of Python or NumPy; neither a flag nor a float, whatever its value."""
    if isinstance(value, (bool, np.bool_)):
        raise refuse(name, expected, shown(value))
    try:
        return operator.index(value)
    except TypeError:
        raise refuse(name, expected, shown(value)) from None


def optional_whole(value: Any, name: str, least: int, most: int = 2**63 - 1) -> int | None:
    """A whole number from `least` on, or nothing."""
    if value is None:
        return None
    expected = f"a whole number of at least {least}"
    found = whole(value, name, expected)
    if not least <= found <= most:
        raise refuse(name, expected if found < least else f"at most {most}", str(found))
    return found


def flag(value: Any, name: str) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise refuse(name, "True or False", shown(value))
    return bool(value)


def word(value: Any, name: str) -> str:
    """A text."""
    if not isinstance(value, str):
        raise refuse(name, "a text", shown(value))
    return str(value)


def words(value: Any, name: str) -> list[str]:
    """A text, or several."""
    if isinstance(value, str):
        return [str(value)]
    return [word(one, name) for one in several(value, name, "a text or several")]


def several(values: Any, name: str, expected: str) -> list[Any]:
    """What a sequence holds; a text does not count as one."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise refuse(name, expected, shown(values))
    return list(values)


def callable_(value: Any) -> Any:
    """Something to call with (done, total), or nothing."""
    if value is not None and not callable(value):
        raise refuse("progress", "something to call with (done, total)", shown(value))
    return value


def row(value: Any, name: str, dim: int | None = None) -> int:
    """A row of a model, from 0."""
    expected = "a row, a whole number from 0" if dim is None else f"a row, a whole number from 0 to {dim - 1}"
    found = whole(value, name, expected)
    if found < 0 or (dim is not None and found >= dim):
        raise refuse(name, expected, str(found))
    return found


def sign(value: Any, name: str) -> float:
    """The sense that counts as positive."""
    found = number(value, name, "+1 or -1")
    if abs(found) != 1.0:
        raise refuse(name, "+1 or -1", shown(value))
    return found


def above(value: Any, name: str, least: float, unit: str = "") -> float:
    """A finite number above a limit."""
    expected = f"a number above {least:g}{unit}"
    found = number(value, name, expected)
    if not least < found < np.inf:
        raise refuse(name, expected, shown(value))
    return found


def share(text: Any) -> float | None:
    """The part of a whole that a text in per cent says, with the bits that the reader of case files gives it."""
    digits, percent, rest = text.strip().partition("%")
    try:
        return 0.01 * float(digits) if percent and not rest else None
    except ValueError:
        return None


def load_vector(load: ArrayLike, dim: int) -> Complex:
    """A unit force where `load` is one whole number (a row from 0), else `load` itself."""
    array = numbers(load, "load", kinds="iufc", expected="a row, or real or complex forces")
    if array.ndim == 0 and array.dtype.kind in "iu":
        force = np.zeros(dim, dtype=np.complex128)
        force[row(array.item(), "load", dim)] = 1.0
        return force
    return complex_(array, "load")


def only_of_a_model(**given: object) -> None:
    """Refuses what a case file has itself."""
    for name, value in given.items():
        if not (value is None or (isinstance(value, Sequence) and len(value) == 0)):
            raise refuse(name, "nothing beside a case file, which says it", shown(value))


def only_of_a_case(**given: object) -> None:
    """Refuses what works on files, beside a model; `save_case` makes a case of it."""
    for name, value in given.items():
        if value is not None:
            raise refuse(name, "nothing beside a model; save_case writes the arrays as a case file", shown(value))
