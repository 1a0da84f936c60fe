"""The compiled part; what its names mean is documented in the modules that use them."""

import os
from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Law",
    "Model",
    "Series",
    "UffFile",
    "__version__",
    "batch",
    "batch_status",
    "batch_table",
    "check",
    "check_of_arrays",
    "check_measurement",
    "convert",
    "example",
    "examples",
    "export",
    "fit",
    "frf",
    "frf_of_files",
    "identify",
    "inspect",
    "modes",
    "modes_of_arrays",
    "modes_of_model",
    "natural_frequencies",
    "powers_of",
    "read_matrix",
    "readable",
    "report",
    "respond",
    "respond_case",
    "restored_model",
    "restored_series",
    "run_case",
    "sensitivities",
    "sensitivities_of_model",
    "series",
    "train",
    "write_uff",
]

__version__: str

_Path = str | os.PathLike[str]
_Real = NDArray[np.float64]
_Complex = NDArray[np.complex128]
_Std = tuple[float | None, float | None]
_Progress = Callable[[int, int], object] | None

@final
class Law:
    @staticmethod
    def constant(value: complex) -> Law: ...
    @staticmethod
    def complex_modulus(storage: float, loss_factor: float = 0.0) -> Law: ...
    @staticmethod
    def fractional(e0: float, e1: float, alpha: float) -> Law: ...
    @staticmethod
    def zener(e0: float, e_infinity: float, tau_s: float, alpha: float) -> Law: ...
    @staticmethod
    def maxwell(e0: float, branches: Sequence[tuple[float, float]]) -> Law: ...
    @staticmethod
    def named(law: str, *parameters: float) -> Law: ...
    @staticmethod
    def table(frequency_hz: ArrayLike, values: ArrayLike) -> Law: ...
    def at(self, frequency_hz: ArrayLike) -> _Complex: ...
    def _case_file_keys(self) -> list[str]: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __copy__(self) -> Law: ...
    def __deepcopy__(self, _memo: Any, /) -> Law: ...

@final
class Model:
    def __new__(cls, terms: Sequence[tuple[str, str, Law, _Std, Any, Any, Any, Any]]) -> Model: ...
    @property
    def dim(self) -> int: ...
    @property
    def names(self) -> list[str]: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __copy__(self) -> Model: ...
    def __deepcopy__(self, _memo: Any, /) -> Model: ...

@final
class Series:
    @property
    def order(self) -> int: ...
    @property
    def scale(self) -> float: ...
    @property
    def nominal(self) -> complex: ...
    @property
    def coefficients(self) -> _Complex: ...
    def respond(self, correction: complex, order: int | None = None) -> _Complex: ...
    def derivative(self, k: int) -> _Complex: ...
    def spectral_radius(self, correction: complex) -> float: ...
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __copy__(self) -> Series: ...
    def __deepcopy__(self, _memo: Any, /) -> Series: ...

@final
class UffFile:
    def __new__(cls, path: _Path, bytes: NDArray[np.uint8]) -> UffFile: ...
    def __len__(self) -> int: ...
    def summaries(self) -> list[dict[str, Any]]: ...
    def function(self, index: int) -> dict[str, Any]: ...
    def frfs(self, records: Sequence[int]) -> list[dict[str, Any]]: ...

