"""The same content as a case file and as arrays: the same numbers, and where it is refused, the same words."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from conftest import Chain, same_columns

import frfit

F = np.linspace(4.0, 110.0, 54)
LAW = frfit.Law.fractional(900.0, 20.0, 0.5)
NOMINAL = frfit.Law.complex_modulus(1100.0, 0.1)
SHARE = 0.01
SCALE, LATE_S = -0.37, 2e-3
BOUNDS = {"storage": (100.0, 1e4), "loss_factor": (0.0, 1.0)}
ROWS = (6, 11)


def receptance(chain):
    """Of the sensors, by SciPy's direct solver: (frequencies, sensors)."""
    factor = LAW.at(F)
    return np.array([chain.direct(e, f, 0)[list(ROWS)] for e, f in zip(factor, F, strict=True)])


def records(chain, scale=1.0, late_s=0.0):
    """What the channels record: the second has to be multiplied by ``scale`` and is late; noise of a known share."""
    exact = receptance(chain)
    exact[:, 1] *= np.exp(-2j * np.pi * F * late_s) / scale
    random = np.random.default_rng(7)
    std = SHARE * np.abs(exact)
    noise = random.normal(size=exact.shape) + 1j * random.normal(size=exact.shape)
    return exact + std * noise / np.sqrt(2), std


def case_file(chain, folder, values, std, channels, keys):
    """The case in a folder: `channels` has the keys of each measurement, `keys` those of `[identify]`."""
    for name in ("stiffness", "viscous", "mass"):
        matrix = sp.coo_array(getattr(chain, name))
        scipy.io.mmwrite(folder / f"{name}.mtx", matrix, symmetry="symmetric", precision=17)
    lines = []
    for name, role, factor in (
        ("springs", "stiffness", "{ storage = 1100.0, loss_factor = 0.1 }"),
        ("dashpots", "viscous", "1.0"),
        ("mass", "mass", "1.0"),
    ):
        file = "stiffness" if role == "stiffness" else role
        lines += ["[[matrix]]", f'name = "{name}"', f'role = "{role}"', f'file = "{file}.mtx"', f"factor = {factor}"]
    lines += ["[load]", "row = 1"]
    for k, row in enumerate(ROWS):
        columns = zip(F, values[:, k].real, values[:, k].imag, std[:, k], strict=True)
        text = [",".join(repr(float(number)) for number in cells) for cells in columns]
        (folder / f"{k}.csv").write_text("\n".join(["frequency_hz,re,im,std", *text]) + "\n")
        lines += ["[[measurement]]", f'file = "{k}.csv"', f"row = {row + 1}", 'quantity = "receptance"']
        lines += [f"{key} = {toml(value)}" for key, value in channels[k].items()]
    lines += ["[identify]", 'matrix = "springs"', f"band_hz = [{F[0]}, {F[-1]}]"]
    lines += ["bounds = { storage = [100.0, 1e4], loss_factor = [0.0, 1.0] }"]
    lines += [f"{key} = {toml(value)}" for key, value in keys.items()]
    path = folder / "case.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


def toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)


def measurements(values, std, channels):
    return [
        frfit.Measurement(F, values[:, k], row=row, std=std[:, k], **channels[k]) for k, row in enumerate(ROWS)
    ]


def identified(chain, values, std, channels, **keys):
    options = {"band_hz": (F[0], F[-1]), "bounds": BOUNDS, **keys}
    model = chain.model(NOMINAL)
    return frfit.identify(model, measurements(values, std, channels), load=0, matrix="springs", **options)


UNKNOWN = {"scale": "unknown", "delay_s": "unknown"}
WINDOW = {"decay_per_s": 0.5}
HANN = {"window": "hann", "record_s": 0.4}


@pytest.mark.parametrize(
    ("channels", "keys"),
    [
        (({}, {}), {"varies": "frequency"}),
        (({}, {}), {"varies": "smooth"}),
        (({}, {}), {"varies": "law", "law": "fractional"}),
        ((WINDOW, WINDOW), {"varies": "frequency"}),
        ((HANN, HANN), {"varies": "frequency"}),
        (({}, UNKNOWN), {}),
        ((UNKNOWN, UNKNOWN), {"varies": "law", "law": "fractional"}),
    ],
    ids=["free", "smooth", "law", "window", "Hann window", "unknown beside known", "all unknown with a law"],
)
def test_numbers_are_the_same_bit_by_bit(chain: Chain, tmp_path, channels, keys):
    wrong = (SCALE, LATE_S) if channels[1] is UNKNOWN else (1.0, 0.0)
    values, std = records(chain, *wrong)
    ours = identified(chain, values, std, channels, **keys)
    theirs = frfit.run_case(case_file(chain, tmp_path, values, std, channels, keys))
    assert len(ours) == len(F)
    same_columns(ours, theirs)
    for name in ("sensor_scale", "sensor_scale_std", "sensor_delay_s", "sensor_delay_s_std", "measured_response"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name), err_msg=name)
    assert (ours.smooth, ours.laws) == (theirs.smooth, theirs.laws)
    assert (ours.smooth is not None) == (keys.get("varies") == "smooth")
    assert (ours.laws is not None) == (keys.get("varies") == "law")


