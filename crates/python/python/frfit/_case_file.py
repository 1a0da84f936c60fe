"""Arrays as a case file, for everything that works on files: report, figures, batches, kept reduced models."""

from __future__ import annotations

import json
import os
import pathlib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from . import _frfit
from ._arrays import Complex, hints, refuse, row, shown, word
from ._identify import MEASUREMENT_KEYS, CoarserMesh, Measurement, Unknown, arguments_of
from ._model import Model

_Files: TypeAlias = dict[str, "str | sp.csc_array"]
"""The files of a case by their names in its folder: texts, and matrices."""


@hints
def save_case(
    folder: str | os.PathLike[str],
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
    title: str | None = None,
    units: str | None = None,
    dofs: Mapping[str, int] | None = None,
) -> pathlib.Path:
    """Writes arrays as a case file with its matrices and FRFs, and returns the path of the case file.

    What works on files then works on arrays too: ``run_case(path, out)`` and its report, :func:`batch`, :func:`train`,
    ``frfit`` on the command line. The arguments are those of :func:`identify`; the case gives the same numbers as that, but for the
    rounding of a complex factor, which a case file has as storage modulus and loss factor.

    Parameters
    ----------
    folder
        A new folder, or an empty one. It gets ``case.toml``, the matrices as ``.npz`` and the FRFs as ``.csv``.
    title
        Title of figures and report.
    units
        Units of the model, such as ``"mm-t-s"``: the key ``units`` of a case file. Without: SI.
    dofs
        Names of rows of the model, from 0: ``{"34+Z": 97}``. Files and messages then name the degrees of freedom.

    Raises
    ------
    InputError
        As :func:`identify`; a folder that is not empty; a factor without a real part.

    Examples
    --------
    >>> import numpy as np, tempfile
    >>> from frfit import Term, respond, run_case
    >>> K, M = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.diag([0.01, 0.01])
    >>> model = Model([Term("k", K, factor=1000.0), Term("m", M, role="mass")])
    >>> f = np.linspace(5.0, 120.0, 24)
    >>> u = 0.9 * respond(model, 0.9**0.5 * f, load=0, sensors=[1])[:, 0]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = save_case(folder, model, Measurement(f, u, row=1), load=0, matrix="k", dofs={"2+X": 1})
    ...     found = run_case(path)
    >>> bool(found.ok.any() and np.allclose(found.factor[found.ok], 1000.0 / 0.9))
    True
    """
    compiled, force, measured, options = arguments_of(
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
    )
    head: dict[str, Any] = {}
    for key, said in (("title", title), ("units", units)):
        if said is not None:
            head[key] = word(said, key)
    if options["model_error"] is not None:
        head["model_error"] = options["model_error"]
    home = pathlib.Path(folder)
    if home.exists() and any(home.iterdir()):
        raise refuse("folder", "a new or empty folder", f"files in {home}")
    files: _Files = {}
    if (mesh := options["coarser_mesh"]) is not None:
        # Sensors need names here: a row alone cannot say that motion against it counts as positive.
        of_rows = {row: f"{row + 1}+X" for row, _ in mesh["sensors"]}
        spots = [{"dof": _label(of_rows[row], sign)} for row, sign in mesh["sensors"]]
        coarser = _files(head={}, model=mesh["model"], load=mesh["load"], names=of_rows, measured=spots, identify=[])
        files |= {f"coarser/{name}": content for name, content in coarser.items()}
        head["coarser_mesh"] = {
            "file": f"coarser/{_CASE}",
            "element_ratio": mesh["element_ratio"],
            "order": mesh["order"],
        }
    names = {} if dofs is None else _names(dofs, compiled.dim)
    tables = []
    for k, one in enumerate(measured, 1):
        table, files[table["file"]] = _measurement(f"frf-{k}.csv", one, names)
        tables.append(table)
    files |= _files(
        head=head,
        model=compiled,
        load=force,
        names=names,
        measured=tables,
        identify=_identify(options, _common_band(measured)),
    )
    # The case file is the last one.
    for name, content in files.items():
        path = home / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, str):
            path.write_text(content, encoding="utf-8")
        else:
            sp.save_npz(path, content)
    return home / _CASE