def check_measurement(name: str, measurement: Any) -> None: ...
def restored_model(terms: Sequence[tuple[str, str, Law, _Std, Any]], indices: Any, indptr: Any) -> Model: ...
def restored_series(
    scale: float, nominal: complex, coefficients: _Complex, radius: tuple[float, float, bool]
) -> Series: ...
def readable(path: _Path) -> None: ...
def powers_of(
    matrices: list[tuple[float, str, tuple[int, int], Any, Any, Any]], powers: list[int] | None
) -> list[tuple[int, tuple[Any, Any, Any]]]: ...
def read_matrix(path: _Path, name: str | None) -> dict[str, Any]: ...
def identify(
    model: Model,
    load: _Complex,
    measurements: Sequence[Any],
    options: dict[str, Any],
    progress: _Progress,
) -> dict[str, Any]: ...
def run_case(
    path: _Path,
    out: _Path | None,
    method: str | None,
    order: int | None,
    band_hz: tuple[float, float] | None,
    selection: str | None,
    reduction: str | None,
    reduced: _Path | None,
    keep_reduced: _Path | None,
    memory_bytes: int | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def train(
    path: _Path,
    out: _Path,
    band_hz: tuple[float, float] | None,
    reduced: _Path | None,
    memory_bytes: int | None,
) -> dict[str, Any]: ...
def batch(
    plan: _Path,
    out: _Path,
    reduced: _Path | None,
    shard: tuple[int, int],
    jobs: int | None,
    retry_failed: bool,
    memory_bytes: int | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def batch_status(plan: _Path, out: _Path, reduced: _Path | None) -> tuple[int, int, int]: ...
def batch_table(store: _Path, lines: bool) -> str: ...
def modes(
    path: _Path,
    out: _Path | None,
    band_hz: tuple[float, float] | None,
    identified: _Path | None,
    reduced: _Path | None,
    max_order: int | None,
    memory_bytes: int | None,
) -> dict[str, Any]: ...
def report(folder: _Path) -> str: ...
def respond(
    model: Model,
    load: _Complex,
    rows: Sequence[int],
    signs: Sequence[float],
    frequency_hz: _Real,
    progress: _Progress,
) -> _Complex: ...
def series(
    model: Model,
    load: _Complex,
    rows: Sequence[int],
    signs: Sequence[float],
    frequency_hz: float,
    matrices: Sequence[str],
    order: int,
) -> Series: ...
def frf(recordings: Sequence[Any], how: dict[str, Any]) -> dict[str, Any]: ...
def write_uff(path: _Path, functions: Sequence[dict[str, Any]], binary: bool) -> None: ...
def check(
    path: _Path, band_hz: tuple[float, float] | None, reduced: _Path | None, memory_bytes: int | None
) -> dict[str, Any]: ...
def sensitivities(
    path: _Path,
    out: _Path | None,
    band_hz: tuple[float, float] | None,
    noise: float | None,
    candidates: str,
    reduced: _Path | None,
    memory_bytes: int | None,
) -> str: ...
def fit(
    table: _Path, laws: Sequence[str], only: tuple[str, str] | None, out: _Path | None
) -> tuple[str, list[tuple[Law, list[str]]]]: ...
def export(target: str, table: _Path, out: _Path | None, how: dict[str, Any]) -> str: ...
def inspect(path: _Path) -> str: ...
def natural_frequencies(k: _Path, m: _Path, count: int) -> str: ...
def convert(source: _Path, target: _Path, how: dict[str, Any]) -> None: ...
def examples() -> list[tuple[str, str]]: ...
def example(name: str, folder: _Path) -> list[str]: ...
def respond_case(
    path: _Path,
    out: _Path | None,
    band_hz: tuple[float, float] | None,
    memory_bytes: int | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def frf_of_files(
    records: Sequence[_Path], out: _Path, channels: dict[str, Any], how: dict[str, Any]
) -> str: ...
def check_of_arrays(
    model: Model, load: _Complex, measurements: Sequence[Any], options: dict[str, Any]
) -> dict[str, Any]: ...
def modes_of_arrays(
    model: Model, load: _Complex, measurements: Sequence[Any], options: dict[str, Any], max_order: int | None
) -> dict[str, Any]: ...
def modes_of_model(
    model: Model,
    load: _Complex,
    rows: Sequence[int],
    signs: Sequence[float],
    band_hz: tuple[float, float],
    memory_bytes: int | None,
) -> dict[str, Any]: ...
def sensitivities_of_model(
    model: Model,
    load: _Complex,
    rows: Sequence[int],
    signs: Sequence[float],
    frequency_hz: _Real,
    noise: float | None,
    candidates: str,
    memory_bytes: int | None,
) -> str: ...
