"""Models, and what they answer as they are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    above,
    callable_,
    hints,
    hints_of,
    load_vector,
    number,
    numbers,
    one_of,
    real,
    refuse,
    row,
    several,
    share,
    shown,
    sign,
    whole,
    word,
    words,
)
from ._frfit import Law, Series
from ._matrix import compressed, described, glanced_at
from ._shown import arguments, some

Role: TypeAlias = Literal["stiffness", "viscous", "mass"]
Progress: TypeAlias = Callable[[int, int], object]

_ROLES = ("stiffness", "viscous", "mass")


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class Term:
    """One term of D(omega) = sum factor stiffness + i omega sum factor viscous - omega^2 sum factor mass.

    Name, role, factor and the size of the matrix are checked as it is made; that the matrix is symmetric, as a
    :class:`Model` is made of it.

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

    Raises
    ------
    MatrixError
        A matrix that is not square, or not of finite numbers.
    InputError
        Any other argument that is not as it has to be.
    """

    name: str
    matrix: Any
    role: Role = "stiffness"
    factor: complex | Law = 1.0
    storage_std: float | str | None = None
    loss_factor_std: float | str | None = None

    def __post_init__(self) -> None:
        name = word(self.name, "name")
        if not name.strip():
            raise refuse("name", "a name", '""')
        one_of(self.role, f"matrix {name!r}.role", _ROLES)
        _law(self.factor, f"matrix {name!r}.factor")
        _std(self, name)
        glanced_at(self.matrix, name)

    def __repr__(self) -> str:
        factor = self.factor if isinstance(self.factor, Law) else f"{complex(self.factor):.6g}"
        known = [f"{key} {shown(std)}" for key in ("storage_std", "loss_factor_std") if (std := getattr(self, key))]
        return f"<frfit.Term {self.name!r}: {', '.join([self.role, described(self.matrix), f'factor {factor}', *known])}>"


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class Attached:
    """What is on the structure and not in its matrices: an accelerometer, the tip of a hammer, a suspension.

    One term of the model for each number, with entries on the diagonal only, as ``[[attached]]`` of a case file. No rotary inertia.

    Parameters
    ----------
    row
        The row of the model, from 0; of a mass also several, in all of which it moves (the translations of its node).
    mass
        A point mass, kg.
    stiffness
        A spring to ground, N/m; of a rotation N m/rad.
    damping
        A viscous damper to ground, N s/m; of a rotation N m s/rad.
    """

    row: int | Sequence[int]
    mass: float | None = None
    stiffness: float | None = None
    damping: float | None = None

    def __post_init__(self) -> None:
        _plain_attached(self, None)

    def __repr__(self) -> str:
        return arguments("Attached", self, ["row"], ["mass", "stiffness", "damping"])


def _plain_attached(one: Attached, dim: int | None) -> list[tuple[str, str, list[int], float]]:
    """What is attached as words, roles, rows and values."""
    if isinstance(one.row, (int, np.integer)) and not isinstance(one.row, bool):
        rows = [row(one.row, "attached.row", dim)]
    else:
        expected = "a row, or several of a mass"
        rows = [row(each, "attached.row", dim) for each in several(one.row, "attached.row", expected)]
        if not rows or len(set(rows)) != len(rows):
            raise refuse("attached.row", f"{expected}, each once", shown(one.row))
    plain = []
    units = (("mass", "mass", "kg"), ("stiffness", "stiffness", "N/m"), ("damping", "viscous", "N s/m"))
    for key, role, unit in units:
        value = getattr(one, key)
        if value is None:
            continue
        if role != "mass" and len(rows) > 1:
            raise refuse(f"attached.{key}", "None beside several rows, which are of a mass", shown(value))
        plain.append((key, role, rows, above(value, f"attached.{key}", 0.0, f" {unit}")))
    if not plain:
        raise refuse("attached", "at least one of mass, stiffness and damping", "none")
    return plain


class Model:
    """A finite element model: terms on one pattern, analysed once, for any number of calls.

    Parameters
    ----------
    terms
        The matrices with their factors; all have the same rows.
    attached
        Masses, springs and dampers that are on the structure and not in the matrices.

    Raises
    ------
    MatrixError
        A matrix that is not square, symmetric to 1e-10 of its largest entry, and finite.
    ModelError
        No term, different sizes, a name twice.
    """

    @hints
    def __init__(self, terms: Sequence[Term], *, attached: Attached | Sequence[Attached] = ()) -> None:
        plain: list[tuple[str, str, Law, tuple[float | None, float | None], Any, Any, Any, Any]] = []
        for term in several(terms, "terms", "a sequence of Term"):
            if not isinstance(term, Term):
                raise refuse("terms", "a sequence of Term", shown(term))
            law = _law(term.factor, f"matrix {term.name!r}.factor")
            plain.append((term.name, term.role, law, _std(term, term.name), *compressed(term.matrix, term.name)))
        expected = "an Attached or several"
        listed = [attached] if isinstance(attached, Attached) else several(attached, "attached", expected)
        for k, one in enumerate(listed, 1):
            if not isinstance(one, Attached):
                raise refuse("attached", expected, shown(one))
            # A model without terms is refused below.
            dim = plain[0][4][0] if plain else None
            for key, role, rows, value in _plain_attached(one, dim):
                size = dim or max(rows) + 1
                diagonal = sp.csc_array(([value] * len(rows), (rows, rows)), shape=(size, size))
                name = f"attached {k} ({key})"
                plain.append((name, role, Law.constant(1.0), (None, None), *compressed(diagonal, name)))
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
        return f"<frfit.Model of {self.dim} degrees of freedom: {some(self.names)}>"


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
    storage = loss_factor = np.nan
    if not isinstance(term.factor, Law):
        factor = complex(term.factor)
        storage, loss_factor = (abs(factor.real), abs(factor.imag / factor.real)) if factor.real else (np.nan, np.nan)
    return (
        _deviation(term.storage_std, f"matrix {name!r}.storage_std", over=storage, share_of=1.0),
        _deviation(term.loss_factor_std, f"matrix {name!r}.loss_factor_std", over=1.0, share_of=loss_factor),
    )


def _deviation(value: Any, name: str, *, over: float, share_of: float) -> float | None:
    """A number over ``over``, or a text in per cent of ``share_of``; NaN stands for a form that is not possible.

    In the order of the reader of case files, so that both have the same bits.
    """
    if value is None:
        return None
    forms = [(over, "a number above 0"), (share_of, 'a text as "2 %"')]
    expected = " or ".join(form for times, form in forms if np.isfinite(times))
    if isinstance(value, str):
        part = share(value)
        std = np.nan if part is None else part * share_of
    else:
        std = number(value, name, expected) / over
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


@hints
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


@hints
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
