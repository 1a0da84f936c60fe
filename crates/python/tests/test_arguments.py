"""Arguments that are not as they have to be: an exception of the package that names them, never a crash."""

from __future__ import annotations

import os

import numpy as np
import pytest
import scipy.sparse as sp

import frfit

F = np.linspace(4.0, 110.0, 24)
DAYS = np.arange(24).astype("datetime64[D]")
SPANS = np.arange(24).astype("timedelta64[s]")
NO_NUMBERS = [
    (DAYS, "dates"),
    (SPANS, "durations"),
    (np.ones(24, dtype=bool), "booleans"),
    (["4", "5"], "text"),
    ("49", "text"),
    (b"49", "bytes"),
    ([None, 1.0], "Python objects"),
    (np.array([1, "a"], dtype=object), "Python objects"),
    ([[1.0], [2.0, 3.0]], r"\[\[1.0\]"),
    (np.ma.array(F, mask=F > 50), "masked values"),
    (np.ones((4, 6)), "an array of 4 x 6"),
]


def refused(key: str, found: str, call, *arguments, **options):
    """The call raises what names the argument and what was found."""
    with pytest.raises(frfit.InputError, match=found or None) as caught:
        call(*arguments, **options)
    assert caught.value.key == key and str(caught.value).startswith(f"{key}: expected ")
    assert caught.value.expected and isinstance(caught.value, ValueError)


@pytest.mark.parametrize(("values", "found"), NO_NUMBERS)
def test_what_is_no_number_is_refused_wherever_numbers_are_expected(chain, values, found):
    model = chain.model(1000.0)
    at = {"load": 0, "sensors": [1]}
    refused("frequency_hz", found, frfit.respond, model, values, **at)
    refused("measurement.frequency_hz", found, frfit.Measurement, values, F, row=1)
    refused("measurement.response", found, frfit.Measurement, F, values, row=1)
    refused("measurement.std", found, frfit.Measurement, F, F, row=1, std=values)
    refused("measurement.coherence", found, frfit.Measurement, F, F, row=1, coherence=values)
    refused("force", found, frfit.Recording, 1e-3, values, F)
    refused("frequency_hz", found, frfit.Law.table, values, F)
    refused("values", found, frfit.Law.table, F, values)
    refused("frequency_hz", found, frfit.Law.constant(1.0).at, values)
    refused("load", found, frfit.respond, model, F, load=values, sensors=[1])


@pytest.mark.parametrize(
    ("sensors", "found"),
    [
        ([1.5], "1.5"),
        ([1.0], "1.0"),
        ("49", "'49'"),
        (b"49", "b'49'"),
        (3, "3"),
        (None, "None"),
        ([True], "True"),
        ([np.True_], "True"),
        (["4"], "'4'"),
        ([None], "None"),
        ([-1], "-1"),
        ([12], "12"),
        ([2**70], str(2**70)),
        ([np.datetime64("2020-01-01")], "datetime64"),
        ([1 + 0j], "1"),
        ([[1]], r"\[1\]"),
        ([np.nan], "nan"),
        ([], "none"),
        (np.array([0.0, 1.0]), "0.0"),
        (np.array([True, False]), "True"),
    ],
)
def test_sensors_are_whole_numbers(chain, sensors, found):
    model = chain.model(1000.0)
    refused("sensors", found, frfit.respond, model, F, load=0, sensors=sensors)
    refused("sensors", found, frfit.series, model, 1.0, load=0, sensors=sensors, matrix="springs")


