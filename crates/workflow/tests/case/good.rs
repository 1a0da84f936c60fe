//! A complete case with every feature, and the freedoms that a case has.

use super::files::{CASE, edited, folder, with};
use frfit::c64;
use frfit::identify::{ErrorSizes, Method, ModelErrors, Options, Reduction, Selection};
use frfit::material::Law;
use frfit::model::{FactorStd, Sensor};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use frfit_formats::{op4, read_matrix};
use frfit_workflow::load::{MeasuredNoise, Overrides, Purpose, load};
use std::fs;
use std::path::Path;

#[test]
fn everything_that_a_case_says_is_there() {
    let folder = folder("", None);
    let case_file = folder.path().join("case.toml");
    let case = load(&case_file, &Overrides::default(), Purpose::Identify).unwrap();

    assert_eq!(case.title, "Three masses");
    let names: Vec<_> = case.model.terms().iter().map(|term| term.name.as_str()).collect();
    assert_eq!((case.model.dim(), names), (3, vec!["springs", "core", "mass"]));
    assert_eq!(case.model.terms()[0].factor, Law::Constant(c64::new(2e5, 2e4)));
    assert!(matches!(case.model.terms()[1].factor, Law::Table(_)));
    assert_eq!(case.model.terms()[2].factor, Law::Constant(c64::new(1.0, 0.0)));
    assert_eq!(case.model.terms()[1].matrix.get(2, 0), c64::new(-1.0, 0.0));

    assert_eq!(case.experiment.load, [c64::new(1.0, 0.0), c64::default(), c64::default()]);
    assert_eq!(case.experiment.sensors, [Sensor { row: 1, sign: -1.0 }, Sensor { row: 2, sign: 1.0 }]);
    let sensors: Vec<_> = case.sensors.iter().map(|s| (s.label.as_str(), s.quantity)).collect();
    assert_eq!(sensors, [("2-Z", Quantity::Accelerance), ("row 3", Quantity::Receptance)]);
    assert_eq!(case.sensors[1].file.as_deref(), Some(Path::new("b.csv")));

    let identify = case.identify.as_ref().unwrap();
    assert_eq!(identify.matrices(&case.model, 0), ["springs"]);
    assert_eq!(identify.unknowns[0].nominal, Law::Constant(c64::new(2e5, 2e4)));
    let bounds = Bounds { storage: Some([1e5, 1e6]), loss_factor: Some([0.0, 1.0]) };
    assert_eq!(identify.unknowns[0].bounds, bounds);
    assert_eq!(identify.options, Options::default().with_order(20));
    assert_eq!((identify.band_hz, &identify.frequency_hz[..]), ([10.0, 30.0], &[10.0, 20.0, 30.0][..]));
    assert_eq!(identify.reference[0], Some(Law::Fractional { e0: 1e5, e1: 2e4, alpha: 0.5 }));
    assert_eq!(case.respond_hz, [10.0, 20.0, 30.0]);
}

/// Sensors on other grids: the lines that all of them have.
#[test]
fn lines_that_all_sensors_have_are_used() {
    let table = "frequency_hz,re,im,coherence\n10,1,0,0.9\n15,7,0,0.8\n20.00000000001,2,0,0.8\n31,3,0,1\n";
    let case = with("b.csv", table.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
    let identify = case.identify.unwrap();
    assert_eq!((&identify.frequency_hz[..], identify.not_common), (&[10.0, 20.0][..], 1));
    assert_eq!(identify.measured.iter().map(|row| row[1].re).collect::<Vec<_>>(), [1.0, 2.0]);
}

/// A table in magnitude and phase without names is what it is in real and imaginary part.
#[test]
fn columns_are_named_by_the_case() {
    let table = b"10;0,9;0;1\n20;0,8;0;2\n30;1;180,0;3\n";
    let folder = folder("b.csv", Some(table));
    let text = CASE.replace(
        "file = \"b.csv\"",
        "file = \"b.csv\"\ncolumns = [\"f\", \"coherence\", \"phase_deg\", \"mag\"]",
    );
    fs::write(folder.path().join("case.toml"), text).unwrap();
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify).unwrap();
    let second: Vec<c64> = case.identify.unwrap().measured.iter().map(|row| row[1]).collect();
    let expected = [1.0, 2.0, -3.0].map(|re| c64::new(re, 0.0));
    assert!(
        second.iter().zip(expected).all(|(value, expected)| (value - expected).norm() < 1e-14),
        "{second:?}"
    );
}