def test_unknown_scale_and_delay_are_found_with_their_deviations(chain: Chain):
    values, std = records(chain, SCALE, LATE_S)
    found = identified(chain, values, std, ({}, UNKNOWN))
    known = (found.sensor_scale[0], found.sensor_scale_std[0], found.sensor_delay_s[0], found.sensor_delay_s_std[0])
    assert np.isnan(known).all()
    # Within four deviations but for one in 16000, and these below the share of noise of one value alone.
    assert 0 < found.sensor_scale_std[1] < SHARE * abs(SCALE)
    assert abs(found.sensor_scale[1] - SCALE) < 4 * found.sensor_scale_std[1]
    assert 0 < found.sensor_delay_s_std[1] < SHARE / (2 * np.pi * F[0])
    assert abs(found.sensor_delay_s[1] - LATE_S) < 4 * found.sensor_delay_s_std[1]
    # What is given as measured is the receptance: the noise of 54 values is below 5 standard deviations, the channel's own beside it.
    exact = receptance(chain)
    np.testing.assert_array_less(np.abs(found.measured_response - exact), 6 * SHARE * np.abs(exact))


def test_a_smooth_factor_is_surer_than_a_free_one_and_right(chain: Chain):
    values, std = records(chain)
    free = identified(chain, values, std, ({}, {}))
    found = identified(chain, values, std, ({}, {}), varies="smooth")
    assert found.smooth is not None and found.smooth["converged"]
    # Smooth from 4 Hz to 110 Hz, a power law: fewer numbers than frequencies.
    assert found.smooth["parameters"] < len(F) / 2
    both = free.ok & found.ok
    assert both.sum() > len(F) / 2
    assert np.median(found.storage_std[both] / free.storage_std[both]) < 0.7
    # Errors are correlated over frequency: within three deviations each, but for a few.
    inside = np.abs(found.storage - LAW.at(F).real) <= 3 * found.storage_std
    assert inside[both].mean() > 0.9


@pytest.mark.parametrize(
    ("channels", "keys", "message"),
    [
        (({}, UNKNOWN), {"varies": "smooth"}, '"unknown" with varies "smooth"'),
        ((UNKNOWN, UNKNOWN), {}, '"unknown" for all sensors'),
        (({"delay_s": "unknown"}, {}), {"selection": "smallest"}, '"unknown" with selection "smallest"'),
        (({"delay_s": "unknown"}, {}), {"reduction": "full"}, '"unknown" with reduction "full"'),
        (({}, {}), {"varies": "smooth", "reduction": "full"}, '"smooth" with reduction "full"'),
        (({}, {}), {"varies": "law", "real": True}, '"law" with real = true'),
        (({}, {}), {"varies": "bumpy"}, '"bumpy"'),
    ],
)
def test_what_is_refused_is_refused_in_the_same_words(chain: Chain, tmp_path, channels, keys, message):
    values, std = records(chain)
    with pytest.raises(frfit.InputError) as ours:
        identified(chain, values, std, channels, **keys)
    with pytest.raises(frfit.InputError) as theirs:
        frfit.run_case(case_file(chain, tmp_path, values, std, channels, keys))
    assert (ours.value.expected, ours.value.found) == (theirs.value.expected, theirs.value.found)
    assert ours.value.found == message
    # Only the place differs: an argument, a line of a file.
    assert ours.value.file is None and theirs.value.file is not None


def test_law_beside_another_word_and_twice_the_same_are_refused(chain: Chain):
    values, std = records(chain)
    with pytest.raises(frfit.InputError, match='law: expected varies = "law" beside it, found varies = "smooth"'):
        identified(chain, values, std, ({}, {}), varies="smooth", law="constant")
    with pytest.raises(frfit.InputError, match='law: expected each law once, found "zener" a second time'):
        identified(chain, values, std, ({}, {}), law=["zener", "constant", "zener"])