@pytest.mark.parametrize("kind", [np.int8, np.uint8, np.int32, np.uint32, np.int64, np.uint64])
def test_integers_of_numpy_are_whole_numbers(chain, kind):
    model = chain.model(1000.0)
    expected = frfit.respond(model, F, load=2, sensors=[1, 7])
    for sensors in ([kind(1), kind(7)], np.array([1, 7], dtype=kind), (np.array(1, dtype=kind), kind(7))):
        got = frfit.respond(model, F, load=kind(2), sensors=sensors, signs=np.array([1, 1], dtype=np.int8))
        np.testing.assert_array_equal(got, expected)
    one = frfit.Measurement(np.arange(1, 25).astype(kind), np.arange(1, 25).astype(kind), row=kind(1), averages=kind(3))
    frfit.identify(model, one, load=kind(0), matrix="springs", order=kind(5))
    np.testing.assert_array_equal(frfit.respond(model, F[:, None], load=2, sensors=[1, 7]), expected)


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("measurement.row", {"row": 1.5}, "1.5"),
        ("measurement.row", {"row": True}, "True"),
        ("measurement.row", {"row": "1"}, "'1'"),
        ("measurement.row", {"row": -1}, "-1"),
        ("measurement.sign", {"sign": 0.5}, "0.5"),
        ("measurement.sign", {"sign": "+"}, "'\\+'"),
        ("measurement.quantity", {"quantity": 3}, "3"),
        ("measurement.averages", {"averages": 2.0}, "2.0"),
        ("measurement.averages", {"averages": 0}, "0"),
        ("measurement.averages", {"averages": 1, "coherence": np.ones(24)}, "1"),
        ("measurement.quantity", {"quantity": "acceleranse"}, '"acceleranse" \\("accelerance" is nearest\\)'),
        ("measurement.scale", {"scale": "twice"}, "'twice'"),
        ("measurement.scale", {"scale": True}, "True"),
        ("measurement.scale", {"scale": [1.0, 2.0]}, r"\[1.0, 2.0\]"),
        ("measurement.delay_s", {"delay_s": np.timedelta64(1, "s")}, "timedelta64"),
    ],
)
def test_measurements_are_checked_as_they_are_made(key, options, found):
    refused(key, found, frfit.Measurement, F, F, **{"row": 1, **options})


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("order", {"order": 5.0}, "5.0"),
        ("order", {"order": True}, "True"),
        ("max_lines", {"max_lines": "20"}, "'20'"),
        ("memory_bytes", {"memory_bytes": -1}, "-1"),
        ("memory_bytes", {"memory_bytes": 2**80}, str(2**80)),
        ("band_hz", {"band_hz": 20.0}, "20.0"),
        ("band_hz", {"band_hz": (1.0, 2.0, 3.0)}, "3.0"),
        ("band_hz", {"band_hz": ("1", "2")}, "text"),
        ("bounds.storage", {"bounds": {"storage": 3.0}}, "3.0"),
        ("bounds", {"bounds": {"stiffness": (1.0, 2.0)}}, '"stiffness"'),
        ("bounds", {"bounds": {"storge": (1.0, 2.0)}}, '"storge" \\("storage" is nearest\\)'),
        ("bounds.storage", {"bounds": {"storage": (3.0, 2.0)}}, "3, 2"),
        ("bounds.loss_factor", {"bounds": {"loss_factor": (0.0, np.nan)}}, "0, nan"),
        ("bounds", {"bounds": [1.0, 2.0]}, r"\[1.0, 2.0\]"),
        ("exclude_hz", {"exclude_hz": 50.0}, "50.0"),
        ("exclude_hz", {"exclude_hz": ["50"]}, "text"),
        ("exclude_hz", {"exclude_hz": [(49.0, 50.0, 51.0)]}, "51.0"),
        ("start", {"start": "guess"}, "'guess'"),
        ("method", {"method": 3}, "3"),
        ("varies", {"varies": 1}, "1"),
        ("model_error", {"model_error": "non"}, 'non'),
        ("model_error", {"model_error": {"frequencies": 0.01}}, '"frequencies" \\("frequency" is nearest\\)'),
        ("model_error", {"model_error": "estimate"}, '"estimate" \\("estimated" is nearest\\)'),
        ("model_error", {"model_error": "0.5 kg"}, "0.5 kg"),
        ("model_error", {"model_error": 0.6}, "0.6"),
        ("model_error", {"model_error": "70 %"}, "70 %"),
        ("model_error.shape", {"model_error": {"shape": "two %"}}, "two %"),
        ("model_error.calibration", {"model_error": {"calibration": 0.0}}, "0.0"),
        ("varies", {"varies": "smoth"}, '"smoth" \\("smooth" is nearest\\)'),
        ("method", {"method": "serie"}, '"serie" \\("series" is nearest\\)'),
        ("selection", {"selection": "joined"}, '"joined" \\("joint" is nearest\\)'),
        ("reduction", {"reduction": "sub-space"}, '"sub-space" \\("subspace" is nearest\\)'),
        ("model_error", {"model_error": {}}, "{}"),
        ("model_error", {"model_error": [0.01, 0.02]}, "0.02"),
        ("law", {"law": 3}, "3"),
        ("law", {"law": [3]}, "3"),
        ("matrix", {"matrix": 0}, "0"),
        ("matrix", {"matrix": [None]}, "None"),
        ("real", {"real": "yes"}, "'yes'"),
        ("reject_outliers", {"reject_outliers": 1}, "1"),
        ("check", {"check": None}, "None"),
        ("progress", {"progress": 3}, "3"),
        ("load", {"load": True}, "booleans"),
        ("load", {"load": 12}, "12"),
        ("load", {"load": -1}, "-1"),
        ("load", {"load": "0"}, "text"),
    ],
)
def test_options_are_checked_before_anything_is_computed(chain, key, options, found):
    one = frfit.Measurement(F, F, row=1)
    refused(key, found, frfit.identify, chain.model(1000.0), one, **{"load": 0, "matrix": "springs", **options})