/// Standard deviations of factors are relative to the storage, absolute of the loss factor, be they written as numbers or in per cent.
#[test]
fn what_is_known_of_the_model_is_read() {
    let read = |factor: &str, known: &str| {
        let text = edited("case.toml", "{ table = \"modulus.csv\" }", factor);
        let text = text.replace("title = \"Three masses\"", known);
        let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
        (case.model.factor_std(1), case.identify.unwrap().options.model_errors)
    };
    let (std, errors) = read(
        "{ storage = 15.0, loss_factor = 0.1, storage_std = 0.3, loss_factor_std = \"20 %\" }",
        "model_error = \"0.5 %\"",
    );
    assert!((std.storage.unwrap() - 0.02).abs() < 1e-12, "{std:?}");
    assert!((std.loss_factor.unwrap() - 0.02).abs() < 1e-12, "{std:?}");
    assert_eq!(errors, ModelErrors::Given(ErrorSizes::default().with_frequency(Some(0.005))));
    let (std, errors) = read(
        "{ table = \"modulus.csv\", storage_std = \"2 %\", loss_factor_std = 0.01 }",
        "model_error = { shape = 0.02 }",
    );
    assert_eq!(std, FactorStd { storage: Some(0.02), loss_factor: Some(0.01) });
    assert_eq!(errors, ModelErrors::Given(ErrorSizes::default().with_shape(Some(0.02))));
    let (std, errors) = read("15.0", "model_error = \"none\"");
    assert_eq!((std, errors), (FactorStd::default(), ModelErrors::None));
}

#[test]
fn matrices_of_one_file_are_chosen_by_their_names() {
    let folder = folder("", None);
    let read = |name: &str| read_matrix(&fs::read(folder.path().join(name)).unwrap()).unwrap();
    let (k, m) = (read("K.mtx"), read("M.mtx"));
    fs::write(folder.path().join("model.op4"), op4::write(&[("K", &k), ("M", &m)]).unwrap()).unwrap();
    let case_file = folder.path().join("case.toml");
    let load = |case: &str| {
        fs::write(&case_file, case).unwrap();
        load(&case_file, &Overrides::default(), Purpose::Identify)
    };
    let separate = load(CASE).unwrap();
    let both = edited("case.toml", "\"K.mtx\"", "{ file = \"model.op4\", name = \"K\" }");
    let both = both.replace("\"M.mtx\"", "{ file = \"model.op4\", name = \"M\" }");
    let together = load(&both).unwrap();
    for (one, other) in separate.model.terms().iter().zip(together.model.terms()) {
        assert_eq!(one.matrix, other.matrix);
    }
    // Read once, named once.
    let names: Vec<_> = together.inputs.iter().map(|input| input.path.to_str().unwrap()).collect();
    assert_eq!(names.iter().filter(|name| **name == "model.op4").count(), 1, "{names:?}");

    let refused = |case: &str| super::files::message(&folder, &load(case).unwrap_err());
    assert_eq!(
        refused(&both.replace("{ file = \"model.op4\", name = \"K\" }", "\"model.op4\"")),
        "model.op4: expected one matrix, or a name: { file = \"...\", name = \"...\" }, found K (3 x 3), M (3 x 3)\n\
         named in case.toml:5:1: matrix.file"
    );
    assert_eq!(
        refused(&both.replace("name = \"K\" }", "name = \"KAA\" }")),
        "model.op4: expected one matrix named \"KAA\", found K (3 x 3), M (3 x 3)\n\
         named in case.toml:5:10: matrix.file.file"
    );
}

#[test]
fn measured_values_and_their_deviations_become_receptance() {
    let case = with("", b"", &Overrides::default(), Purpose::Identify).unwrap();
    let identify = case.identify.unwrap();
    for (k, &f) in identify.frequency_hz.iter().enumerate() {
        let omega = std::f64::consts::TAU * f;
        let accelerance = c64::new(k as f64 + 1.0, -1.0);
        let expected = -accelerance / (omega * omega);
        // Two roundings of a division.
        assert!((identify.measured[k][0] - expected).norm() < 1e-15 * expected.norm());
        assert_eq!(identify.measured[k][1], c64::new(k as f64 + 1.0, 0.0));
    }
    // One has a standard deviation, the other a coherence: nothing weighs the one against the other.
    assert_eq!(identify.noise, MeasuredNoise::Unknown);
}

