"""What a terminal and a notebook show: few lines, the numbers that matter, escaped text."""

from __future__ import annotations

import dataclasses
import html.parser
import inspect
import pathlib
import re

import numpy as np
import pytest
from conftest import Chain, measured_chain

import frfit
from frfit._shown import with_std

F = np.linspace(4.0, 110.0, 400)


@pytest.fixture(scope="module")
def measured():
    return measured_chain(F)


@pytest.fixture(scope="module")
def found(measured):
    options = {"max_lines": 30, "check": False, "load": 0, "matrix": "springs"}
    return frfit.identify(Chain().model(1200.0), measured, **options)


class Tags(html.parser.HTMLParser):
    """The tags of a page, whether each is closed, and its text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.opened: list[str] = []
        self.names: set[str] = set()
        self.text = ""
        self.feed(page)
        self.close()
        assert self.opened == []

    def handle_starttag(self, tag, attrs):
        self.opened.append(tag)
        self.names.add(tag)

    def handle_endtag(self, tag):
        assert self.opened.pop() == tag

    def handle_data(self, data):
        self.text += data


def few(shown: str, lines: int = 5, characters: int = 600) -> str:
    """At most so many lines and characters."""
    assert len(shown.splitlines()) <= lines and len(shown) <= characters, shown
    return shown


def numbers(text: str) -> list[float]:
    return [float(word) for word in re.findall(r"\d+\.\d+", text)]


def test_results_are_a_few_lines_with_their_numbers(found):
    shown = few(repr(found))
    assert shown.startswith("<frfit.Identification of springs at 400 frequencies: ")
    assert f"{np.count_nonzero(found.ok)} ok" in shown.splitlines()[0]
    assert "370 out_of_band" in shown and "4 to 110 Hz, 2 sensors" in shown 
    assert f"{100 * found.trusted:.0f} % of the band trusted" in shown and found.trusted > 0.9
    # The median of the trusted moduli, with its digits.
    storage = float(np.median(found.storage[found.ok]))
    assert any(abs(number - storage) < 1e-3 * storage for number in numbers(shown))
    assert "springs, frequency: median of storage" in few(repr(found.unknowns[0]), 1)


def test_several_unknowns_have_a_line_each(measured):
    unknowns = [
        frfit.Unknown(matrix="springs", varies="constant", bounds={"storage": (100.0, 1e4), "loss_factor": (0.0, 1.0)}),
        frfit.Unknown("a mass", matrix="mass", varies="constant", real=True, bounds=(0.5, 2.0)),
    ]
    both = frfit.identify(Chain().model(1200.0), measured, load=0, unknowns=unknowns, max_lines=30)
    shown = few(repr(both))
    assert "springs (constant): storage " in shown and "a mass (constant): value " in shown and " ± " in shown
    assert few(repr(both["a mass"]), 1).endswith("(ok)>")
    page = Tags(both._repr_html_())
    assert page.names <= {"div", "p", "strong", "ul", "li", "table", "thead", "tbody", "tr", "th", "td"}
    for number in (*both["springs"].numbers, *both["a mass"].numbers):
        assert number.name in page.text
    many = dataclasses.replace(both, unknowns=both.unknowns * 40)
    assert "and 74 more" in few(repr(many), 9, 1000) and len(many._repr_html_()) < 6000


def test_a_page_of_a_notebook_is_small_escaped_and_without_scripts(found):
    page = found._repr_html_()
    assert len(page) < 3000 and "400 frequencies" in Tags(page).text
    evil = "<script>alert(1)</script>"
    wrong = frfit.Finding("sign", (evil,), evil, evil, evil)
    named = dataclasses.replace(found.unknowns[0], name=evil)
    bad = dataclasses.replace(found, unknowns=(named,), findings=(wrong,), not_identifiable=(evil,))
    shown = bad._repr_html_()
    assert "<script" not in shown and Tags(shown).text.count(evil) >= 3
    batch = frfit.Batch(2, 0, 0, 0, [(1, evil)] * 50, 1.0)
    assert "<script" not in batch._repr_html_() and Tags(batch._repr_html_()).text.count(evil) == 20


def test_arguments_are_a_line_each(measured, chain):
    shown = few(repr(measured[0]), 1, 200)
    assert shown == "<frfit.Measurement of receptance at row 6 (+): 400 frequencies, 4 to 110 Hz, std 1 % (median)>"
    other = frfit.Measurement(
        F, F, 3, "mobility", sign=-1, coherence=np.full(400, 0.98), averages=5, scale="unknown", decay_per_s=6.0
    )
    expected = "mobility at row 3 (-): 400 frequencies, 4 to 110 Hz, coherence 0.98 (median) of 5 averages, scale unknown"
    assert expected in few(repr(other), 1, 250) and "decay_per_s 6.0" in repr(other)
    big = np.eye(400)
    term = frfit.Term("k", big, factor=2e9 + 1e7j, storage_std="2 %")
    assert few(repr(term), 1, 200) == "<frfit.Term 'k': stiffness, 400 x 400 (dense), factor 2e+09+1e+07j, storage_std '2 %'>"
    assert "12 x 12 (csc, 34 entries)" in repr(frfit.Term("k", chain.stiffness, factor=frfit.Law.zener(1, 2, 3, 0.5)))
    model = frfit.Model([frfit.Term(f"part {k}", np.eye(2)) for k in range(40)])
    assert "and 34 more" in few(repr(model), 1, 200)
    mesh = frfit.CoarserMesh(chain.model(1000.0), load=np.ones(12), sensors=range(12))
    assert "12 degrees of freedom: load 12 values, 12 sensors" in few(repr(mesh), 1, 200)
    unknown = frfit.Unknown("core", matrix="core", bounds={"storage": (1e5, 1e9)})
    assert repr(unknown) == "Unknown(name='core', matrix='core', bounds={'storage': (100000.0, 1000000000.0)})"
    assert few(repr(frfit.Unknown("x", powers={f"m{k}": 1 for k in range(90)}, nominal=1.0)), 1, 200)
    assert repr(frfit.Attached([3, 4], mass=0.1)) == "Attached([3, 4], mass=0.1)"


def test_records_and_files_are_a_line_each(tmp_path):
    t = np.arange(2048) / 2048
    force = np.where((t > 0.01) & (t < 0.013), np.sin(np.pi * (t - 0.01) / 0.003), 0.0)
    recording = frfit.Recording(1 / 2048, force, np.stack([force, force]))
    assert "2048 samples of 0.000488281 s, 2 sensors, force up to 0.9" in few(repr(recording), 1, 200)
    hammered = frfit.frf([recording] * 3)
    assert "2 sensors" in few(repr(hammered), 1, 300) and "3 of 3 impacts" in repr(hammered)
    path = tmp_path / "f.uff"
    function = frfit.UffFunction(F, F * 1j, frfit.UffDof(7, 3), frfit.UffDof(1, -1), abscissa_axis=frfit.UffAxis(18, "", "Hz"))
    assert "type 4, 7+Z over 1-X: complex, 400 values from 4 to 110 Hz" in few(repr(function), 1, 200)
    frfit.write_uff(path, [function] * 50, binary=True)
    file = frfit.read_uff(path)
    assert "50 datasets, 50 functions" in few(repr(file), 1, 300)
    assert "frequency response function 7+Z over 1-X" in few(repr(file.datasets[0]), 1, 200)


def test_findings_and_directions_are_a_line_each(found):
    finding = frfit.Finding("sign", tuple(f"row {k}" for k in range(200)), "it is turned", "much" * 500, "turn it")
    assert few(repr(finding), 1, 200) == "<frfit.Finding of row 0, row 1, row 2, row 3, row 4, row 5, and 194 more: it is turned>"
    direction = frfit.Direction(0.01, {f"number {k}": 0.1 for k in range(100)})
    assert "std 0.01: +0.10 number 0" in few(repr(direction), 1, 200)


def test_batches_name_what_failed():
    batch = frfit.Batch(100, 3, 40, 2, [(k, f"no file\n{k}") for k in range(55)], 12.5)
    shown = few(repr(batch), 6)
    assert "100 rows, 40 done, 3 kept, 55 failed in 12.5 s" in shown and "row 0: no file 0" in shown
    assert "and 52 more" in shown and "2 failed before" in shown
    assert repr(frfit.Batch(1, 0, 1, 0, [], 0.5)) == "<frfit.Batch: 1 rows, 1 done, 0 kept, 0 failed in 0.5 s>"


def some_modes(pairs: int) -> frfit.Modes:
    n = np.linspace(10.0, 100.0, 12)
    empty = np.zeros(0)
    values = {field.name: empty for field in dataclasses.fields(frfit.Modes)}
    values |= {
        "frequency_hz": n,
        "damping_ratio": n * 1e-4,
        "measured_frequency_hz": n[:pairs] * 1.02,
        "measured_damping_ratio": n[:pairs] * 2e-4,
        "pairs": np.stack([np.arange(pairs)] * 2, axis=1),
        "frequency_difference": np.full(pairs, 1 / 1.02 - 1),
        "mac": np.full(pairs, 0.98),
        "stiffness_factor": 1.04 if pairs else None,
        "title": "<b>Plate</b>",
    }
    return frfit.Modes(**values)


@pytest.mark.parametrize("pairs", [0, 8])
def test_modes_are_a_table(pairs):
    modes = some_modes(pairs)
    shown = few(repr(modes), 7)
    assert f"12 of the model, {pairs} measured, {pairs} pairs" in shown
    assert ("10 Hz (measured 10.2 Hz, -1.96 %) MAC 0.980" in shown) == (pairs > 0)
    page = modes._repr_html_()
    assert "<b>" not in page and "<b>Plate</b>" in Tags(page).text and len(page) < 4000
    assert Tags(page).text.count("1.02") + Tags(page).text.count("10.2") >= (1 if pairs else 0)


def test_a_report_is_shown_in_a_frame_and_a_large_one_as_a_link(monkeypatch, tmp_path):
    page = '<!doctype html><html><body title="a&b"><script>1</script></body></html>'
    monkeypatch.setattr("frfit._report._frfit.report", lambda folder: page)
    report = frfit.Report(tmp_path)
    shown = report._repr_html_()
    assert shown.startswith('<iframe sandbox="allow-scripts"') and "<script" not in shown
    parser = Frames()
    parser.feed(shown)
    assert parser.pages == [page]
    assert few(repr(report), 1, 300).endswith("0.0 MB>")
    monkeypatch.setattr("frfit._report._LARGEST", 10)
    assert ".save()" in report._repr_html_()
    report.save()
    assert pathlib.Path(tmp_path, "report.html").as_uri() in report._repr_html_()


class Frames(html.parser.HTMLParser):
    """The pages in the frames of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.pages: list[str | None] = []

    def handle_starttag(self, tag, attrs):
        self.pages.append(dict(attrs).get("srcdoc"))


