"""From a measured response to the factor that reproduces it."""

from __future__ import annotations

import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import (
    Complex,
    above,
    callable_,
    complex_,
    flag,
    hinted,
    hints,
    hints_of,
    load_vector,
    number,
    one_of,
    only_keys,
    optional_number,
    optional_pair,
    optional_whole,
    pair,
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
from ._errors import OptionsError
from ._model import Model, Progress, model_of, sensors_of
from ._result import Identification
from ._shown import array, arguments, counted, span
from ._uff import FrfOfFile, UffDof, frfs_of

Quantity: TypeAlias = Literal["receptance", "mobility", "accelerance"]

_QUANTITIES = ("receptance", "mobility", "accelerance")
MEASUREMENT_KEYS: tuple[tuple[str, float | None], ...] = (
    ("scale", 1.0),
    ("delay_s", 0.0),
    ("decay_per_s", 0.0),
    ("window", None),
    ("record_s", None),
)
"""What a measurement has beside its values, with what it is where nothing is said."""
_VARIES = ("frequency", "smooth", "constant", "law")
# The words of the reader of case files.
_EXPECTED_VARIES = '"frequency" (a value of its own at each), "smooth", "constant" or "law"'
_LAWS = ("constant", "fractional", "zener", "maxwell")
_EXPECTED_LAWS = '"constant", "fractional", "zener" or "maxwell" ("maxwell:N" with N from 1 to 20 branches)'
_METHODS = ("series", "rational", "nelder-mead")


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class Measurement:
    """A measured FRF, and where it was measured.

    Parameters
    ----------
    frequency_hz
        (f,), Hz, ascending.
    response
        (f,), complex: receptance m/N, mobility m/(s N) or accelerance m/(s^2 N).
    row, sign
        Row of the model from 0, and -1 where motion against it counts as positive.
    quantity
        ``"receptance"``, ``"mobility"`` or ``"accelerance"``.
    std
        (f,), standard deviation of the complex value, sqrt(E |dH|^2), in the unit of ``response``.
    coherence, averages
        (f,), and of how many averages: another way to say how well it was measured.
    scale
        What the values are to be multiplied by; ``"unknown"`` is found, beside a known channel or with a law.
    delay_s
        By how much the channel is late, s; ``"unknown"`` as above.
    decay_per_s
        Decay rate of an exponential window exp(-decay_per_s t) on force and response, 1/s (``MeasuredFrf.decay_per_s``): the
        model is evaluated at the complex frequency of the window. The same for all measurements.
    window
        Window of random excitation. ``"hann"``: what leaks into the lines around narrow resonances is removed; ``"none"``:
        nothing is; ``None``: it is removed where the data show it. The same for all measurements.
    record_s
        Length of the records under a Hann window, s; ``None``: 1 over the spacing of the frequencies.
    """

    frequency_hz: ArrayLike
    response: ArrayLike
    row: int
    quantity: Quantity = "receptance"
    sign: float = 1.0
    std: ArrayLike | None = None
    coherence: ArrayLike | None = None
    averages: int | None = None
    scale: float | Literal["unknown"] = 1.0
    delay_s: float | Literal["unknown"] = 0.0
    decay_per_s: float = 0.0
    window: Literal["hann", "none"] | None = None
    record_s: float | None = None

    def __post_init__(self) -> None:
        _frfit.check_measurement("measurement", _plain(self, "measurement"))

    def __repr__(self) -> str:
        frequency_hz = np.ravel(np.asarray(self.frequency_hz))
        parts = [f"{counted(frequency_hz.size, 'frequency', 'frequencies')}, {span(frequency_hz)}"]
        if self.std is not None:
            size = np.abs(np.ravel(np.asarray(self.response)))
            share = np.median(np.ravel(np.asarray(self.std))[size > 0] / size[size > 0]) if size.any() else np.nan
            parts.append(f"std {100 * share:.2g} % (median)")
        elif self.coherence is not None:
            averages = "" if self.averages is None else f" of {self.averages} averages"
            parts.append(f"coherence {np.median(np.asarray(self.coherence)):.4g} (median){averages}")
        for key, default in MEASUREMENT_KEYS:
            if (value := getattr(self, key)) != default:
                parts.append(f"{key} {value}")
        sense = "-" if sign(self.sign, "sign") < 0 else "+"
        return f"<frfit.Measurement of {self.quantity} at row {self.row} ({sense}): {', '.join(parts)}>"

    @classmethod
    def from_uff(
        cls,
        path: str | os.PathLike[str],
        dofs: Mapping[str, int],
        *,
        driven_at: str | UffDof | None = None,
        quantity: Quantity | None = None,
        averages: int | None = None,
        scale: float | Literal["unknown"] = 1.0,
        delay_s: float | Literal["unknown"] = 0.0,
        decay_per_s: float | None = None,
        window: Literal["hann", "none"] | None = None,
        record_s: float | None = None,
    ) -> list[Measurement]:
        """Measurements of a universal file, in the order of ``dofs``: values and noise are those that a case file gets.

        ``dofs`` has the name of each response, which chooses the record, and the row of the model along that axis, from 0:
        ``{"34+Z": 97, "12-X": 4}``; motion against the axis counts as positive where the name has a minus. ``driven_at`` is the
        name of the degree of freedom of the force, where the file has records of several. With it, a record with the two ends
        exchanged is taken where there is no other: that of a hammer that moves.

        The values are in SI units where the file says its units (dataset 164). Standard deviation and coherence are taken where
        the file has them between the same degrees of freedom at the same frequencies; the coherence only weighs without
        ``averages``. ``quantity`` is needed where the file does not say it. ``decay_per_s`` may not be another than the file's.

        A name without a record or with several, and units that contradict labels, are an :class:`InputError` that says what there is.
        """
        if not isinstance(dofs, Mapping) or not dofs:
            raise refuse("dofs", 'a dictionary of names and rows, such as {"34+Z": 97}', shown(dofs))
        said = None if quantity is None else cast(Quantity, one_of(quantity, "quantity", _QUANTITIES))
        decay = None if decay_per_s is None else number(decay_per_s, "decay_per_s")
        measured = []
        for name, found in frfs_of(path, list(dofs), driven_at).items():
            measured.append(
                cls(
                    found.frequency_hz,
                    found.response,
                    row(dofs[name], f"dofs[{name!r}]"),
                    said or _quantity_of(found, name, path),
                    sign=found.sign,
                    std=found.std,
                    coherence=found.coherence,
                    averages=averages,
                    scale=scale,
                    delay_s=delay_s,
                    decay_per_s=_decay_of(found, decay, path),
                    window=window,
                    record_s=record_s,
                )
            )
        return measured


def _quantity_of(found: FrfOfFile, name: str, path: Any) -> Quantity:
    if found.quantity is None:
        what = f"{name} of {os.fspath(path)} with an ordinate of {found.ordinate or 'no quantity'}"
        raise refuse("quantity", "receptance, mobility or accelerance, because the file does not say", what)
    return cast(Quantity, found.quantity)


def _decay_of(found: FrfOfFile, decay_per_s: float | None, path: Any) -> float:
    """What the file says, or else the argument; neither may contradict the other."""
    if found.decay_per_s is None:
        return decay_per_s or 0.0
    # Two numbers that are the same but for the digits they are written with.
    if decay_per_s is not None and abs(decay_per_s - found.decay_per_s) > 1e-6 * max(decay_per_s, found.decay_per_s):
        raise refuse("decay_per_s", f"{found.decay_per_s}, as {os.fspath(path)} says, or None", str(decay_per_s))
    return found.decay_per_s


def _plain(one: Measurement, name: str) -> SimpleNamespace:
    """The measurement with plain arrays."""

    def below(key: str) -> str:
        return f"{name}.{key}"

    def known(value: Any, key: str) -> float | None:
        if isinstance(value, str) and value == "unknown":
            return None
        return number(value, below(key), 'a real number or "unknown"')

    return SimpleNamespace(
        row=row(one.row, below("row")),
        sign=sign(one.sign, below("sign")),
        quantity=one_of(one.quantity, below("quantity"), _QUANTITIES),
        frequency_hz=real(one.frequency_hz, below("frequency_hz")),
        response=complex_(one.response, below("response")),
        std=None if one.std is None else real(one.std, below("std")),
        coherence=None if one.coherence is None else real(one.coherence, below("coherence")),
        averages=_averages(one, below("averages")),
        scale=known(one.scale, "scale"),
        delay_s=known(one.delay_s, "delay_s"),
        decay_per_s=number(one.decay_per_s, below("decay_per_s")),
        window=None if one.window is None else one_of(one.window, below("window"), ("hann", "none")),
        record_s=optional_number(one.record_s, below("record_s")),
    )


def _averages(one: Measurement, name: str) -> int | None:
    """The coherence of one record says nothing: it is one."""
    return optional_whole(one.averages, name, 1 if one.coherence is None else 2)


def _band(entry: Any) -> tuple[float, float]:
    """A line as a band of no width."""
    if np.ndim(entry) == 0:
        line = number(entry, "exclude_hz")
        return line, line
    return pair(entry, "exclude_hz")


def _optional_word(value: Any, name: str) -> str | None:
    return None if value is None else word(value, name)


_SIZES = ("frequency", "shape", "calibration")


def _model_error(value: Any) -> str | float | dict[str, float] | None:
    expected = '"estimated", "none", a number above 0 up to 0.5, a text as "0.5 %", or a dictionary of frequency, shape and calibration'
    if value is None or value in ("estimated", "none"):
        return None if value is None else str(value)
    if isinstance(value, Mapping):
        only_keys(value, "model_error", _SIZES, "frequency, shape or calibration")
        if not value:
            raise refuse("model_error", expected, "{}")
        one = 'a number above 0 up to 0.5, or a text as "1 %"'
        return {key: _size(size, f"model_error.{key}", one) for key, size in value.items()}
    if isinstance(value, str) and "%" not in value:
        raise refuse("model_error", expected, hinted(value, ("estimated", "none")))
    return _size(value, "model_error", expected)


def _size(value: Any, name: str, expected: str) -> float:
    """The size of an error of the model, relative."""
    found = share(value) if isinstance(value, str) else number(value, name, expected)
    if found is None or not 0.0 < found <= 0.5:
        raise refuse(name, expected, shown(value))
    return found


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class CoarserMesh:
    """The same structure on a coarser mesh, which says how far the natural frequencies of the model are off.

    From the difference between the meshes frfit estimates the error of the model. It corrects the model for this error, and widens
    every error bar by what it does not know of it.

    Parameters
    ----------
    model
        The same terms in the same order, with the same known factors.
    load, sensors, signs
        As of ``respond``: the same force, and one sensor for each measurement.
    element_ratio
        Length of its elements over that of the model's.
    order
        Errors of natural frequencies go with this power of the length of elements.
    """

    model: Model
    load: ArrayLike
    sensors: Sequence[int]
    signs: Sequence[float] | None = None
    element_ratio: float = 2.0
    order: float = 2.0


    def __post_init__(self) -> None:
        _plain_mesh(self)

    def __repr__(self) -> str:
        sensors = len(list(self.sensors))
        load = f"row {shown(self.load)}" if np.ndim(self.load) == 0 else f"{array(self.load)} values"
        said = f"load {load}, {counted(sensors, 'sensor')}, element_ratio {self.element_ratio}, order {self.order}"
        return f"<frfit.CoarserMesh of {self.model.dim} degrees of freedom: {said}>"


def _plain_mesh(mesh: CoarserMesh) -> dict[str, Any]:
    """The mesh as the compiled part takes it."""
    compiled = model_of(mesh.model)
    rows, senses = sensors_of(mesh.sensors, mesh.signs, compiled.dim)
    load = load_vector(mesh.load, compiled.dim)
    if load.size != compiled.dim:
        raise refuse("load", f"{compiled.dim} values, one for each row", str(load.size))
    if not np.isfinite(load).all():
        raise refuse("load", "finite values", shown(load[~np.isfinite(load)][0].item()))
    if not load.any():
        raise refuse("load", "a load that is not zero in every row", "zeros only")
    plain: dict[str, Any] = {"model": compiled, "load": load, "sensors": list(zip(rows, senses, strict=True))}
    for key, least in (("element_ratio", 1.0), ("order", 0.0)):
        plain[key] = above(getattr(mesh, key), f"coarser_mesh.{key}", least)
        if plain[key] > _MOST:
            raise refuse(f"coarser_mesh.{key}", f"a number above {least:g} up to {_MOST:g}", shown(plain[key]))
    return plain


_MOST = 16.0
"""The largest ratio of elements, and the largest order."""


def _coarser_mesh(mesh: Any) -> dict[str, Any] | None:
    if mesh is None:
        return None
    if not isinstance(mesh, CoarserMesh):
        raise refuse("coarser_mesh", "a CoarserMesh", shown(mesh))
    return _plain_mesh(mesh)


@hints_of
@dataclass(frozen=True, eq=False, repr=False)
class Unknown:
    """Something to identify: the keys of one ``[[identify]]`` of a case file.

    Parameters
    ----------
    name
        What it is called in the result.
    matrix
        The name of the term whose factor is unknown, or of several that share it.
    powers
        In place of ``matrix``: a geometric parameter, ``{"bending": 3, "mass": 1}``; the factors of these terms are
        multiplied by its powers.
    nominal
        The value of a geometric parameter to begin with.
    varies
        ``"frequency"``: a value of its own at each; ``"constant"``: one for the band, as is usual of a geometric parameter;
        ``"law"``: by ``law``; ``"smooth"``: neighbours help each other.
    law
        ``"constant"``, ``"fractional"``, ``"zener"``, ``"maxwell:N"``; of a single unknown several to compare.
    bounds
        ``{"storage": (low, high), "loss_factor": (low, high)}``, or ``(low, high)`` of a real one.
    real
        Whether it is real; a geometric parameter is.
    """

    name: str | None = None
    matrix: str | Sequence[str] = ()
    powers: Mapping[str, int] | None = None
    nominal: float | None = None
    varies: Literal["frequency", "smooth", "constant", "law"] | None = None
    law: str | Sequence[str] = ()
    bounds: Mapping[str, tuple[float, float]] | tuple[float, float] | None = None
    real: bool | None = None

    def __post_init__(self) -> None:
        _plain_unknown(self)

    def __repr__(self) -> str:
        others = ["matrix", "powers", "nominal", "varies", "law", "bounds", "real"]
        return arguments("Unknown", self, [], ["name", *others])


def _laws(law: Any, varies: str | None) -> list[str]:
    laws = words(law, "law")
    for one in laws:
        number_of = re.fullmatch(r"maxwell:(\d+)", one)
        if one not in _LAWS and not (number_of and 1 <= int(number_of[1]) <= 20):
            raise OptionsError(f"law: expected {_EXPECTED_LAWS}, found {hinted(one, _LAWS)}")
    if laws and varies not in (None, "law"):
        raise refuse("law", 'varies = "law" beside it', f'varies = "{varies}"')
    for k, one in enumerate(laws):
        if one in laws[:k]:
            raise refuse("law", "each law once", f'"{one}" a second time')
    return laws


def _plain_unknown(one: Unknown) -> dict[str, Any]:
    """The unknown as the compiled part takes it."""
    powers = one.powers
    if powers is not None and not (isinstance(powers, Mapping) and powers):
        raise refuse("powers", "a dictionary of matrices and powers", shown(powers))
    powers = {word(name, "powers"): whole(power, f"powers.{name}") for name, power in (powers or {}).items()}
    for name, power in powers.items():
        if power == 0 or abs(power) > 12:
            raise refuse(f"powers.{name}", "a whole number from -12 to 12 other than 0", str(power))
    matrices = words(one.matrix, "matrix")
    if bool(matrices) == bool(powers):
        raise refuse("matrix", "one of matrix and powers", "both" if matrices else "none")
    if powers and one.name is None:
        raise refuse("name", "the name of a geometric parameter", "none")
    if one.nominal is not None and not powers:
        raise refuse("nominal", "None: it is the factor of the matrix", shown(one.nominal))
    if powers and one.nominal is None:
        raise refuse("nominal", "the value of a geometric parameter to begin with", "none")
    nominal = optional_number(one.nominal, "nominal")
    if nominal is not None and not (np.isfinite(nominal) and nominal != 0.0):
        raise refuse("nominal", "a finite number other than 0", shown(one.nominal))
    is_real = bool(powers) if one.real is None else flag(one.real, "real")
    storage, loss_factor = _bounds(one.bounds, is_real)
    varies = None if one.varies is None else one_of(one.varies, "varies", _VARIES, _EXPECTED_VARIES)
    return {
        "name": None if one.name is None else word(one.name, "name"),
        "matrices": matrices,
        "powers": list(powers.items()),
        "nominal": nominal,
        "varies": varies,
        "laws": _laws(one.law, varies),
        "storage": storage,
        "loss_factor": loss_factor,
        "real": is_real,
    }


def _bounds(bounds: Any, is_real: bool) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Those of storage modulus and loss factor."""
    if bounds is not None and not isinstance(bounds, Mapping):
        if not is_real:
            raise refuse("bounds", "a dictionary of storage and loss_factor", shown(bounds))
        return _bound(bounds, "bounds"), None
    bounds = dict(bounds or {})
    only_keys(bounds, "bounds", ("storage", "loss_factor"), "storage or loss_factor")

    def bound(key: str) -> tuple[float, float] | None:
        return _bound(bounds[key], f"bounds.{key}") if bounds.get(key) is not None else None

    return bound("storage"), bound("loss_factor")


def _bound(value: Any, name: str) -> tuple[float, float]:
    low, high = pair(value, name)
    # Written so that NaN fails too.
    if not (low <= high and np.isfinite(low) and np.isfinite(high)):
        raise refuse(name, "two finite numbers, the lower one first", f"({low:g}, {high:g})")
    return low, high


def _unknowns(unknowns: Any, of_one: dict[str, Any]) -> list[Unknown]:
    """The unknowns, or the one that the arguments of a single one say."""
    if unknowns is None:
        if not words(of_one["matrix"], "matrix"):
            raise refuse("matrix", "the name of a term, or unknowns", "none")
        return [Unknown(**of_one)]
    for name, value in of_one.items():
        if value not in (None, (), False):
            raise refuse(name, "None beside unknowns, each of which has its own", shown(value))
    expected = "an Unknown or several"
    listed = [unknowns] if isinstance(unknowns, Unknown) else several(unknowns, "unknowns", expected)
    for one in listed:
        if not isinstance(one, Unknown):
            raise refuse("unknowns", expected, shown(one))
    if not listed:
        raise refuse("unknowns", expected, "none")
    return listed


@hints
def identify(
    model: Model,
    measurements: Measurement | Sequence[Measurement],
    *,
    load: ArrayLike,
    matrix: str | Sequence[str] = (),
    unknowns: Unknown | Sequence[Unknown] | None = None,
    band_hz: tuple[float, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | tuple[float, float] | None = None,
    start: Literal["bounds"] | None = None,
    method: Literal["rational", "series", "nelder-mead"] | None = None,
    order: int | None = None,
    selection: Literal["joint", "smallest"] | None = None,
    reduction: Literal["auto", "full", "subspace"] | None = None,
    varies: Literal["frequency", "smooth", "constant", "law"] | None = None,
    law: str | Sequence[str] = (),
    real: bool = False,
    reject_outliers: bool | None = None,
    model_error: Literal["estimated", "none"] | float | str | Mapping[str, float | str] | None = None,
    coarser_mesh: CoarserMesh | None = None,
    exclude_hz: Sequence[float | tuple[float, float]] = (),
    max_lines: int | None = None,
    check: bool = True,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> Identification:
    """The unknown factor of ``matrix``, or ``unknowns``, from measured FRFs, and how far to trust them.

    The arguments are the keys of ``[identify]`` in a case file. Ctrl-C is answered at once.

    Parameters
    ----------
    load
        A row (unit force), or the force vector (n,), N.
    matrix
        The name of the term whose factor is unknown, or of several that share it.
    unknowns
        In place of ``matrix``, ``bounds``, ``varies``, ``law`` and ``real``: several unknowns, each with its own. With several
        unknowns ``method``, ``order``, ``selection``, ``reduction`` and ``start`` are refused: there is one method.
    bounds
        ``{"storage": (low, high), "loss_factor": (low, high)}``, storage in the unit of the factor.
    varies
        ``"frequency"``: a factor of its own at each frequency; ``"smooth"``: a smooth curve, in which neighbours help each
        other; ``"constant"``: one value for the band; ``"law"``: a law. With ``law`` given, ``"law"`` may be left out. Without
        ``law`` all laws are compared.
    model_error
        ``"estimated"``: frfit estimates errors of the model where the band shows them, and corrects for them. ``"none"``: the
        model is taken as exact. A number, or a text as ``"0.5 %"``: standard deviation of the natural frequencies. With
        ``{"frequency": 0.005, "shape": "2 %", "calibration": 0.01}`` also those of mode shapes and of the calibrations of force
        and sensors. Every error bar includes them.
    coarser_mesh
        The same structure on a coarser mesh, by which the error of this one is measured.
    max_lines
        The largest number of frequencies: half evenly spread, half where the measurement changes fastest.
        The others are ``out_of_band``.
    law
        ``"constant"``, ``"fractional"``, ``"zener"``, ``"maxwell:N"`` or several: fitted to the whole band.
    progress
        Called with (frequencies done, of how many).

    Raises
    ------
    InputError, ModelError, OptionsError, OutsideTableError, ModelMemoryError
        What has to be put right. Numerical trouble is a status of its frequency, never an exception.

    Examples
    --------
    >>> import numpy as np
    >>> from frfit import Term, respond
    >>> K, M = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.diag([0.01, 0.01])
    >>> def springs(k):
    ...     return Model([Term("k", K, factor=k), Term("m", M, role="mass")])
    >>> f = np.linspace(5.0, 120.0, 24)
    >>> u = respond(springs(1000 * (1 + 0.02j)), f, load=0, sensors=[1])[:, 0]
    >>> found = identify(springs(1300.0), Measurement(f, u, row=1), load=0, matrix="k")
    >>> bool(np.allclose(found.factor[found.ok], 1000 * (1 + 0.02j), rtol=1e-6)), found.trusted
    (True, 1.0)
    """
    asked = arguments_of(
        model,
        measurements,
        load=load,
        matrix=matrix,
        unknowns=unknowns,
        band_hz=band_hz,
        bounds=bounds,
        start=start,
        method=method,
        order=order,
        selection=selection,
        reduction=reduction,
        varies=varies,
        law=law,
        real=real,
        reject_outliers=reject_outliers,
        model_error=model_error,
        coarser_mesh=coarser_mesh,
        exclude_hz=exclude_hz,
        max_lines=max_lines,
        check=check,
        memory_bytes=memory_bytes,
    )
    return Identification._of(_frfit.identify(*asked, callable_(progress)))


def arguments_of(
    model: Model,
    measurements: Any,
    *,
    load: ArrayLike,
    matrix: Any = (),
    unknowns: Any = None,
    band_hz: Any = None,
    bounds: Any = None,
    start: Any = None,
    method: Any = None,
    order: Any = None,
    selection: Any = None,
    reduction: Any = None,
    varies: Any = None,
    law: Any = (),
    real: Any = False,
    reject_outliers: Any = None,
    model_error: Any = None,
    coarser_mesh: Any = None,
    exclude_hz: Any = (),
    max_lines: Any = None,
    check: Any = True,
    memory_bytes: Any = None,
) -> tuple[_frfit.Model, Complex, list[Any], dict[str, Any]]:
    """Model, load, measurements and options of ``identify``, checked, as the compiled part takes them."""
    compiled = model_of(model)
    expected = "a Measurement or several"
    one = isinstance(measurements, Measurement)
    measured = [measurements] if one else several(measurements, "measurements", expected)
    for measurement in measured:
        if not isinstance(measurement, Measurement):
            raise refuse("measurements", expected, shown(measurement))
    if start not in (None, "bounds"):
        raise refuse("start", '"bounds" or None', shown(start))
    of_one = {"matrix": matrix, "varies": varies, "law": law, "bounds": bounds, "real": flag(real, "real")}
    options = {
        "unknowns": [_plain_unknown(one) for one in _unknowns(unknowns, of_one)],
        "band_hz": optional_pair(band_hz, "band_hz"),
        "exclude_hz": [_band(entry) for entry in several(exclude_hz, "exclude_hz", "lines and bands")],
        "max_lines": None if max_lines is None else whole(max_lines, "max_lines"),
        "method": method if method is None else one_of(method, "method", _METHODS),
        "selection": selection if selection is None else one_of(selection, "selection", ("joint", "smallest")),
        "reduction": reduction if reduction is None else one_of(reduction, "reduction", ("auto", "full", "subspace")),
        "order": optional_whole(order, "order", 0),
        "start_at_bounds": start == "bounds",
        "model_error": _model_error(model_error),
        "coarser_mesh": _coarser_mesh(coarser_mesh),
        "reject_outliers": None if reject_outliers is None else flag(reject_outliers, "reject_outliers"),
        "check": flag(check, "check"),
        "memory_bytes": optional_whole(memory_bytes, "memory_bytes", 0),
    }
    force = load_vector(load, model.dim)
    plain = [_plain(one, f"measurement {k}") for k, one in enumerate(measured, 1)]
    return compiled, force, plain, options


@hints
def run_case(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    method: str | None = None,
    order: int | None = None,
    band_hz: tuple[float, float] | None = None,
    selection: str | None = None,
    reduction: str | None = None,
    reduced: str | os.PathLike[str] | None = None,
    keep_reduced: str | os.PathLike[str] | None = None,
    memory_bytes: int | None = None,
    progress: Progress | None = None,
) -> Identification:
    """What ``frfit identify CASE`` computes: the same numbers, bit for bit.

    With ``out`` the files of the command line are written there too, all of them or none. ``reduced`` is a file that :func:`train` wrote for
    the same matrices, load and sensors; ``keep_reduced`` is a file for the reduced model as this run leaves it. The other arguments stand in
    place of the case file's.

    Raises
    ------
    InputError, OutsideTableError, ModelMemoryError, WriteError
        The exception has the message that the command line prints.
    """
    found = _frfit.run_case(
        path,
        out,
        _optional_word(method, "method"),
        optional_whole(order, "order", 0),
        optional_pair(band_hz, "band_hz"),
        _optional_word(selection, "selection"),
        _optional_word(reduction, "reduction"),
        reduced,
        keep_reduced,
        optional_whole(memory_bytes, "memory_bytes", 0),
        callable_(progress),
    )
    return Identification._of(found, None if out is None else pathlib.Path(out))