_CASE = "case.toml"


def _names(dofs: Mapping[str, int], dim: int) -> dict[int, str]:
    """The name of each row that has one, along its axis."""
    expected = 'names and rows, such as {"34+Z": 97}'
    if not isinstance(dofs, Mapping) or not dofs:
        raise refuse("dofs", expected, shown(dofs))
    found: dict[int, str] = {}
    for name, place in dofs.items():
        parts = re.fullmatch(r"(\d+)[+-](R?[XYZ])", word(name, "dofs"))
        if parts is None:
            raise refuse("dofs", expected, shown(name))
        at = row(place, f"dofs[{name!r}]", dim)
        if at in found:
            raise refuse("dofs", "one name for each row", f"two of row {at}")
        found[at] = f"{int(parts[1])}+{parts[2]}"
    return found


def _measurement(file: str, one: Any, names: Mapping[int, str]) -> tuple[dict[str, Any], str]:
    """The table of a measurement, and its FRF."""
    sign = 1.0
    if one.row in names:
        spot: dict[str, Any] = {"dof": _label(names[one.row], one.sign)}
    else:
        # A row alone has no sign: the values have it.
        spot, sign = {"row": one.row + 1}, one.sign
    columns = [("frequency_hz", one.frequency_hz), ("re", sign * one.response.real), ("im", sign * one.response.imag)]
    columns += [(key, getattr(one, key)) for key in ("std", "coherence") if getattr(one, key) is not None]
    table: dict[str, Any] = {"file": file, **spot, "quantity": one.quantity}
    if one.averages is not None:
        table["averages"] = one.averages
    for key, default in MEASUREMENT_KEYS:
        if (value := getattr(one, key)) != default:
            table[key] = "unknown" if value is None else value
    return table, _csv(columns)


def _csv(columns: Sequence[tuple[str, Any]]) -> str:
    """A table with all digits."""
    rows = zip(*(column.tolist() for _, column in columns), strict=True)
    return "\n".join([",".join(name for name, _ in columns), *(",".join(map(repr, cells)) for cells in rows)]) + "\n"


def _files(
    *,
    head: Mapping[str, Any],
    model: _frfit.Model,
    load: Complex,
    names: Mapping[int, str],
    measured: Iterable[Mapping[str, Any]],
    identify: Iterable[Mapping[str, Any]],
) -> _Files:
    """The case file, after what it reads beside the FRFs."""
    files: _Files = {}
    text = [f"{key} = {_toml(value)}" for key, value in head.items()]
    _, (terms, indices, ends) = model.__reduce__()
    for k, (name, role, law, std, values) in enumerate(terms, 1):
        lower = sp.csc_array((values, indices, ends), shape=(model.dim, model.dim))
        whole = sp.csc_array(lower + sp.tril(lower, -1).T)
        whole.eliminate_zeros()
        file = f"matrix-{k}.npz"
        files[file] = whole
        keys = _law(law, f"factor-{k}.csv", f"matrix {name!r}.factor", files) + _std(*std)
        text += [*_table("[[matrix]]", {"name": name, "role": role, "file": file}), f"factor = {{ {', '.join(keys)} }}"]
    if names:
        lines = (f"{at + 1},{name.replace('+', ',')}" for at, name in sorted(names.items()))
        files["dofs.csv"] = "\n".join(["row,node,direction", *lines]) + "\n"
        text += _table("[dofs]", {"file": "dofs.csv"})
    text += _table("[load]", _load(load, names, files))
    for table in measured:
        text += _table("[[measurement]]", table)
    for table in identify:
        text += _table("[[identify]]", table)
    files[_CASE] = "\n".join(text) + "\n"
    return files