def test_other_things_than_models_measurements_and_terms_are_refused(chain):
    model, one = chain.model(1000.0), frfit.Measurement(F, F, row=1)
    refused("model", "<class", frfit.identify, frfit.Model, one, load=0, matrix="springs")
    refused("model", "None", frfit.respond, None, F, load=0, sensors=[1])
    refused("measurements", "None", frfit.identify, model, None, load=0, matrix="springs")
    refused("measurements", "array", frfit.identify, model, [F], load=0, matrix="springs")
    refused("measurements", "none", frfit.identify, model, [], load=0, matrix="springs")
    refused("terms", "'springs'", frfit.Model, ["springs"])
    refused("terms", "Term", frfit.Model, frfit.Term("k", np.eye(2)))
    refused("signs", "0.5", frfit.respond, model, F, load=0, sensors=[1], signs=[0.5])
    refused("signs", "2", frfit.respond, model, F, load=0, sensors=[1], signs=[1, 1])
    refused("order", "2.5", frfit.series, model, 1.0, load=0, sensors=[1], matrix="springs", order=2.5)
    refused("frequency_hz", "NaN", frfit.series, model, np.nan, load=0, sensors=[1], matrix="springs")
    refused("k", "31", frfit.series(model, 1.0, load=0, sensors=[1], matrix="springs").derivative, 31)
    refused("step_s", "0", frfit.Recording, 0.0, F, F)
    refused("responses", "an array of 1 x 23", frfit.Recording, 1e-3, F, F[1:])
    refused("force", "nan", frfit.Recording, 1e-3, F * np.nan, F)
    refused("keep", "0", frfit.frf, frfit.Recording(1e-3, F, F), keep=[0])
    refused("drift", "text", frfit.frf, frfit.Recording(1e-3, F, F), drift="much")
    function = frfit.UffFunction(F, F, response_dof=frfit.UffDof("3"))
    refused("response_dof.node", "'3'", frfit.write_uff, "/nowhere/f.uff", function)
    refused("values", "dates", frfit.write_uff, "/nowhere/f.uff", frfit.UffFunction(F, DAYS))


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("name", {"name": 3}, "3"),
        ("name", {"name": " "}, '""'),
        ("matrix 'k'.role", {"role": "stifness"}, '"stifness" \\("stiffness" is nearest\\)'),
        ("matrix 'k'.role", {"role": 3}, "3"),
        ("matrix 'k'.factor", {"factor": "1+2j"}, "text"),
        ("matrix 'k'.factor", {"factor": True}, "booleans"),
        ("matrix 'k'.factor", {"factor": np.nan}, "nan"),
        ("matrix 'k'.factor", {"factor": [1.0, 2.0]}, "2.0"),
        ("matrix 'k'.storage_std", {"storage_std": 0.0}, "0.0"),
        ("matrix 'k'.storage_std", {"storage_std": "2"}, "2"),
        ("matrix 'k'.storage_std", {"storage_std": "2 % of it"}, "2 % of it"),
        ("matrix 'k'.loss_factor_std", {"loss_factor_std": "2 %"}, "2 %"),
    ],
)
def test_terms_are_checked_as_they_are_made(key, options, found):
    refused(key, found, frfit.Term, **{"name": "k", "matrix": np.eye(2), **options})


