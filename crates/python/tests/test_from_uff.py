"""Measurements of a universal file: those that a case file gets, bit for bit, and refusals that say what there is."""

from __future__ import annotations

import re

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from conftest import Chain

import frfit

F = np.linspace(4.0, 110.0, 54)
TRUE = 1000 * (1 + 0.03j)
# Unit factors of millimetres and newtons: a value in SI units is that of the file over the factor.
MILLIMETRES = (
    "    -1\n   164\n"
    f"{9:10d}{'mm, N':20s}{2:10d}\n"
    f"{1000.0:25.17e}{1.0:25.17e}{1.0:25.17e}\n{273.15:25.17e}\n    -1\n"
).replace("e+", "D+")


def functions(chain: Chain, *, noise: str = "std", decay_per_s: float = 0.0, mm: bool = False) -> list[frfit.UffFunction]:
    """FRFs of masses 7 and 12, driven at mass 1, the second against its axis, in accelerance, with their noise."""
    exact = frfit.respond(chain.model(TRUE), F, load=0, sensors=[6, 11])
    random = np.random.default_rng(5)
    made = []
    for k, (node, direction) in enumerate([(7, 3), (12, -3)]):
        per_receptance = (2j * np.pi * F + decay_per_s) ** 2 * (1000.0 if mm else 1.0)
        h = exact[:, k] * (1 if direction > 0 else -1) * per_receptance
        std = 0.01 * np.abs(h)
        h = h + std * (random.normal(size=F.size) + 1j * random.normal(size=F.size)) / np.sqrt(2)
        at = {"response_dof": frfit.UffDof(node, direction), "reference_dof": frfit.UffDof(1, 3)}
        at |= {"abscissa_axis": frfit.UffAxis(18, "", "Hz"), "denominator_axis": frfit.UffAxis(13, "", "N")}
        said = (f"decay_per_s = {decay_per_s}",) if decay_per_s else ()
        unit = "mm/s^2" if mm else "m/s^2"
        made.append(frfit.UffFunction(F, h, ordinate_axis=frfit.UffAxis(12, "", unit), id=said, **at))
        if noise == "std":
            ordinate = frfit.UffAxis(0, "Standard deviation")
            made.append(frfit.UffFunction(F, std, function_type=0, ordinate_axis=ordinate, **at))
        elif noise == "coherence":
            made.append(frfit.UffFunction(F, np.linspace(0.9, 0.999, F.size), function_type=6, **at))
    return made


def case_file(chain: Chain, folder, keys: str) -> object:
    """A case of the file beside it."""
    for name in ("stiffness", "viscous", "mass"):
        scipy.io.mmwrite(
            folder / f"{name}.mtx", sp.coo_array(getattr(chain, name)), symmetry="symmetric", precision=17
        )
    (folder / "dofs.csv").write_text("row,node,direction\n" + "".join(f"{k},{k},Z\n" for k in range(1, chain.n + 1)))
    (folder / "case.toml").write_text(
        f"""
matrix = [
  {{ name = "springs", role = "stiffness", file = "stiffness.mtx", factor = 1200.0 }},
  {{ name = "dashpots", role = "viscous", file = "viscous.mtx" }},
  {{ name = "mass", role = "mass", file = "mass.mtx" }},
]
dofs = {{ file = "dofs.csv" }}
load = {{ dof = "1+Z" }}
[[measurement]]
file = "frf.uff"
dof = "7+Z"
{keys}
[[measurement]]
file = "frf.uff"
dof = "12-Z"
{keys}
[identify]
matrix = "springs"
band_hz = [4.0, 110.0]
check = false
"""
    )
    return folder / "case.toml"