#[test]
fn deviations_are_those_of_the_receptance_and_coherence_gives_them_up_to_a_factor() {
    let with_b = |table: &str| {
        let case = with("b.csv", table.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
        case.identify.unwrap()
    };
    let identify = with_b("frequency_hz,re,im,std\n10,1,0,0.25\n20,2,0,0.25\n30,3,0,0.5\n");
    let MeasuredNoise::Known(std) = &identify.noise else { panic!("{:?}", identify.noise) };
    for (k, &f) in identify.frequency_hz.iter().enumerate() {
        let omega = std::f64::consts::TAU * f;
        // Accelerance becomes receptance, and its standard deviation with it; two roundings.
        assert!((std[k][0] - 0.5 / (omega * omega)).abs() < 1e-15 * std[k][0]);
    }
    assert_eq!([std[0][1], std[1][1], std[2][1]], [0.25, 0.25, 0.5]);

    let folder =
        folder("a.csv", Some(b"frequency_hz,re,im,coherence\n10,1,-1,1\n20,2,-1,0.5\n30,3,-1,0.9\n"));
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify).unwrap();
    let identify = case.identify.unwrap();
    let MeasuredNoise::Relative(std) = &identify.noise else { panic!("{:?}", identify.noise) };
    // Of the complex value, as of one average: |H| √((1 − γ²)/γ²), here for γ² = 1/2 and 0.8; a few roundings.
    let half = identify.measured[1][0].norm();
    assert!((std[1][0] - half).abs() < 1e-14 * half);
    assert!((std[1][1] - 2.0 * (0.2f64 / 0.8).sqrt()).abs() < 1e-14);
    // No coherence is exactly one: a standard deviation of zero would outweigh everything.
    assert!(std[0][0] > 0.0);
}

#[test]
fn an_estimated_nominal_is_the_middle_of_the_bounds() {
    let estimate = |bounds: &str| {
        let text = edited("case.toml", "order = 20", "order = 20\nstart = \"bounds\"");
        let text = text.replace("storage = [1e5, 1e6]", bounds);
        with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify)
    };
    let identify = estimate("storage = [1e5, 1e7]").unwrap().identify.unwrap();
    let Law::Constant(nominal) = identify.unknowns[0].nominal else { panic!("{:?}", identify.unknowns) };
    assert!((nominal - c64::new(1e6, 1e4)).norm() < 1e-9 * 1e6, "{nominal}");
    assert!(identify.options.whole_box);
    let error = estimate("storage = [0, 1]").unwrap_err().to_string();
    assert!(
        error.ends_with("expected bounds.storage above zero, to begin in the middle of, found [0, 1]"),
        "{error}"
    );
}

#[test]
fn every_file_is_recorded_once_with_its_checksum() {
    let folder = folder("", None);
    let case_file = folder.path().join("case.toml");
    let case = load(&case_file, &Overrides::default(), Purpose::Identify).unwrap();
    let names: Vec<_> = case.inputs[1..].iter().map(|input| input.path.to_str().unwrap()).collect();
    assert_eq!(case.inputs[0].path, case_file);
    assert_eq!(case.inputs[0].bytes, CASE.len());
    assert_eq!(names, ["K.mtx", "core.mtx", "M.mtx", "modulus.csv", "dofs.csv", "a.csv", "b.csv"]);
    // By `sha256sum` on the text of dofs.csv.
    assert_eq!(case.inputs[5].sha256, "1e183dcce1f1de253bdabc123ca248f2c5897a1bb0e3b1c99922863f0b261cb1");
}

#[test]
fn the_command_line_overrides_the_case() {
    let overrides = Overrides {
        method: Some("nelder-mead".into()),
        order: Some(7),
        band_hz: Some([15.0, 25.0]),
        reduction: Some("full".into()),
        ..Overrides::default()
    };
    let identify = with("", b"", &overrides, Purpose::Identify).unwrap().identify.unwrap();
    assert_eq!((identify.options.method, identify.options.order), (Method::NelderMead, 7));
    // A method without several roots brings the selection that it can have.
    assert_eq!(
        (identify.options.selection, identify.options.reduction),
        (Selection::Smallest, Reduction::Full)
    );
    assert_eq!((identify.band_hz, &identify.frequency_hz[..]), ([15.0, 25.0], &[20.0][..]));
    let response = with("", b"", &overrides, Purpose::Respond).unwrap();
    assert_eq!((response.respond_hz[0], response.respond_hz[3]), (15.0, 25.0));
}