@pytest.mark.parametrize(
    ("matrix", "match"),
    [
        (np.ones((2, 3)), "a square matrix, found 2 x 3"),
        (sp.csc_array(np.ones((2, 3))), "a square matrix, found 2 x 3"),
        (np.zeros((0, 0)), "a square matrix, found 0 x 0"),
        (np.array([[1.0, np.nan], [np.nan, 1.0]]), "finite values, found nan"),
        (sp.csr_array(np.array([[1.0, np.inf], [np.inf, 1.0]])), "finite values, found inf"),
        (np.ones((2, 2, 2)), "rows and columns, found 3 dimensions"),
        (np.eye(2, dtype=bool), "real or complex numbers, found an array of bool"),
        ("K.mtx", "real or complex numbers"),
        (None, "real or complex numbers"),
        ([[1.0], [1.0, 2.0]], "an array of numbers"),
    ],
)
def test_matrices_are_looked_at_as_terms_are_made(matrix, match):
    with pytest.raises(frfit.MatrixError, match=f"matrix 'k': expected {match}"):
        frfit.Term("k", matrix)


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("varies", {"varies": "constnt"}, '"constnt" \\("constant" is nearest\\)'),
        ("matrix", {"matrix": ()}, "none"),
        ("matrix", {"powers": {"k": 1}, "name": "x", "nominal": 1.0}, "both"),
        ("powers.m", {"matrix": (), "powers": {"m": 13}, "name": "x", "nominal": 1.0}, "13"),
        ("nominal", {"matrix": (), "powers": {"m": 1}, "name": "x"}, "none"),
        ("nominal", {"matrix": (), "powers": {"m": 1}, "name": "x", "nominal": 0.0}, "0.0"),
        ("nominal", {"nominal": 1.0}, "1.0"),
        ("name", {"matrix": (), "powers": {"m": 1}, "nominal": 1.0}, "none"),
        ("name", {"name": 3}, "3"),
        ("bounds", {"bounds": {"los_factor": (0.0, 1.0)}}, '"los_factor" \\("loss_factor" is nearest\\)'),
        ("bounds.storage", {"bounds": {"storage": (2.0, 1.0)}}, "2, 1"),
        ("bounds", {"real": True, "bounds": (2.0, np.inf)}, "2, inf"),
        ("real", {"real": "yes"}, "'yes'"),
        ("law", {"varies": "smooth", "law": "constant"}, 'varies = "smooth"'),
        ("law", {"law": ["zener", "zener"]}, '"zener" a second time'),
    ],
)
def test_unknowns_are_checked_as_they_are_made(key, options, found):
    refused(key, found, frfit.Unknown, **{"matrix": "k", **options})


