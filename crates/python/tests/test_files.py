"""Matrices and universal files, against SciPy and pyuff."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

import frfit


@pytest.mark.parametrize("symmetry", ["general", "symmetric", "skew-symmetric", "hermitian"])
def test_matrix_market_files_read_as_scipy_reads_them(tmp_path, symmetry):
    random = np.random.default_rng(3)
    a = random.normal(size=(9, 9)) + (1j * random.normal(size=(9, 9)) if symmetry == "hermitian" else 0)
    a[random.random(a.shape) < 0.5] = 0
    a = {"general": a, "symmetric": a + a.T, "skew-symmetric": a - a.T, "hermitian": a + a.conj().T}[symmetry]
    path = tmp_path / "a.mtx"
    scipy.io.mmwrite(path, sp.coo_array(a), symmetry=symmetry, precision=17)
    got = frfit.read_matrix(path)
    assert isinstance(got, sp.csc_array)
    np.testing.assert_array_equal(got.toarray(), a)
    np.testing.assert_array_equal(got.toarray(), scipy.io.mmread(path).toarray())


def test_harwell_boeing_files_read_as_scipy_reads_them(tmp_path):
    a = sp.csc_array(np.array([[4.0, 0, 1.5], [0, -3.25, 0], [1e-300, 0, 7e200]]))
    path = tmp_path / "a.rua"
    scipy.io.hb_write(path, sp.csc_matrix(a))
    np.testing.assert_array_equal(frfit.read_matrix(path).toarray(), scipy.io.hb_read(path).toarray())


def test_a_name_chooses_among_the_matrices_of_a_file(tmp_path):
    k = sp.csc_array(np.array([[2.0, -1.0], [-1.0, 2.0]]))
    m = sp.csc_array(np.diag([0.5, 0.25]))
    path = tmp_path / "model.mat"
    scipy.io.savemat(path, {"K": sp.csc_matrix(k), "M": sp.csc_matrix(m)})
    np.testing.assert_array_equal(frfit.read_matrix(path, name="K").toarray(), k.toarray())
    np.testing.assert_array_equal(frfit.read_matrix(path, "M").toarray(), m.toarray())
    with pytest.raises(frfit.InputError, match=r"expected one matrix, .* found K \(2 x 2\), M \(2 x 2\)"):
        frfit.read_matrix(path)
    with pytest.raises(frfit.InputError, match='expected one matrix named "C"'):
        frfit.read_matrix(path, "C")


def test_scipys_own_files_need_no_name(tmp_path):
    a = sp.csr_array(np.array([[1.5, 0.0, 2.0], [0.0, -3.0, 0.0]]))
    sp.save_npz(tmp_path / "a.npz", a)
    np.testing.assert_array_equal(frfit.read_matrix(tmp_path / "a.npz").toarray(), a.toarray())


def test_broken_files_are_refused_with_the_place(tmp_path):
    path = tmp_path / "bad.mtx"
    path.write_text("%%MatrixMarket matrix coordinate real general\n2 2 1\n1 x 3\n")
    with pytest.raises(frfit.InputError) as caught:
        frfit.read_matrix(path)
    assert (caught.value.line, caught.value.file) == (3, str(path))
    for read in (frfit.read_matrix, frfit.read_uff):
        with pytest.raises(frfit.InputError, match="expected a file, found none"):
            read(tmp_path / "nothing")
    empty = tmp_path / "empty.uff"
    empty.write_bytes(b"")
    with pytest.raises(frfit.InputError, match="expected a universal file"):
        frfit.read_uff(empty)


def functions():
    random = np.random.default_rng(5)
    f = np.linspace(10.0, 50.0, 41)
    values = random.normal(size=41) + 1j * random.normal(size=41)
    at = {"response_dof": frfit.UffDof(34, 3), "reference_dof": frfit.UffDof(12, -1)}
    return [
        frfit.UffFunction(f, values, even=(10.0, 1.0), id=("even",), **at),
        frfit.UffFunction(f**1.5, values.real, function_type=6, id=("uneven", "run 2")),
        frfit.UffFunction(
            f, values, ordinate_axis=frfit.UffAxis(12, "acc", "m/s^2"), denominator_axis=frfit.UffAxis(13, "", "N")
        ),
    ]


@pytest.mark.parametrize("binary", [False, True])
def test_functions_come_back_as_they_were_written(tmp_path, binary):
    path = tmp_path / "f.uff"
    frfit.write_uff(path, functions(), binary=binary)
    file = frfit.read_uff(path)
    assert len(file) == 3 and [d.binary for d in file.datasets] == [binary] * 3
    assert (file.datasets[0].response_dof, file.datasets[0].reference_dof) == ("34+Z", "12-X")
    for got, sent in zip(file.functions(), functions(), strict=True):
        # Text: 13 digits of an ordinate, 6 of a stored abscissa; binary doubles are exact.
        values, abscissa = (0.0, 0.0) if binary else (1e-12, 1e-5)
        np.testing.assert_allclose(got.values, sent.values, rtol=values)
        np.testing.assert_allclose(got.abscissa, sent.abscissa, rtol=abscissa)
        assert (got.response_dof, got.even, got.ordinate_axis) == (sent.response_dof, sent.even, sent.ordinate_axis)
        assert got.id[: len(sent.id)] == sent.id and got.function_type == sent.function_type
        assert np.asarray(got.values).flags.writeable
    with pytest.raises(frfit.InputError, match="index below 3"):
        file.function(3)


@pytest.mark.parametrize("binary", [False, True])
def test_pyuff_reads_the_same_values(tmp_path, binary):
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "f.uff"
    frfit.write_uff(path, functions(), binary=binary)
    theirs = pyuff.UFF(str(path))
    for index, ours in enumerate(frfit.read_uff(path).functions()):
        other = theirs.read_sets(index)
        np.testing.assert_allclose(other["data"], ours.values, rtol=1e-14)
        np.testing.assert_allclose(other["x"], ours.abscissa, rtol=1e-6)
        assert (other["rsp_node"], other["rsp_dir"]) == (ours.response_dof.node, ours.response_dof.direction)


def test_hammer_records_give_the_frf_of_the_oscillator():
    rate, seconds, averages = 2048, 4.0, 3
    t = np.arange(int(rate * seconds)) / rate
    f0, zeta, m = 40.0, 0.02, 2.0
    w0 = 2 * np.pi * f0
    wd = w0 * np.sqrt(1 - zeta**2)
    h = np.exp(-zeta * w0 * t) * np.sin(wd * t) / (m * wd)
    records = []
    for amplitude in np.linspace(80, 120, averages):
        force = np.where((t > 0.05) & (t < 0.054), amplitude * np.sin(np.pi * (t - 0.05) / 0.004), 0.0)
        records.append(frfit.Recording(1 / rate, force, np.convolve(force, h)[: len(t)] / rate))
    found = frfit.frf(records)
    assert found.averages == averages and all(impact.kept for impact in found.impacts)
    band = (found.frequency_hz > 10) & (found.frequency_hz < 100)
    w = 2 * np.pi * found.frequency_hz[band]
    exact = 1 / (m * (w0**2 - w**2 + 2j * zeta * w0 * w))
    # The sum for the integral: (w0 dt)^2/12 at the resonance, and dt/2 in phase off it.
    np.testing.assert_allclose(found.response[0, band], exact, rtol=2e-2)
    assert found.coherence is not None and found.coherence.shape == found.response.shape
    with pytest.raises(frfit.SignalError, match="without fault"):
        frfit.frf(frfit.Recording(1 / rate, np.zeros(512), np.zeros(512)))