def _law(law: _frfit.Law, file: str, name: str, files: _Files) -> list[str]:
    """The keys of a law; those of a table have a file."""
    _, (kind, *parts) = law.__reduce__()
    if kind == "table":
        hz, values = parts
        files[file] = _csv([("frequency_hz", hz), ("storage", values.real), ("loss", values.imag)])
        return [f"table = {_toml(file)}"]
    if kind == "constant" and not parts[0].real and parts[0].imag:
        raise refuse(name, "a factor with a real part, as a case file has it", shown(parts[0]))
    return law._case_file_keys()


def _std(storage: float | None, loss_factor: float | None) -> list[str]:
    """The keys that say how well a factor is known."""
    keys = {"storage_std": None if storage is None else f"{100 * storage!r} %", "loss_factor_std": loss_factor}
    return [f"{key} = {_toml(value)}" for key, value in keys.items() if value is not None]


def _load(load: Complex, names: Mapping[int, str], files: _Files) -> dict[str, Any]:
    """A unit force by its row or its name, any other as a file."""
    (there,) = np.nonzero(load)
    if there.size == 1 and load[there[0]] in (1.0, -1.0):
        at, sign = int(there[0]), float(load[there[0]].real)
        if at in names:
            return {"dof": _label(names[at], sign)}
        if sign > 0:
            return {"row": at + 1}
    files["load.csv"] = _csv([("row", there + 1), ("re", load[there].real), ("im", load[there].imag)])
    return {"file": "load.csv"}


def _label(name: str, sign: float) -> str:
    """The name with the sign of the motion that counts as positive."""
    return name.replace("+", "-") if sign < 0 else name


def _common_band(measured: Iterable[Any]) -> tuple[float, float]:
    """The frequencies that all measurements can share."""
    frequencies = [one.frequency_hz for one in measured]
    return float(max(hz[0] for hz in frequencies)), float(min(hz[-1] for hz in frequencies))


def _identify(options: Mapping[str, Any], common_band: tuple[float, float]) -> list[dict[str, Any]]:
    """The tables of the unknowns; the first has what holds for all."""
    tables = []
    for one in options["unknowns"]:
        table: dict[str, Any] = {}
        if one["name"] is not None:
            table["name"] = one["name"]
        if one["matrices"]:
            table["matrix"] = one["matrices"]
        else:
            table |= {"powers": dict(one["powers"]), "nominal": one["nominal"]}
        if one["varies"] is not None:
            table["varies"] = one["varies"]
        if one["laws"]:
            table |= {"varies": "law", "law": one["laws"] if len(one["laws"]) > 1 else one["laws"][0]}
        if one["real"] and not one["powers"]:
            table["real"] = True
        if one["real"] and one["storage"] is not None:
            table["bounds"] = one["storage"]
        elif bounds := {key: one[key] for key in ("storage", "loss_factor") if one[key] is not None}:
            table["bounds"] = bounds
        tables.append(table)
    shared: dict[str, Any] = {"band_hz": options["band_hz"] or common_band}
    keys = ("max_lines", "method", "selection", "reduction", "order", "reject_outliers")
    shared |= {key: options[key] for key in keys if options[key] is not None}
    if options["exclude_hz"]:
        shared["exclude_hz"] = [low if low == high else (low, high) for low, high in options["exclude_hz"]]
    if options["start_at_bounds"]:
        shared["start"] = "bounds"
    if not options["check"]:
        shared["check"] = False
    return [{**tables[0], **shared}, *tables[1:]]


def _table(title: str, keys: Mapping[str, Any]) -> list[str]:
    return ["", title, *(f"{key} = {_toml(value)}" for key, value in keys.items())]


def _toml(value: Any) -> str:
    """A value as TOML has it; numbers with all their digits."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        # JSON escapes as TOML does, but for one character.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        inside = (f"{key if re.fullmatch(r'[A-Za-z0-9_-]+', key) else _toml(key)} = {_toml(one)}" for key, one in value.items())
        return f"{{ {', '.join(inside)} }}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_toml, value))}]"
    return repr(value)