def test_laws_of_unknowns_are_known_ones():
    for law, found in [("zenner", '"zenner" \\("zener" is nearest\\)'), ("maxwell:21", "maxwell:21"), ("maxwell:0", "well:0")]:
        with pytest.raises(frfit.OptionsError, match=f'law: expected "constant", .* found .*{found}'):
            frfit.Unknown(matrix="k", law=law)
    assert frfit.Unknown(matrix="k", law=["maxwell:20", "maxwell"]).law == ["maxwell:20", "maxwell"]


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("model", {"model": None}, "None"),
        ("load", {"load": 12}, "12"),
        ("load", {"load": np.ones(11)}, "11"),
        ("load", {"load": np.zeros(12)}, "zeros only"),
        ("load", {"load": np.full(12, np.nan)}, "nan"),
        ("sensors", {"sensors": [12]}, "12"),
        ("sensors", {"sensors": []}, "none"),
        ("signs", {"signs": [1, 1]}, "2"),
        ("signs", {"signs": [2]}, "2"),
        ("coarser_mesh.element_ratio", {"element_ratio": 1.0}, "1.0"),
        ("coarser_mesh.element_ratio", {"element_ratio": 17.0}, "17.0"),
        ("coarser_mesh.order", {"order": np.nan}, "nan"),
        ("coarser_mesh.order", {"order": "2"}, "'2'"),
    ],
)
def test_coarser_meshes_are_checked_as_they_are_made(chain, key, options, found):
    refused(key, found, frfit.CoarserMesh, **{"model": chain.model(1000.0), "load": 0, "sensors": [1], **options})


@pytest.mark.parametrize(
    ("key", "options", "found"),
    [
        ("attached.row", {"row": -1}, "-1"),
        ("attached.row", {"row": 1.5}, "1.5"),
        ("attached.row", {"row": [1, 1]}, r"\[1, 1\]"),
        ("attached.row", {"row": []}, r"\[\]"),
        ("attached", {"mass": None}, "none"),
        ("attached.mass", {"mass": 0.0}, "0.0"),
        ("attached.mass", {"mass": "5 g"}, "'5 g'"),
        ("attached.stiffness", {"stiffness": np.nan}, "nan"),
        ("attached.stiffness", {"row": [1, 2], "stiffness": 3.0}, "3.0"),
    ],
)
def test_what_is_attached_is_checked_as_it_is_made(chain, key, options, found):
    refused(key, found, frfit.Attached, **{"row": 1, "mass": 0.1, **options})


def test_what_is_attached_is_on_the_model(chain):
    terms = [frfit.Term("k", chain.stiffness), frfit.Term("m", chain.mass, role="mass")]
    refused("attached.row", "12", frfit.Model, terms, attached=[frfit.Attached(12, mass=1.0)])
    refused("attached", "3", frfit.Model, terms, attached=[3])
    refused("attached", "'m'", frfit.Model, terms, attached="m")
    with pytest.raises(frfit.ModelError, match="at least one matrix"):
        frfit.Model([])


@pytest.mark.parametrize(
    ("call", "options", "said"),
    [
        (frfit.Measurement, {"quantitty": "mobility"}, r"Measurement\(\) has no argument 'quantitty'; 'quantity' is nearest"),
        (frfit.Measurement, {"colour": 3}, r"no argument 'colour'; there are frequency_hz, response, row, quantity"),
        (frfit.Unknown, {"bound": {}}, r"Unknown\(\) has no argument 'bound'; 'bounds' is nearest"),
        (frfit.Term, {"storage_sdt": 1.0}, r"Term\(\) has no argument 'storage_sdt'; 'storage_std' is nearest"),
        (frfit.CoarserMesh, {"elements_ratio": 1.0}, "no argument 'elements_ratio'; 'element_ratio' is nearest"),
        (frfit.identify, {"band": (1.0, 2.0)}, r"identify\(\) has no argument 'band'; 'band_hz' is nearest"),
        (frfit.respond, {"sensor": [1]}, "no argument 'sensor'; 'sensors' is nearest"),
        (frfit.run_case, {"methods": "series"}, "no argument 'methods'; 'method' is nearest"),
        (frfit.frf, {"drfit": 0.1}, "no argument 'drfit'; 'drift' is nearest"),
        (frfit.Model, {"attach": []}, r"Model\(\) has no argument 'attach'; 'attached' is nearest"),
    ],
)
def test_an_argument_of_an_unknown_name_is_refused_with_the_nearest(call, options, said):
    with pytest.raises(TypeError, match=said):
        call(**options)


