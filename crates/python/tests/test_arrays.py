"""Models, responses, series and identification from arrays, against SciPy."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

import frfit

TRUE = 1000 * (1 + 0.03j)
F = np.linspace(4.0, 110.0, 54)


def test_response_is_that_of_scipys_direct_solver(chain):
    got = frfit.respond(chain.model(TRUE), F, load=2, sensors=[0, 7, 11], signs=[1, -1, 1])
    expected = np.array([chain.direct(TRUE, f, 2)[[0, 7, 11]] * [1, -1, 1] for f in F])
    # Both are backward stable; condition numbers here are below 1e4.
    np.testing.assert_allclose(got, expected, rtol=1e-10)


@pytest.mark.parametrize("form", ["csr", "csc", "coo", "lil", "dense", "int64", "duplicates", "fortran"])
def test_every_form_of_a_matrix_is_the_same_matrix(chain, form):
    k = chain.stiffness
    if form == "dense":
        k = k.toarray()
    elif form == "fortran":
        k = np.asfortranarray(k.toarray())
    elif form == "int64":
        k = sp.csc_array((k.data, k.indices.astype(np.int64), k.indptr.astype(np.int64)), shape=k.shape)
    elif form == "duplicates":
        coo = k.tocoo()
        halves = np.concatenate([coo.data / 2, coo.data / 2])
        twice = [np.concatenate([part, part]) for part in coo.coords]
        k = sp.coo_array((halves, tuple(twice)), shape=k.shape)
    else:
        k = k.asformat(form)
    model = frfit.Model([frfit.Term("k", k, factor=TRUE), frfit.Term("m", chain.mass, role="mass")])
    plain = frfit.Model(
        [frfit.Term("k", chain.stiffness, factor=TRUE), frfit.Term("m", chain.mass, role="mass")]
    )
    at = {"load": 0, "sensors": [5]}
    np.testing.assert_array_equal(frfit.respond(model, F, **at), frfit.respond(plain, F, **at))


def test_callers_arrays_are_left_alone(chain):
    before = chain.stiffness.data.copy(), chain.stiffness.indices.copy()
    chain.stiffness.data.setflags(write=False)
    frfit.respond(chain.model(TRUE), F[:3], load=0, sensors=[0])
    np.testing.assert_array_equal(chain.stiffness.data, before[0])
    np.testing.assert_array_equal(chain.stiffness.indices, before[1])


def test_a_finding_stands_beside_the_best_other_explanation(chain):
    measured = np.array([chain.direct(TRUE, f, 2)[[0, 7]] for f in F])
    found = {}
    for sign in (1, -1):
        channels = [frfit.Measurement(F, sign * one, row) for one, row in zip(measured.T, [0, 7], strict=True)]
        options = {"load": 2, "matrix": "springs", "bounds": {"storage": (500, 2000), "loss_factor": (0, 0.2)}}
        found[sign] = frfit.identify(chain.model(1200 * (1 + 0.05j)), channels, **options)
    assert "sign" not in [finding.kind for finding in found[1].findings]
    assert found[1].other_explanations == ()
    assert "sign" in [finding.kind for finding in found[-1].findings]
    # Rows and measurements by their indices.
    assert found[-1].sensors == ("row 0", "row 7")
    assert found[-1].findings[0].sensors in ((), ("row 0",), ("row 7",), ("row 0", "row 7"))
    other = found[-1].other_explanations[0]
    # Half a turn is nearly what some delay does over the band.
    assert "late" in other.faults[0] and other.misfit > 0.1 and other.nats_behind > 100


def test_laws_are_what_their_formulas_say():
    w = 2j * np.pi * F
    np.testing.assert_allclose(frfit.Law.fractional(8.14e5, 7.31e4, 0.528).at(F), 8.14e5 + 7.31e4 * w**0.528)
    z = (w * 1e-3) ** 0.6
    assert frfit.Law.named("zener", 1e5, 1e7, 1e-3, 0.6) == frfit.Law.zener(1e5, 1e7, 1e-3, 0.6)
    np.testing.assert_allclose(frfit.Law.zener(1e5, 1e7, 1e-3, 0.6).at(F), (1e5 + 1e7 * z) / (1 + z))
    np.testing.assert_allclose(
        frfit.Law.maxwell(1e5, [(2e5, 1e-2)]).at(F), 1e5 + 2e5 * w * 1e-2 / (1 + w * 1e-2)
    )
    table = frfit.Law.table(np.array([10.0, 1000.0]), np.array([1 + 0j, 3 + 2j]))
    np.testing.assert_allclose(table.at(np.array([100.0])), [2 + 1j])
    with pytest.raises(frfit.OutsideTableError, match="covers 10 Hz to 1000 Hz, and 9 Hz was asked for"):
        table.at(np.array([9.0]))


def test_series_is_the_taylor_series_of_scipys_response(chain):
    f, step = 20.0, 0.5
    s = frfit.series(chain.model(TRUE), f, load=0, sensors=[3, 9], matrix="springs", order=20)
    assert s.order == 20 and s.nominal == TRUE and s.coefficients.shape == (2, 21)
    np.testing.assert_allclose(s.coefficients[:, 0], chain.direct(TRUE, f, 0)[[3, 9]], rtol=1e-10)
    c = 0.02 * TRUE
    assert s.spectral_radius(c) < 0.5
    # The terms that are cut off: rho^21 / (1 - rho), below 1e-6.
    np.testing.assert_allclose(s.respond(c), chain.direct(TRUE + c, f, 0)[[3, 9]], rtol=1e-5)
    z = c / s.scale
    np.testing.assert_allclose(s.respond(c), s.coefficients @ z ** np.arange(21), rtol=1e-10)
    central = (chain.direct(TRUE + step, f, 0) - chain.direct(TRUE - step, f, 0))[[3, 9]] / (2 * step)
    # The third derivative over the first, (step/|distance to a pole|)^2: about 1e-4 here.
    np.testing.assert_allclose(s.derivative(1), central, rtol=1e-3)


def measured(chain, rows, load=0):
    x = np.array([chain.direct(TRUE, f, load) for f in F])
    return [frfit.Measurement(F, x[:, row], row=row) for row in rows]


@pytest.mark.parametrize("rows", [[6], [6, 11]])
def test_the_factor_behind_scipys_response_is_found(chain, rows):
    found = frfit.identify(chain.model(1.4 * TRUE.real), measured(chain, rows), load=0, matrix="springs")
    assert len(found) == len(F) and found.measured_response.shape == (len(F), len(rows))
    assert found.trusted > 0.9
    # What the reduced model may cost (`certain`, 1e-5) is far above what exact data leave.
    np.testing.assert_allclose(found.factor[found.ok], TRUE, rtol=1e-6)
    np.testing.assert_allclose(found.loss_factor[found.ok], 0.03, rtol=1e-5)
    # The factor is the rounded sum.
    np.testing.assert_allclose(found.correction, found.factor - found.nominal, rtol=1e-14)


def test_quantities_signs_scales_and_vectors_are_only_other_words(chain):
    model = chain.model(1.4 * TRUE.real)
    plain = measured(chain, [6, 11])
    expected = frfit.identify(model, plain, load=0, matrix="springs")
    force = np.zeros(chain.n)
    force[0] = 1.0
    omega = 2 * np.pi * F
    other = [
        frfit.Measurement(F, -(omega**2) * plain[0].response / 9.81, row=6, quantity="accelerance", scale=9.81),
        frfit.Measurement(F, -1j * omega * plain[1].response, row=11, quantity="mobility", sign=-1),
    ]
    got = frfit.identify(model, other, load=force, matrix=["springs"])
    np.testing.assert_allclose(got.factor[got.ok], expected.factor[got.ok], rtol=1e-6)


def test_error_bars_hold_the_truth_and_the_band_is_cut(chain):
    random = np.random.default_rng(1)
    clean = measured(chain, [6, 11])
    noisy = []
    for one in clean:
        std = 0.01 * np.abs(one.response)
        noise = random.normal(size=(2, len(F))) * std / np.sqrt(2)
        noisy.append(frfit.Measurement(F, one.response + noise[0] + 1j * noise[1], row=one.row, std=std))
    band = (20.0, 80.0)
    found = frfit.identify(
        chain.model(1200.0), noisy, load=0, matrix="springs", band_hz=band, exclude_hz=[(49.0, 51.0)]
    )
    assert found.frequency_hz[0] >= 20.0 and found.frequency_hz[-1] <= 80.0
    out = found.status == "out_of_band"
    np.testing.assert_array_equal(out, (found.frequency_hz >= 49) & (found.frequency_hz <= 51))
    assert np.isnan(found.factor[out]).all() and found.noise_source == "given"
    inside = np.abs(found.storage - TRUE.real) <= 3 * found.storage_std
    # Three deviations leave out 0.3 %; a few of the band are allowed for, as few as a wrong bar would not leave.
    assert inside[found.ok].mean() > 0.9 and found.ok.sum() > 5
    few = frfit.identify(chain.model(1200.0), noisy, load=0, matrix="springs", band_hz=band, max_lines=12)
    assert (few.status != "out_of_band").sum() in (11, 12)


def test_a_law_is_fitted_to_the_band(chain):
    law = frfit.Law.fractional(900.0, 20.0, 0.5)
    x = np.array([chain.direct(law.at(np.array([f]))[0], f, 0)[6] for f in F])
    found = frfit.identify(
        chain.model(1100 * (1 + 0.1j)),
        frfit.Measurement(F, x, row=6),
        load=0,
        matrix="springs",
        law="fractional",
        bounds={"storage": (100.0, 1e4), "loss_factor": (0.0, 1.0)},
    )
    assert found.laws is not None
    # One sensor cannot say that the model is right: errors of some 1e-5 are found with the law.
    np.testing.assert_allclose(found.factor, law.at(F), rtol=1e-4)


def test_dataframe_has_the_columns_of_the_table(chain):
    pandas = pytest.importorskip("pandas")
    found = frfit.identify(chain.model(1200.0), measured(chain, [6]), load=0, matrix="springs")
    frame = found.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and list(frame) == list(found.columns())
    np.testing.assert_array_equal(frame["storage"], found.storage)


def test_plot_draws_what_was_found(chain):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = frfit.identify(chain.model(1200.0), measured(chain, [6]), load=0, matrix="springs")
    axes = found.plot()
    assert len(axes) == 2 and axes[0].get_ylabel() == "storage (unit of the factor)"
    drawn = np.concatenate([line.get_ydata() for line in axes[0].lines])
    assert np.isin(found.storage[found.ok], drawn).all()


def test_what_is_wrong_is_said(chain):
    model = chain.model(1000.0)
    (one,) = measured(chain, [6])

    def fails(error, match, measurement=one, **options):
        with pytest.raises(error, match=match) as caught:
            frfit.identify(model, measurement, **{"load": 0, "matrix": "springs", **options})
        assert isinstance(caught.value, frfit.FrfitError)
        return caught.value

    fails(frfit.ModelError, 'no matrix is named "spring"; there are springs, dashpots, mass', matrix="spring")
    fails(frfit.OptionsError, "order: expected 1 to 200, found 0", order=0)
    error = fails(frfit.InputError, 'method: expected "series"', method="magic")
    assert (error.key, error.found, error.file) == ("method", '"magic"', None)
    fails(frfit.InputError, r"band_hz: expected a band with frequencies", band_hz=(500.0, 600.0))
    fails(frfit.InputError, "exclude_hz: expected a frequency", exclude_hz=[(0.0, 1e4)])
    fails(frfit.InputError, "max_lines: expected a whole number of at least 3, found 2", max_lines=2)
    fails(frfit.InputError, "load: expected 12 values", load=np.ones(3))
    fails(frfit.InputError, "load: expected a load that is not zero", load=np.zeros(12))
    fails(frfit.InputError, r"measurements\[0\].row: expected 0 to 11, found 12", frfit.Measurement(F, F, row=12))
    # What no model could be held against is refused before there is one.
    for match, response, keys in (
        ("strictly ascending", F, {"frequency_hz": F[::-1]}),
        ("one value of response for each of 54", F[1:], {}),
        ("finite responses", F * np.nan, {}),
        ("measurement.scale: expected a finite number that is not zero, found 0", F, {"scale": 0.0}),
        ("measurement.delay_s: expected a finite number", F, {"delay_s": np.inf}),
        ("measurement.decay_per_s: expected a finite number of 1/s that is not negative", F, {"decay_per_s": -6.0}),
        ('measurement.window: expected "hann" or "none", found "hamming"', F, {"window": "hamming"}),
        ("measurement.record_s: expected a number of seconds above 0, found 0", F, {"record_s": 0.0}),
        ("coherences from 0 to 1", F, {"coherence": F}),
    ):
        with pytest.raises(frfit.InputError, match=match):
            frfit.Measurement(**{"frequency_hz": F, "response": response, "row": 1, **keys})
    fails(frfit.ModelMemoryError, "of memory", memory_bytes=10)
    with pytest.raises(frfit.MatrixError, match=r'matrix "k": expected a symmetric matrix .* \(2, 1\)'):
        frfit.Model([frfit.Term("k", np.array([[1.0, 2.0], [0.0, 1.0]]))])
    with pytest.raises(frfit.MatrixError, match="square"):
        frfit.Model([frfit.Term("k", np.ones((2, 3)))])
    with pytest.raises(frfit.MatrixError, match="finite"):
        frfit.Model([frfit.Term("k", np.array([[np.inf]]))])
    with pytest.raises(frfit.ModelError, match="at least one matrix"):
        frfit.Model([])
    # A system that cannot be solved is no exception in a band, and one where it is all that was asked for.
    free = frfit.Model([frfit.Term("k", np.array([[1.0, -1.0], [-1.0, 1.0]]))])
    assert np.isnan(frfit.respond(free, [0.0], load=0, sensors=[0])).all()
    with pytest.raises(frfit.SolveError, match="at 0 Hz"):
        frfit.series(free, 0.0, load=0, sensors=[0], matrix="k")