def test_no_public_class_is_shown_with_its_arrays():
    """Whatever holds arrays says what it is in words of its own."""
    for name in frfit.__all__:
        one = getattr(frfit, name)
        if not (isinstance(one, type) and dataclasses.is_dataclass(one)):
            continue
        arrays = [one for one in dataclasses.fields(one) if re.search("Real|Complex|Array|Any|Whole|Flags", str(one.type))]
        is_generated = inspect.unwrap(one.__repr__).__code__.co_filename == "<string>"
        assert not (arrays and is_generated), (name, arrays)


@pytest.mark.parametrize(
    ("value", "std", "shown"),
    [
        (1000.0, 0.31, "1000.00 ± 0.31"),
        (6.9e10, 1.234e7, "6.9000e+10 ± 1.2e+07"),
        (0.03, 0.0045, "0.0300 ± 0.0045"),
        (0.03, 2.0, "0.030 ± 2.0"),
        (123.0, 12.0, "123 ± 12"),
        (5.0, np.nan, "5"),
        (5.0, np.inf, "5"),
        (np.nan, 1.0, "none"),
        (-2.0, 0.5, "-2.00 ± 0.50"),
    ],
)
def test_a_number_has_the_digits_that_its_deviation_leaves(value, std, shown):
    assert with_std(value, std) == shown
