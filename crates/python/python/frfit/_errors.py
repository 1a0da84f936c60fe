"""One exception for each kind of error; the text is that of the command line."""

from __future__ import annotations


class FrfitError(Exception):
    """The base of every exception of frfit."""


class InputError(FrfitError, ValueError):
    """Something that has to be put right: ``place: expected ..., found ...``.

    Attributes: ``file``, ``line``, ``column`` (from 1) where a file is at fault, ``key`` of the case file or name of
    the argument, ``expected`` and ``found``. What does not apply is ``None``.
    """

    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    expected: str = ""
    found: str = ""


class MatrixError(FrfitError, ValueError):
    """A matrix that is no term of a dynamic stiffness: not square, not symmetric, not finite."""


class ModelError(FrfitError, ValueError):
    """Matrices that make no model, or a name that none of them has."""


class OptionsError(FrfitError, ValueError):
    """An option that is not as it can be."""


class TableError(FrfitError, ValueError):
    """A table of a factor whose rows are not ascending and finite."""


class OutsideTableError(FrfitError, ValueError):
    """A frequency that the table of a factor does not reach: no law extrapolates."""


class ModelMemoryError(FrfitError, MemoryError):
    """A model that does not fit into memory, with the numbers."""


class SolveError(FrfitError, ArithmeticError):
    """The nominal system cannot be solved at the one frequency that was asked for."""


class SignalError(FrfitError, ValueError):
    """Records of which no FRF can be made."""


class WriteError(FrfitError, OSError):
    """A file that could not be written."""


class InternalError(FrfitError, RuntimeError):
    """A fault of frfit."""