@pytest.mark.parametrize(
    ("made", "keys", "options", "binary"),
    [
        ({}, "", {}, False),
        ({"noise": "coherence"}, "averages = 7", {"averages": 7}, False),
        ({"noise": "none"}, "scale = 0.5\ndelay_s = 1e-4", {"scale": 0.5, "delay_s": 1e-4}, True),
        ({"decay_per_s": 6.0}, "", {}, True),
        ({"mm": True}, "", {}, True),
        ({}, 'quantity = "mobility"', {"quantity": "mobility"}, True),
    ],
    ids=["std", "coherence", "scale", "window", "millimetres", "quantity"],
)
def test_values_are_those_that_a_case_file_gets_bit_for_bit(chain, tmp_path, made, keys, options, binary):
    path = tmp_path / "frf.uff"
    frfit.write_uff(path, functions(chain, **made), binary=binary)
    if made.get("mm"):
        path.write_bytes(MILLIMETRES.encode() + path.read_bytes())
    case = frfit.run_case(case_file(chain, tmp_path, keys))
    measured = frfit.Measurement.from_uff(path, {"7+Z": 6, "12-Z": 11}, **options)
    assert [(one.row, one.sign) for one in measured] == [(6, 1.0), (11, -1.0)]
    assert all((one.std is None) == (made.get("noise", "std") != "std") for one in measured)
    found = frfit.identify(chain.model(1200.0), measured, load=0, matrix="springs", band_hz=(4.0, 110.0), check=False)
    np.testing.assert_array_equal(found.measured_response, case.measured_response)
    np.testing.assert_array_equal(found.factor, case.factor)
    np.testing.assert_array_equal(found.storage_std, case.storage_std)
    np.testing.assert_array_equal(found.status, case.status)
    if not options and "decay_per_s" not in made:
        # The values themselves, in metres: the truth within the noise, of which a tenth is left by 54 lines.
        np.testing.assert_allclose(np.median(found.storage[found.ok]), TRUE.real, rtol=1e-3)


def test_records_are_chosen_by_response_and_reference(chain, tmp_path):
    path = tmp_path / "frf.uff"
    (first, second) = functions(chain, noise="none")
    other = frfit.UffFunction(
        F, 2 * np.asarray(first.values), first.response_dof, frfit.UffDof(5, 3), ordinate_axis=frfit.UffAxis(12)
    )
    frfit.write_uff(path, [first, second, other], binary=True)
    for force, expected in (("1+Z", first), (frfit.UffDof(5, 3), other)):
        (one,) = frfit.Measurement.from_uff(path, {"7+Z": 6}, driven_at=force)
        np.testing.assert_array_equal(one.response, expected.values)
    names = list(frfit.Measurement.from_uff(path, {"12-Z": 11, "7+Z": 6}, driven_at="1+z"))
    assert [one.row for one in names] == [11, 6]
    # The hammer has moved, and the accelerometer has not: by reciprocity the FRF is the same.
    (moved,) = frfit.Measurement.from_uff(path, {"1+Z": 0}, driven_at="12-Z")
    np.testing.assert_array_equal(moved.response, second.values)
    assert (moved.row, moved.sign) == (0, 1.0)


@pytest.mark.parametrize(
    ("dofs", "options", "message"),
    [
        ({"8+Z": 7}, {}, "one frequency response function of 8+Z, found none among 2 records: 7+Z/1+Z, 12-Z/1+Z"),
        ({"12+Z": 7}, {}, "one frequency response function of 12+Z, found none among 2 records: 7+Z/1+Z, 12-Z/1+Z"),
        ({"7+Z": 6}, {"driven_at": "1-Z"}, "of 7+Z over 1-Z, found none among 2 records"),
        ({"7Z": 6}, {}, "dofs: expected a node, a sign and a direction such as 12+Z or 7-RX, found '7Z'"),
        ({"7+Z": 6}, {"driven_at": "one"}, "driven_at: expected a node, a sign and a direction"),
        ({"7+Z": -1}, {}, "dofs['7+Z']: expected a row, a whole number from 0, found -1"),
        ({"7+Z": "6"}, {}, "dofs['7+Z']: expected a row, a whole number from 0, found '6'"),
        ({}, {}, "dofs: expected a dictionary of names and rows"),
        (["7+Z"], {}, "dofs: expected a dictionary of names and rows"),
        ({"7+Z": 6}, {"quantity": "accel"}, 'found "accel" ("accelerance" is nearest)'),
        ({"7+Z": 6}, {"decay_per_s": 3.0}, ", or None, found 3.0"),
        ({"7+Z": 6}, {"averages": 0}, "measurement.averages: expected a whole number of at least 1, found 0"),
    ],
)
def test_what_cannot_be_is_refused_with_what_there_is(chain, tmp_path, dofs, options, message):
    path = tmp_path / "frf.uff"
    frfit.write_uff(path, functions(chain, decay_per_s=6.0), binary=True)
    with pytest.raises(frfit.InputError, match=re.escape(message)):
        frfit.Measurement.from_uff(path, dofs, **options)


