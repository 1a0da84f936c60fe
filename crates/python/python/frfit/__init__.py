"""frfit updates a finite element model until its frequency response functions (FRFs) match a test.

Matrices are SciPy's, everything else is NumPy's. Units are SI unless a name says otherwise, the time convention is
exp(+i omega t), rows are counted from 0. What does not exist is NaN, and ``status`` says why.

>>> import numpy as np, scipy.sparse as sp, frfit
>>> K = sp.csc_array(np.array([[2.0, -1.0], [-1.0, 2.0]]))      # per N/m of the unknown factor
>>> M = sp.eye_array(2, format="csc") * 0.01                    # kg
>>> model = frfit.Model([frfit.Term("springs", K, factor=1000 * (1 + 0.02j)),
...                      frfit.Term("mass", M, role="mass")])
>>> f = np.linspace(5.0, 120.0, 24)                             # Hz
>>> frfit.respond(model, f, load=0, sensors=[0, 1]).shape       # m/N, (frequencies, sensors)
(24, 2)
"""

from ._batch import Batch, BatchStatus, Trained, batch, batch_status, collect, train
from ._case_file import save_case
from ._errors import (
    FrfitError,
    InputError,
    InternalError,
    MatrixError,
    ModelError,
    ModelMemoryError,
    OptionsError,
    OutsideTableError,
    SignalError,
    SolveError,
    TableError,
    WriteError,
)
from ._frfit import Law, Series, __version__
from ._identify import CoarserMesh, Measurement, Unknown, identify, run_case
from ._matrix import powers_of, read_matrix
from ._model import Attached, Model, Term, respond, series
from ._modes import Modes, modes
from ._report import Report
from ._result import Direction, Estimate, Finding, Identification, Number, OtherExplanation
from ._signal import Impact, MeasuredFrf, Recording, frf
from ._uff import Uff, UffAxis, UffDof, UffFunction, UffSummary, read_uff, write_uff
from ._verbs import (
    CaseResponse,
    Check,
    LawFit,
    LawFits,
    Sensitivities,
    check,
    convert,
    demo,
    example,
    examples,
    export,
    fit,
    frf_of_files,
    inspect,
    natural_frequencies,
    respond_case,
    sensitivities,
)

__all__ = [
    "Attached",
    "Batch",
    "BatchStatus",
    "CaseResponse",
    "Check",
    "CoarserMesh",
    "Direction",
    "Estimate",
    "Finding",
    "FrfitError",
    "Identification",
    "Impact",
    "InputError",
    "InternalError",
    "Law",
    "LawFit",
    "LawFits",
    "MatrixError",
    "MeasuredFrf",
    "Measurement",
    "Model",
    "ModelError",
    "ModelMemoryError",
    "Modes",
    "Number",
    "OptionsError",
    "OtherExplanation",
    "OutsideTableError",
    "Recording",
    "Report",
    "Sensitivities",
    "Series",
    "SignalError",
    "SolveError",
    "TableError",
    "Term",
    "Trained",
    "Uff",
    "UffAxis",
    "UffDof",
    "UffFunction",
    "UffSummary",
    "Unknown",
    "WriteError",
    "__version__",
    "batch",
    "batch_status",
    "check",
    "collect",
    "convert",
    "demo",
    "example",
    "examples",
    "export",
    "fit",
    "frf",
    "frf_of_files",
    "identify",
    "inspect",
    "modes",
    "natural_frequencies",
    "powers_of",
    "read_matrix",
    "read_uff",
    "respond",
    "respond_case",
    "run_case",
    "save_case",
    "sensitivities",
    "series",
    "train",
    "write_uff",
]
