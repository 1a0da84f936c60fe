"""Models, and what they answer as they are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    callable_,
    load_vector,
    number,
    numbers,
    real,
    refuse,
    row,
    several,
    shown,
    sign,
    whole,
    word,
    words,
)
from ._frfit import Law, Series
from ._matrix import compressed

Role: TypeAlias = Literal["stiffness", "viscous", "mass"]
Progress: TypeAlias = Callable[[int, int], object]


@dataclass(frozen=True, eq=False)
class Term:
    """One term of D(omega) = sum factor stiffness + i omega sum factor viscous - omega^2 sum factor mass.

    Parameters
    ----------
    name
        By which ``identify`` asks for it.
    matrix
        (n, n), symmetric, real or complex: sparse of any format, or dense. With ``factor`` in Pa it is in m, with
        factor 1 in N/m, N s/m or kg.
    role
        ``"stiffness"``, ``"viscous"`` or ``"mass"``.
    factor
        A number, a complex number E (1 + i eta), or a :class:`Law` of frequency; nominal where it is unknown.
    storage_std, loss_factor_std
        How well a known factor is known, carried into every error bar: a number in the unit of the factor, of the loss factor
        a number; or a text as ``"2 %"`` of either.
    """

    name: str
    matrix: Any
    role: Role = "stiffness"
    factor: complex | Law = 1.0
    storage_std: float | str | None = None
    loss_factor_std: float | str | None = None


class Model:
    """A finite element model: terms on one pattern, analysed once, for any number of calls.

    Raises
    ------
    MatrixError
        A matrix that is not square, symmetric to 1e-10 of its largest entry, and finite.
    ModelError
        No term, different sizes, a name twice.
    """

    def __init__(self, terms: Sequence[Term]) -> None:
        plain = []
        for term in several(terms, "terms", "a sequence of Term"):
            if not isinstance(term, Term):
                raise refuse("terms", "a sequence of Term", shown(term))
            name = word(term.name, "name")
            role = word(term.role, f"matrix {name!r}.role")
            law = _law(term.factor, f"matrix {name!r}.factor")
            plain.append((name, role, law, _std(term, name), *compressed(term.matrix, name)))
        self._model = _frfit.Model(plain)

    @property
    def dim(self) -> int:
        """Degrees of freedom n."""
        return self._model.dim

    @property
    def names(self) -> list[str]:
        """The names of the terms."""
        return self._model.names

    def __repr__(self) -> str:
        return f"<frfit.Model of {self.dim} degrees of freedom: {', '.join(self.names)}>"


def _law(factor: Any, name: str) -> Law:
    """A law, of a number the constant one."""
    if isinstance(factor, Law):
        return factor
    expected = "a real or complex number, or a Law"
    array = numbers(factor, name, kinds="iufc", expected=expected)
    if array.size != 1 or not np.isfinite(array).all():
        raise refuse(name, f"{expected}, finite", shown(factor))
    return Law.constant(complex(array.reshape(())))


def _std(term: Term, name: str) -> tuple[float | None, float | None]:
    """Standard deviations of a factor: relative of the storage, absolute of the loss factor."""
    unit = loss_factor = np.nan
    if not isinstance(term.factor, Law):
        factor = complex(term.factor)
        unit, loss_factor = (1 / abs(factor.real), abs(factor.imag / factor.real)) if factor.real else (np.nan, np.nan)
    return (
        _deviation(term.storage_std, f"matrix {name!r}.storage_std", unit=unit, share_of=1.0),
        _deviation(term.loss_factor_std, f"matrix {name!r}.loss_factor_std", unit=1.0, share_of=loss_factor),
    )


def _deviation(value: Any, name: str, *, unit: float, share_of: float) -> float | None:
    """A number times ``unit``, or a text in per cent of ``share_of``; NaN stands for a form that is not possible."""
    if value is None:
        return None
    forms = [(unit, "a number above 0"), (share_of, 'a text as "2 %"')]
    expected = " or ".join(form for times, form in forms if np.isfinite(times))
    if isinstance(value, str):
        digits, percent, rest = value.partition("%")
        try:
            std = share_of * float(digits) / 100 if percent and not rest.strip() else np.nan
        except ValueError:
            std = np.nan
    else:
        std = unit * number(value, name, expected)
    if not 0 < std < np.inf:
        raise refuse(name, expected, shown(value))
    return std


def model_of(model: Any) -> _frfit.Model:
    """The compiled model."""
    if not isinstance(model, Model):
        raise refuse("model", "a Model", shown(model))
    return model._model


def sensors_of(sensors: Any, signs: Any, dim: int) -> tuple[list[int], list[float]]:
    rows = [row(one, "sensors", dim) for one in several(sensors, "sensors", "a sequence of rows")]
    if not rows:
        raise refuse("sensors", "at least one row", "none")
    if signs is None:
        return rows, [1.0] * len(rows)
    senses = [sign(one, "signs") for one in several(signs, "signs", "a sequence of +1 and -1")]
    if len(senses) != len(rows):
        raise refuse("signs", f"{len(rows)}, one for each sensor", str(len(senses)))
    return rows, senses


def respond(
    model: Model,
    frequency_hz: ArrayLike,
    *,
    load: ArrayLike,
    sensors: Sequence[int],
    signs: Sequence[float] | None = None,
    progress: Progress | None = None,
) -> Complex:
    """Receptance of the model as it is, by one direct solve a frequency, on all cores.

    Parameters
    ----------
    frequency_hz
        (f,), Hz.
    load
        A row (unit force), or the force vector (n,), N.
    sensors, signs
        Rows, and +1 or -1 for the sense that counts as positive.
    progress
        Called with (done, total).

    Returns
    -------
    (f, sensors), complex, m/N (m where ``load`` is a vector in N); NaN where the system cannot be solved.

    Examples
    --------
    >>> import numpy as np
    >>> spring = Model([Term("k", [[100.0]]), Term("m", [[2.0]], role="mass")])
    >>> x = respond(spring, [0.0, 1.0], load=0, sensors=[0])
    >>> bool(np.allclose(x[:, 0], [1 / 100, 1 / (100 - 2 * (2 * np.pi) ** 2)]))
    True
    """
    compiled = model_of(model)
    rows, senses = sensors_of(sensors, signs, model.dim)
    force = load_vector(load, model.dim)
    return _frfit.respond(compiled, force, rows, senses, real(frequency_hz, "frequency_hz"), callable_(progress))


def series(
    model: Model,
    frequency_hz: float,
    *,
    load: ArrayLike,
    sensors: Sequence[int],
    matrix: str | Sequence[str],
    order: int = 30,
    signs: Sequence[float] | None = None,
) -> Series:
    """The Neumann series of the response in the factor of ``matrix``, about its nominal value, at one frequency.

    x(c) = sum_k coefficients[:, k] (c / scale)^k, from one factorisation and ``order + 1`` solves.

    Raises
    ------
    SolveError
        The nominal system cannot be solved there.

    Examples
    --------
    >>> spring = Model([Term("k", [[1.0]], factor=100.0), Term("m", [[2.0]], role="mass")])
    >>> s = series(spring, 0.0, load=0, sensors=[0], matrix="k", order=3)
    >>> s.coefficients.real.round(4).tolist()            # 1/(100 + c) with z = c/100
    [[0.01, -0.01, 0.01, -0.01]]
    >>> round(s.spectral_radius(50.0), 6)                # converges for |c| < 100
    0.5
    """
    compiled = model_of(model)
    rows, senses = sensors_of(sensors, signs, model.dim)
    force = load_vector(load, model.dim)
    hz = number(frequency_hz, "frequency_hz")
    most = max(whole(order, "order"), 0)
    return _frfit.series(compiled, force, rows, senses, hz, words(matrix, "matrix"), most)