#[test]
fn a_response_needs_no_measurement() {
    let text = CASE.replace("file = \"a.csv\"\n", "").replace("b.csv", "not there yet.csv");
    let text = format!(
        "{}[respond]{}",
        text.split("[identify]").next().unwrap(),
        CASE.split("[respond]").nth(1).unwrap()
    );
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Respond).unwrap();
    assert!(case.identify.is_none());
    assert_eq!(case.respond_hz, [10.0, 20.0, 30.0, 40.0]);
    assert_eq!(case.sensors.iter().map(|sensor| sensor.file.is_some()).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn a_response_without_a_band_is_at_the_measured_frequencies() {
    let text = CASE.split("[respond]").next().unwrap();
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Respond);
    // The factor's table begins at 1 Hz, the measurement at 0 Hz: no law extrapolates.
    let error = case.unwrap_err().to_string();
    assert!(error.ends_with("found the table covers 1 Hz to 100 Hz, and 0 Hz was asked for"), "{error}");
    let overrides = Overrides { band_hz: Some([5.0, 50.0]), ..Overrides::default() };
    let case = with("case.toml", text.as_bytes(), &overrides, Purpose::Respond).unwrap();
    assert_eq!(case.respond_hz, [10.0, 20.0, 30.0, 40.0]);
}

#[test]
fn matrices_with_equal_factors_share_one() {
    let text = edited("case.toml", "{ table = \"modulus.csv\" }", "{ storage = 2e5, loss_factor = 0.1 }")
        .replace("matrix = \"springs\"", "matrix = [\"springs\", \"core\"]");
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
    let identify = case.identify.as_ref().unwrap();
    assert_eq!(identify.matrices(&case.model, 0), ["springs", "core"]);
}

#[test]
fn the_load_has_a_sign_or_is_a_vector() {
    let loaded = |load: &str| {
        let text = edited("case.toml", "dof = \"1+Z\"", load);
        let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify);
        case.unwrap().experiment.load
    };
    assert_eq!(loaded("dof = \"2-rx\"")[2], c64::new(-1.0, 0.0));
    assert_eq!(loaded("row = 3")[2], c64::new(1.0, 0.0));

    let folder =
        folder("case.toml", Some(edited("case.toml", "dof = \"1+Z\"", "file = \"f.csv\"").as_bytes()));
    std::fs::write(folder.path().join("f.csv"), "row;im;re\n3;2.5;1\n1;0;-4\n").unwrap();
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify).unwrap();
    assert_eq!(case.experiment.load, [c64::new(-4.0, 0.0), c64::default(), c64::new(1.0, 2.5)]);
}

#[test]
fn a_title_is_optional_and_a_byte_order_mark_is_passed_over() {
    let text = format!("\u{feff}{}", CASE.split_once('\n').unwrap().1);
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
    assert_eq!(case.title, "case");
}

/// Of a coarser mesh matrices, load and places of the sensors are read, and its files are inputs; its measurements are not opened.
#[test]
fn a_coarser_mesh_is_read_from_its_own_case() {
    let folder = folder("", None);
    let case_file = folder.path().join("case.toml");
    let sub = folder.path().join("coarse");
    fs::create_dir(&sub).unwrap();
    let is_record = |name: &str| name == "a.csv" || name == "b.csv";
    for entry in fs::read_dir(folder.path()).unwrap().map(Result::unwrap).filter(|one| one.path().is_file()) {
        let name = entry.file_name().into_string().unwrap();
        if !is_record(&name) {
            fs::copy(entry.path(), sub.join(name)).unwrap();
        }
    }
    let with = |line: &str| {
        fs::write(&case_file, format!("{line}\n{CASE}")).unwrap();
        load(&case_file, &Overrides::default(), Purpose::Identify)
    };
    let coarse = fs::read_to_string(sub.join("case.toml")).unwrap();
    let case =
        with("coarser_mesh = { file = \"coarse/case.toml\", element_ratio = 1.5, order = 4 }").unwrap();
    let mesh = case.coarser_mesh.unwrap();
    assert_eq!((mesh.element_ratio, mesh.order, mesh.model.dim()), (1.5, 4.0, 3));
    assert_eq!(mesh.experiment, case.experiment);
    let inputs: Vec<_> = case.inputs.iter().map(|input| input.path.display().to_string()).collect();
    let of_coarse = inputs.iter().filter(|path| path.contains("coarse")).count();
    assert!(of_coarse >= 4 && !inputs.iter().any(|path| path.contains("coarse/a.csv")), "{inputs:?}");

    let refused = |line: &str, expected: &str| {
        let error = with(line).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    refused("coarser_mesh = \"none.toml\"", "expected a case file, found none");
    let renamed = coarse.replace("\"core\"", "\"kern\"");
    fs::write(sub.join("case.toml"), renamed).unwrap();
    refused(
        "coarser_mesh = \"coarse/case.toml\"",
        "the same matrices in the same order, springs, core, mass",
    );
}