@pytest.mark.parametrize(
    ("key", "law"),
    [
        ("value", lambda: frfit.Law.constant(complex(np.nan, 1.0))),
        ("storage", lambda: frfit.Law.complex_modulus(np.inf)),
        ("storage * loss_factor", lambda: frfit.Law.complex_modulus(1e300, 1e300)),
        ("e1", lambda: frfit.Law.fractional(1.0, np.nan, 0.5)),
        ("alpha", lambda: frfit.Law.fractional(1.0, 1.0, 1.5)),
        ("alpha", lambda: frfit.Law.zener(1.0, 2.0, 1.0, np.nan)),
        ("tau_s", lambda: frfit.Law.zener(1.0, 2.0, 0.0, 0.5)),
        ("branches", lambda: frfit.Law.maxwell(1.0, [(1.0, -1.0)])),
        ("tau_s", lambda: frfit.Law.named("zener", 1.0, 2.0, 0.0, 0.5)),
        ("law", lambda: frfit.Law.named("fractal", 1.0)),
        ("parameters", lambda: frfit.Law.named("zener", 1.0)),
    ],
)
def test_laws_are_checked_as_they_are_made(key, law):
    refused(key, "", law)
    with pytest.raises(TypeError, match="e0"):
        frfit.Law.fractional("a", 1.0, 0.5)


def broken(make, **arrays):
    """A matrix whose arrays were changed after it was made, which SciPy does not look at again."""
    matrix = make(np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]]))
    for name, values in arrays.items():
        setattr(matrix, name, np.asarray(values))
    return matrix


BROKEN = {
    "indices beyond": {"indices": [0, 1, 0, 1, 99, 1, 2]},
    "indices far beyond": {"indices": [0, 1, 0, 1, 2**30, 1, 2]},
    "indices negative": {"indices": [0, 1, 0, -1, 2, 1, 2]},
    "indices of floats": {"indices": [0.0, 1, 0, 1, 2, 1, 2]},
    "indices of texts": {"indices": list("0101212")},
    "indices too few": {"indices": [0, 1, 0]},
    "indices a table": {"indices": np.zeros((7, 2), dtype=int)},
    "indptr beyond": {"indptr": [0, 2, 5, 99]},
    "indptr far beyond": {"indptr": [0, 2, 5, 2**31 - 1]},
    "indptr negative": {"indptr": [0, -2, 5, 7]},
    "indptr descending": {"indptr": [0, 5, 2, 7]},
    "indptr not from 0": {"indptr": [1, 2, 5, 7]},
    "indptr too short": {"indptr": [0, 2, 7]},
    "indptr too long": {"indptr": [0, 2, 5, 7, 7]},
    "indptr empty": {"indptr": np.zeros(0, dtype=int)},
    "data too few": {"data": [1.0, 2.0]},
    "data of objects": {"data": np.array([None] * 7)},
    "data of texts": {"data": list("abcdefg")},
    "data of dates": {"data": np.zeros(7, dtype="datetime64[s]")},
    "data of booleans": {"data": np.ones(7, dtype=bool)},
    "data not finite": {"data": [1.0, 2.0, np.nan, 1.0, 1.0, 1.0, 1.0]},
    "data infinite": {"data": [np.inf] * 7},
}


@pytest.mark.parametrize("make", [sp.csr_array, sp.csc_array, sp.csr_matrix, sp.csc_matrix])
@pytest.mark.parametrize("arrays", BROKEN.values(), ids=BROKEN)
def test_compressed_matrices_whose_arrays_contradict_each_other_are_refused(make, arrays):
    with pytest.raises(frfit.MatrixError, match="matrix 'k': expected|matrix \"k\": expected"):
        frfit.Model([frfit.Term("k", broken(make, **arrays))])