def test_files_that_say_too_little_or_something_else_are_refused(chain, tmp_path):
    path = tmp_path / "frf.uff"
    (plain, _) = functions(chain, noise="none")
    at = {"response_dof": plain.response_dof, "reference_dof": plain.reference_dof}

    def refused(message: str, *written: frfit.UffFunction, before: str = "") -> frfit.InputError:
        frfit.write_uff(path, list(written))
        path.write_text(before + path.read_text())
        with pytest.raises(frfit.InputError, match=re.escape(message)) as caught:
            frfit.Measurement.from_uff(path, {"7+Z": 6})
        return caught.value

    refused("because the file does not say", frfit.UffFunction(F, plain.values, **at))
    refused("expected complex values of an FRF, found real ones", frfit.UffFunction(F, F, **at))
    time = frfit.UffFunction(F, plain.values, abscissa_axis=frfit.UffAxis(17), **at)
    refused("expected an abscissa in Hz, found time", time)
    radians = frfit.UffFunction(F, plain.values, abscissa_axis=frfit.UffAxis(18, "", "rad/s"), **at)
    error = refused('expected an abscissa in Hz, found the unit "rad/s"', radians)
    assert (error.file, error.line, error.expected) == (str(path), 1, "an abscissa in Hz")
    refused("found none, and 1 function of other types", frfit.UffFunction(F, F, function_type=6, **at))
    refused("found several, and driven_at says not which among 2 records", plain, plain)
    wrong = frfit.UffFunction(F, F, function_type=6, **at)
    error = refused("expected coherences from 0 to 1, found 4", plain, wrong)
    assert error.found == "4"
    window = frfit.UffFunction(F, plain.values, id=("decay_per_s = six",), **at)
    refused("decay_per_s = a number of 1/s from 0 on in an ID line", window)
    # m/s^2 in the label and millimetres in the units: 1000 would pass for physics.
    refused('agree with the label "m/s^2", found unit factors 1000 of length', plain, before=MILLIMETRES)
    metres = MILLIMETRES.replace("1.00000000000000000D+03", "1.00000000000000000D+00")
    refused("the same units throughout the file", frfit.UffFunction(F, plain.values, **at), before=MILLIMETRES + metres)


def test_a_std_at_other_frequencies_or_twice_is_not_taken(chain, tmp_path):
    path = tmp_path / "frf.uff"
    plain, std, *_ = functions(chain)
    shifted = frfit.UffFunction(F + 1.0, std.values, std.response_dof, std.reference_dof, 0, ordinate_axis=std.ordinate_axis)
    for others, is_there in (([std], True), ([shifted], False), ([std, std], False), ([shifted, std], True)):
        frfit.write_uff(path, [plain, *others], binary=True)
        (one,) = frfit.Measurement.from_uff(path, {"7+Z": 6})
        assert (one.std is not None) == is_there


def test_names_of_degrees_of_freedom_read_back():
    for name in ("34+Z", "7-RX", "900000+RZ", "1-Y"):
        assert frfit.UffDof.of(name).name == name
    assert frfit.UffDof.of("3-rx") == frfit.UffDof(3, -4) and frfit.UffDof(5).name == "5"
    with pytest.raises(frfit.InputError, match="name: expected a node, a sign and a direction"):
        frfit.UffDof.of("12")
