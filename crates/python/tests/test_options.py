"""Every option of a case file from arrays: the same numbers, bit for bit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from conftest import Chain, same_columns
from test_case_and_arrays import BOUNDS, NOMINAL, ROWS, F, case_file, measurements, records

import frfit

FACTORS = {
    "springs": '"springs"\nrole = "stiffness"\nfile = "stiffness.mtx"\nfactor = { storage = 1100.0, loss_factor = 0.1',
    "dashpots": '"dashpots"\nrole = "viscous"\nfile = "viscous.mtx"\nfactor = 1.0',
}


def with_factors(text: str, dashpots: str) -> str:
    """The case with another factor of the dashpots."""
    assert text.count(FACTORS["dashpots"]) == 1
    return text.replace(FACTORS["dashpots"], FACTORS["dashpots"].removesuffix("1.0") + dashpots)


def model(chain: Chain, dashpots: float = 1.0, attached: object = (), **known: object) -> frfit.Model:
    return frfit.Model(
        [
            frfit.Term("springs", chain.stiffness, factor=NOMINAL),
            frfit.Term("dashpots", chain.viscous, role="viscous", factor=dashpots, **known),
            frfit.Term("mass", chain.mass, role="mass"),
        ],
        attached=attached,
    )


ATTACHED = """
[[attached]]
row = 12
mass_kg = 0.0037
[[attached]]
row = 3
stiffness = 57.3
damping = 0.0023
"""


def plain(text: str) -> str:
    return text


# What is written in the case, the model, and the options of `identify`.
OPTIONS: dict[str, tuple[dict[str, object], Callable[[str], str], dict[str, object], dict[str, object]]] = {
    "model error": ({}, lambda text: 'model_error = "0.7 %"\n' + text, {}, {"model_error": "0.7 %"}),
    "model error, a number": ({}, lambda text: "model_error = 0.003\n" + text, {}, {"model_error": 0.003}),
    "model error, none": ({}, lambda text: 'model_error = "none"\n' + text, {}, {"model_error": "none"}),
    "model errors": (
        {},
        lambda text: 'model_error = { shape = "1.7 %", calibration = 0.011 }\n' + text,
        {},
        {"model_error": {"shape": "1.7 %", "calibration": 0.011}},
    ),
    "storage_std": (
        {},
        lambda text: with_factors(text, "{ storage = 1.3, storage_std = 0.07 }"),
        {"dashpots": 1.3, "storage_std": 0.07},
        {"model_error": "estimated"},
    ),
    "storage_std, a share": (
        {},
        lambda text: with_factors(text, '{ storage = 1.3, storage_std = "7 %" }'),
        {"dashpots": 1.3, "storage_std": "7 %"},
        {},
    ),
    "attached": (
        {},
        lambda text: text + ATTACHED,
        {"attached": [frfit.Attached(11, mass=0.0037), frfit.Attached(2, stiffness=57.3, damping=0.0023)]},
        {},
    ),
    "exclude_hz": ({"exclude_hz": [20.0, [40.0, 51.0]]}, plain, {}, {"exclude_hz": [20.0, (40.0, 51.0)]}),
    "max_lines": ({"max_lines": 20}, plain, {}, {"max_lines": 20}),
    "reject_outliers": ({"reject_outliers": False}, plain, {}, {"reject_outliers": False}),
    "start": ({"start": "bounds"}, plain, {}, {"start": "bounds"}),
    "method, order": (
        {"method": "series", "order": 12, "selection": "smallest", "reduction": "full"},
        plain,
        {},
        {"method": "series", "order": 12, "selection": "smallest", "reduction": "full"},
    ),
    "constant": ({"varies": "constant"}, plain, {}, {"varies": "constant"}),
    "maxwell": ({"varies": "law", "law": "maxwell", "branches": 1}, plain, {}, {"law": "maxwell:1"}),
}


@pytest.mark.parametrize(("keys", "written", "of_model", "options"), OPTIONS.values(), ids=OPTIONS)
def test_options_are_those_of_a_case_bit_for_bit(chain: Chain, tmp_path, keys, written, of_model, options):
    values, std = records(chain)
    # Looking for faults of the data first takes most of the time, and is tested elsewhere.
    path = case_file(chain, tmp_path, values, std, ({}, {}), {"check": False, **keys})
    path.write_text(written(path.read_text()))
    theirs = frfit.run_case(path)
    asked = {"band_hz": (F[0], F[-1]), "bounds": BOUNDS, "matrix": "springs", "check": False, **options}
    ours = frfit.identify(model(chain, **of_model), measurements(values, std, ({}, {})), load=0, **asked)
    same_columns(ours, theirs)
    numbers = [[(one.name, one.value, one.std) for one in found.unknowns[0].numbers] for found in (ours, theirs)]
    assert numbers[0] == numbers[1]
    assert (ours.laws, ours.explained, ours.noise) == (theirs.laws, theirs.explained, theirs.noise)


def test_every_share_has_the_bits_of_a_case(chain: Chain, tmp_path):
    """Per cent and numbers of standard deviations, in the order of the reader's operations: 7/100 is not 0.01·7."""
    for std, factor in (("7 %", 1.3), ("14 %", 3.0), (0.07, 1.3), (0.29, 7.0), ("0.29 %", 0.49)):
        term = frfit.Term("k", np.eye(2), factor=complex(factor, 0.3), storage_std=std, loss_factor_std=std)
        storage, loss_factor = frfit.Model([term])._model.__reduce__()[1][0][0][3]
        share = 0.01 * float(std.split()[0]) if isinstance(std, str) else None
        assert storage == (std / factor if share is None else share)
        assert loss_factor == (std if share is None else share * abs(0.3 / factor))


def test_what_is_attached_is_what_terms_of_the_same_entries_are(chain: Chain):
    by_hand = np.zeros(chain.n)
    by_hand[[3, 4]] = 0.002
    terms = [frfit.Term("k", chain.stiffness, factor=1000.0), frfit.Term("m", chain.mass, role="mass")]
    ours = frfit.Model(terms, attached=frfit.Attached(row=[3, 4], mass=0.002))
    theirs = frfit.Model([*terms, frfit.Term("extra", np.diag(by_hand), role="mass")])
    assert ours.names == ["k", "m", "attached 1 (mass)"]
    at = {"load": 0, "sensors": list(ROWS)}
    np.testing.assert_array_equal(frfit.respond(ours, F, **at), frfit.respond(theirs, F, **at))