def test_other_forms_of_matrices_are_checked_too():
    def fails(matrix, match):
        with pytest.raises(frfit.MatrixError, match=match):
            frfit.Model([frfit.Term("k", matrix)])

    fails(broken(sp.coo_array, row=[0, 9, 0, 1, 2, 1, 2]), "rows from 0 to 2, found 9")
    fails(broken(sp.coo_array, col=[0, -3, 0, 1, 2, 1, 2]), "columns from 0 to 2, found -3")
    fails(broken(sp.coo_array, data=[1.0]), "as many rows as columns as values")
    fails(broken(sp.dia_array, offsets=[0, 0, 1]), "different offsets")
    fails(broken(sp.dia_array, offsets=[0]), "different offsets")
    blocks = broken(lambda array: sp.bsr_array(array, blocksize=(1, 1)), indices=[0, 1, 0, 1, 99, 1, 2])
    fails(blocks, "indices from 0 to 2, found 99")
    lists = sp.lil_array(np.eye(3))
    lists.rows[1] = [77]
    fails(lists, "indices from 0 to 2, found 77")
    fails(sp.csc_array(np.ones((2, 3))), "square")
    fails(np.ones((2, 2, 2)), "rows and columns")
    fails(np.array([["a", "b"], ["c", "d"]]), "numbers, found an array of <U1")
    fails(np.array([[None, None], [None, None]]), "object")
    fails([[1.0], [1.0, 2.0]], "an array of numbers")
    fails("K.mtx", "numbers")
    fails(None, "object")
    fails(np.eye(2, dtype=bool), "bool")


def test_what_a_matrix_remembers_of_itself_is_not_believed():
    twice = sp.csc_array(([1.0, 1.0], [0, 0], [0, 2]), shape=(1, 1))
    twice.has_canonical_format = True
    model = frfit.Model([frfit.Term("k", twice)])
    np.testing.assert_array_equal(frfit.respond(model, [0.0], load=0, sensors=[0]), [[0.5]])
    assert twice.nnz == 2


def test_no_random_matrix_brings_the_package_down():
    """Arrays of any contents: a model, or an exception of the package. Seeded, so that what fails was broken by the change."""
    random = np.random.default_rng(11)
    wild = [-(2**31), -1, 0, 1, 2, 3, 4, 5, 7, 2**31 - 1]

    def whole(count):
        calm = random.integers(0, 5, size=count)
        return np.where(random.random(count) < 0.1, random.choice(wild, size=count), calm).astype(
            random.choice([np.int32, np.int64])
        )

    counts = {"made": 0, "refused": 0}
    rounds = 3000 if "FRFIT_LONG" in os.environ else 1000
    for _ in range(rounds):
        n = int(random.integers(1, 5))
        symmetric = random.integers(-2, 3, size=(n, n)).astype(float)
        symmetric += symmetric.T
        make = [sp.csr_array, sp.csc_array, sp.coo_array, sp.bsr_array, sp.dia_array][random.integers(5)]
        matrix = make(symmetric)
        names = {"coo": ["row", "col"], "dia": ["offsets"]}.get(matrix.format, ["indices", "indptr"])
        for name in names:
            if random.random() < 0.3:
                old = getattr(matrix, name).size
                count = old if random.random() < 0.7 else int(random.integers(0, 9))
                values = np.sort(whole(count)) if random.random() < 0.5 else whole(count)
                setattr(matrix, name, values)
        if random.random() < 0.1:
            matrix.data = matrix.data[..., :-1] if random.random() < 0.5 else matrix.data * np.nan
        try:
            frfit.Model([frfit.Term("k", matrix)])
            counts["made"] += 1
        except frfit.FrfitError:
            counts["refused"] += 1
    # Both happen often: else nothing was tried.
    assert min(counts.values()) > rounds / 6, counts
