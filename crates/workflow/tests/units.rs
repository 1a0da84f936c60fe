//! One physical beam written in several systems of units: whatever the model is in, the answer is the same.

use crate::tier::of_tier;

use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::quantity::Quantity;
use frfit::response::{FullModel, Response};
use frfit_fem::{Assembled, Beam, Direction, Support};
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};
use frfit_workflow::Reads;
use frfit_workflow::check::{check_case, check_text};
use frfit_workflow::export::{ExportOptions, Target, UnitSystem, export};
use frfit_workflow::fit::fit_table;
use frfit_workflow::job::{IdentifyJob, JobError, identify_case, respond_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Storage modulus in Pa and loss factor of the beam, as it is and as the case has it; density in kg/m³.
const TRUTH: c64 = c64::new(1.9e9, 0.05 * 1.9e9);
const NOMINAL: [f64; 2] = [2.3e9, 0.03];
const DENSITY: f64 = 1180.0;

/// What is attached at the tip: kg, N/m, N·m/rad, N·s/m.
const MASS: f64 = 0.012;
const SPRING: f64 = 1200.0;
const TURNS: f64 = 0.8;
const DAMPER: f64 = 0.3;

/// Length in m, mass in kg and time in s of the systems that the model is written in: from handbooks, not from the program.
const SYSTEMS: [(&str, [f64; 3]); 5] = [
    ("SI", [1.0, 1.0, 1.0]),
    ("mm-t-s", [1e-3, 1e3, 1.0]),
    ("mm-kg-ms", [1e-3, 1.0, 1e-3]),
    ("in-lbf-s", [0.0254, 175.126_835_246_476_4, 1.0]),
    ("cm-g-s", [1e-2, 1e-3, 1.0]),
];

fn beam() -> Assembled {
    let [width, thickness] = [0.02, 0.004];
    let beam = Beam {
        length: 0.25,
        area: width * thickness,
        inertia: width * f64::powi(thickness, 3) / 12.0,
        elements: 10,
        ends: [Support::Clamped, Support::Free],
        ..Beam::default()
    };
    beam.assemble().unwrap()
}

/// Row of a deflection and a rotation of a node.
fn row(beam: &Assembled, node: usize, direction: Direction) -> usize {
    beam.row(node, direction).unwrap()
}

/// The receptances (m/N, rad/N; m/(N·m), rad/(N·m) where driven by a moment) of the true beam at two sensors: deflection of the tip, and rotation of node 7.
fn measured(beam: &Assembled, driven: usize, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    let term = |name: &str, role, matrix: SymmetricMatrix, factor: c64| Term {
        name: name.into(),
        role,
        matrix,
        factor: Law::Constant(factor),
    };
    let single = |row: usize, value: f64| {
        let mut matrix = Triplets::new(beam.dofs.len());
        matrix.add(row, row, value);
        matrix.assemble()
    };
    let one = c64::new(1.0, 0.0);
    let (tip, turned) = (row(beam, 11, Direction::Z), row(beam, 11, Direction::RY));
    let model = DynamicStiffness::new(vec![
        term("beam", Role::Stiffness, beam.stiffness[0].clone(), TRUTH),
        term("mass", Role::Mass, beam.mass[0].clone(), c64::new(DENSITY, 0.0)),
        term("tip", Role::Mass, single(tip, MASS), one),
        term("spring", Role::Stiffness, single(tip, SPRING), one),
        term("turns", Role::Stiffness, single(turned, TURNS), one),
        term("damper", Role::Viscous, single(tip, DAMPER), one),
    ])
    .unwrap();
    let sensor = |row| Sensor { row, sign: 1.0 };
    let sensors = vec![sensor(tip), sensor(row(beam, 7, Direction::RY))];
    let experiment = Experiment::driven_at(beam.dofs.len(), sensor(driven), sensors);
    let at = |&f: &f64| FullModel::new(model.at(f, &[]).unwrap(), &experiment).unwrap();
    frequency_hz.iter().map(|f| at(f).respond_nominal().unwrap()).collect()
}

/// A matrix in Matrix Market, entry (i, j) times a number of its own.
fn mtx(matrix: &SymmetricMatrix, times: impl Fn(usize, usize) -> f64) -> String {
    let mut entries = String::new();
    let mut count = 0;
    for (i, j) in matrix.pattern().positions() {
        writeln!(entries, "{} {} {:e}", i + 1, j + 1, times(i, j) * matrix.get(i, j).re).unwrap();
        count += 1;
    }
    let dim = matrix.dim();
    format!("%%MatrixMarket matrix coordinate real symmetric\n{dim} {dim} {count}\n{entries}")
}

/// The case of the beam in a system of units, driven at `load`. `keys` come last.
fn folder(name: &str, [length, mass, time]: [f64; 3], load: &str, keys: &str) -> TempDir {
    let beam = beam();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let force = mass * length / (time * time);
    let stress = force / (length * length);
    let turns = |row: usize| beam.dofs[row].direction == Direction::RY;
    // Displacements in the system's length, forces in its force, moments in force times length; angles in rad.
    let displacement = |row: usize| if turns(row) { 1.0 } else { length };
    let load_of = |row: usize| if turns(row) { force * length } else { force };
    write("K.mtx", &mtx(&beam.stiffness[0], |i, j| stress * displacement(j) / load_of(i)));
    let density = mass / length.powi(3);
    let per_time = time.powi(-2);
    write("M.mtx", &mtx(&beam.mass[0], |i, j| density * displacement(j) * per_time / load_of(i)));
    let direction = |row: usize| if turns(row) { "RY" } else { "Z" };
    let names = (0..beam.dofs.len()).map(|i| format!("{},{},{}\n", i + 1, beam.dofs[i].node, direction(i)));
    write("dofs.csv", &format!("row,node,direction\n{}", names.collect::<String>()));
    let frequency_hz = linear_hz(20.0, 600.0, 30);
    let driven = row(&beam, 9, if load.contains("RY") { Direction::RY } else { Direction::Z });
    let exact = measured(&beam, driven, &frequency_hz);
    for (m, quantity) in [Quantity::Accelerance, Quantity::Receptance].into_iter().enumerate() {
        let mut text = "frequency_hz,re,im\n".to_owned();
        for (&f, x) in frequency_hz.iter().zip(&exact) {
            let value = quantity.from_receptance(f, x[m]);
            writeln!(text, "{f:e},{:e},{:e}", value.re, value.im).unwrap();
        }
        write(&format!("{m}.csv"), &text);
    }
    // The mass as a number of the system, in kg, and in grams; the springs as numbers and with units.
    let case = format!(
        "title = \"Beam\"\nunits = \"{name}\"\n\
         [[matrix]]\nname = \"beam\"\nrole = \"stiffness\"\nfile = \"K.mtx\"\nfactor_is = \"modulus\"\n\
         factor = {{ storage = {:e}, loss_factor = {:e} }}\n\
         [[matrix]]\nname = \"mass\"\nrole = \"mass\"\nfile = \"M.mtx\"\nfactor = {:e}\n\
         [dofs]\nfile = \"dofs.csv\"\n[load]\n{load}\n\
         [[attached]]\ndof = \"11+Z\"\nmass = {:e}\nstiffness = \"1.0 N/mm\"\ndamping = {:e}\n\
         [[attached]]\ndof = \"11+Z\"\nmass = \"4 g\"\nstiffness = {:e}\ndamping = \"0.1 N s/m\"\n\
         [[attached]]\ndof = \"11+Z\"\nmass_kg = 0.003\n\
         [[attached]]\ndof = \"11+RY\"\nstiffness = \"500 N mm/rad\"\n\
         [[attached]]\ndof = \"11-RY\"\nstiffness = {:e}\n\
         [[measurement]]\nfile = \"0.csv\"\ndof = \"11+Z\"\nquantity = \"accelerance\"\n\
         [[measurement]]\nfile = \"1.csv\"\ndof = \"7+RY\"\nquantity = \"receptance\"\n{keys}",
        NOMINAL[0] / stress,
        NOMINAL[1],
        DENSITY / density,
        (MASS - 0.007) / mass,
        0.2 / (mass / time),
        200.0 / (mass / (time * time)),
        0.3 / (force * length),
    );
    write("case.toml", &case);
    folder
}

/// Bounds in the unit of modulus of the system.
fn identify_keys([length, mass, time]: [f64; 3]) -> String {
    let stress = mass / (length * time * time);
    let [low, high] = [5e8 / stress, 8e9 / stress];
    format!(
        "[identify]\nmatrix = \"beam\"\nband_hz = [20.0, 600.0]\nreduction = \"full\"\nbounds = {{ storage = [{low:e}, {high:e}], loss_factor = [0.0, 0.5] }}\n"
    )
}

fn run(folder: &TempDir) -> Result<IdentifyJob, JobError> {
    let case = folder.path().join("case.toml");
    identify_case(&case, &Overrides::default(), RunOptions::default(), &folder.path().join("out"), &|_, _| {})
}

/// Loads with which the beam is driven: a force, and a moment.
const LOADS: [&str; 2] = ["dof = \"9+Z\"", "dof = \"9+RY\""];

fn load_of(k: usize) -> String {
    LOADS[k].to_owned()
}

#[test]
fn the_modulus_is_the_same_in_every_system() {
    for k in 0..LOADS.len() {
        let mut first: Option<Vec<c64>> = None;
        // By day two systems are enough for the other loads, whose responses are compared in all of them below.
        let step = if k == 0 { 1 } else { of_tier(3, 1) };
        for (name, made) in SYSTEMS.into_iter().step_by(step) {
            let folder = folder(name, made, &load_of(k), &identify_keys(made));
            let job = run(&folder).unwrap();
            let [length, mass, time] = made;
            let stress = mass / (length * time * time);
            let found: Vec<c64> = job
                .run
                .found
                .lines
                .iter()
                .map(|o| o.factor().unwrap_or_else(|| panic!("{name}, {k}: {o:?}")) * stress)
                .collect();
            assert_eq!(found.len(), 30);
            for (e, o) in found.iter().zip(&job.run.found.lines) {
                // Data are exact; the answer is asked to 1e-6.
                assert!((e - TRUTH).norm() < 1e-6 * TRUTH.norm(), "{name}: {e} at {} Hz", o.frequency_hz);
            }
            // The same problem but for rounding of numbers that have other last digits.
            let first = first.get_or_insert_with(|| found.clone());
            for (e, other) in found.iter().zip(&*first) {
                assert!((e - other).norm() < 1e-9 * other.norm(), "{name}: {e} for {other}");
            }
            let findings = job.summary["findings"].as_array().unwrap();
            assert!(findings.is_empty(), "{name}: {findings:?}");
        }
    }
}

#[test]
fn responses_are_in_si_units_in_every_system() {
    for k in 0..LOADS.len() {
        let mut first: Option<Vec<f64>> = None;
        for (name, made) in SYSTEMS {
            let folder = folder(name, made, &load_of(k), "[respond]\nband_hz = [20.0, 600.0]\npoints = 30\n");
            let out = folder.path().join("out");
            let case = folder.path().join("case.toml");
            let (_, run) = respond_case(&case, &Overrides::default(), None, Some(&out), &|_, _| {}).unwrap();
            let table = fs::read_to_string(out.join("response.csv")).unwrap();
            let rows = table.lines().skip(1).flat_map(|line| line.rsplit(',').take(2).map(str::to_owned));
            let found: Vec<f64> = rows.map(|cell| cell.parse().unwrap()).collect();
            assert_eq!((run.receptance.len(), found.len()), (30, 120));
            let first = first.get_or_insert_with(|| found.clone());
            for (a, b) in found.chunks(2).zip(first.chunks(2)) {
                let (a, b) = (c64::new(a[1], a[0]), c64::new(b[1], b[0]));
                assert!((a - b).norm() < 1e-9 * b.norm(), "{name}: {a} for {b}");
            }
        }
    }
}

/// A load that is spread is in N and N·m.
#[test]
fn a_file_of_a_load_is_in_si_units() {
    let beam = beam();
    let rows = [row(&beam, 9, Direction::Z), row(&beam, 9, Direction::RY)];
    let text = format!("row,re,im\n{},0.4,0\n{},0.02,0\n", rows[0] + 1, rows[1] + 1);
    let mut first: Option<Vec<c64>> = None;
    for (name, made) in SYSTEMS {
        let keys = "[respond]\nband_hz = [100.0, 100.0]\npoints = 1\n";
        let folder = folder(name, made, "file = \"force.csv\"", keys);
        fs::write(folder.path().join("force.csv"), &text).unwrap();
        let out = folder.path().join("out");
        let case = folder.path().join("case.toml");
        let (_, run) = respond_case(&case, &Overrides::default(), None, Some(&out), &|_, _| {}).unwrap();
        let found = run.receptance[0].clone().unwrap();
        let first = first.get_or_insert_with(|| found.clone());
        for (a, b) in found.iter().zip(&*first) {
            assert!((a - b).norm() < 1e-9 * b.norm(), "{name}: {a} for {b}");
        }
    }
}

/// Numbers of the large fields of a bulk entry.
fn card(deck: &str, name: &str) -> Vec<f64> {
    let line = deck.lines().find(|line| line.starts_with(name)).unwrap();
    let field = |k: usize| line.get(8 + 16 * k..24 + 16 * k).unwrap_or("").trim().to_owned();
    let number = |text: String| match text.get(1..).and_then(|rest| rest.rfind(['+', '-'])) {
        Some(at) if !text.contains('E') => format!("{}e{}", &text[..=at], &text[at + 1..]).parse().ok(),
        _ => text.parse().ok(),
    };
    (0..4).map(|k| number(field(k)).unwrap_or(f64::NAN)).collect()
}

fn to_nastran() -> ExportOptions {
    ExportOptions {
        target: Target::Nastran,
        units: None,
        poisson: Some(0.38),
        density: Some(DENSITY),
        modulus: None,
        id: 3,
        name: "BEAM".into(),
        all: false,
        unknown: None,
    }
}

#[test]
fn the_deck_has_the_units_of_the_case() {
    let made = SYSTEMS[1].1;
    let keys = identify_keys(made) + "varies = \"law\"\nlaw = \"constant\"\n";
    let folder = folder("mm-t-s", made, &load_of(0), &keys.replace("reduction = \"full\"\n", ""));
    run(&folder).unwrap();
    let out = folder.path().join("out");
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["units"]["system"], "mm-t-s");
    assert_eq!(summary["units"]["modulus"], "MPa");
    assert_eq!(summary["factor_unit"], "MPa");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let tile = page.find("Storage modulus E′ at").map(|at| page[at..].chars().take(300).collect::<String>());
    let tile = tile.expect("a tile with the modulus");
    assert!(tile.contains("1900\u{a0}MPa"), "{tile}");
    let figure = fs::read_to_string(out.join("figures/modulus.svg")).unwrap();
    assert!(figure.contains("MPa") && !figure.contains("(Pa)"));
    let law = out.join("law.json");
    let storage = TRUTH.re / 1e6;
    for law in [None, Some(law.as_path())] {
        let done = export(&out.join("identified.csv"), law, &to_nastran(), &mut Reads::default()).unwrap();
        assert_eq!(done.units, UnitSystem::MillimetreTonne);
        assert!(done.text.contains("units mm-t-s: E in MPa, density in t/mm^3"), "{}", done.text);
        let mat1 = card(&done.text, "MAT1*");
        // The reference of a deck has six digits.
        assert!((mat1[1] / storage - 1.0).abs() < 1e-5, "{mat1:?}");
        let si = ExportOptions { units: Some(UnitSystem::Si), ..to_nastran() };
        let mat1 = card(
            &export(&out.join("identified.csv"), law, &si, &mut Reads::default()).unwrap().text,
            "MAT1*",
        );
        assert!((mat1[1] / TRUTH.re - 1.0).abs() < 1e-5, "{mat1:?}");
    }
    // A law that is fitted to the table afterwards knows them too, and so does the table that is exported.
    let fit = fit_table(&out.join("identified.csv"), None, &[frfit::laws::LawKind::Constant], None).unwrap();
    assert_eq!(fit.summary["laws"][0]["parameters"]["storage"]["unit"], "MPa");
    let csv = export(
        &out.join("identified.csv"),
        None,
        &ExportOptions { target: Target::Csv, ..to_nastran() },
        &mut Reads::default(),
    );
    let csv = csv.unwrap().text;
    assert_eq!(csv.lines().nth(1).unwrap().split(',').nth(1), Some("MPa"));
    let path = folder.path().join("identified.csv");
    fs::write(&path, csv).unwrap();
    let mat1 = card(&export(&path, None, &to_nastran(), &mut Reads::default()).unwrap().text, "MAT1*");
    assert!(
        (mat1[1] / TRUTH.re - 1.0).abs() < 1e-5,
        "a table elsewhere that names MPa is read, and SI written: {mat1:?}"
    );
}

#[test]
fn a_relative_factor_has_no_unit_and_makes_no_deck_alone() {
    let made = SYSTEMS[1].1;
    let folder = folder("mm-t-s", made, &load_of(0), &identify_keys(made));
    let case = folder.path().join("case.toml");
    let text = fs::read_to_string(&case).unwrap();
    fs::write(&case, text.replace("factor_is = \"modulus\"", "factor_is = \"relative\"")).unwrap();
    let job = run(&folder).unwrap();
    assert_eq!(job.summary["factor_unit"], "1");
    let out = folder.path().join("out");
    let figure = fs::read_to_string(out.join("figures/modulus.svg")).unwrap();
    assert!(!figure.contains("Pa)"), "no unit of stress");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("relative to the matrix") && !page.contains("\u{a0}MPa"));
    let error = export(&out.join("identified.csv"), None, &to_nastran(), &mut Reads::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("--modulus") && error.contains("found factors without a unit"), "{error}");
    let plain = ExportOptions { target: Target::Csv, ..to_nastran() };
    let csv = export(&out.join("identified.csv"), None, &plain, &mut Reads::default()).unwrap().text;
    let first: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    let storage = job.run.found.lines[0].factor().unwrap().re;
    assert_eq!((first[0], first[1].parse::<f64>().unwrap()), ("20.0", storage));
    let made_with = ExportOptions { modulus: Some(1e6), ..to_nastran() };
    let mat1 = card(
        &export(&out.join("identified.csv"), None, &made_with, &mut Reads::default()).unwrap().text,
        "MAT1*",
    );
    assert!((mat1[1] / (TRUTH.re / 1e6) - 1.0).abs() < 1e-5, "{mat1:?}");
}

/// One value for the band, its bounds in the unit of the case.
#[test]
fn several_unknowns_are_in_the_units_of_the_case() {
    let made = SYSTEMS[1].1;
    let keys = "[identify]\nmatrix = \"beam\"\nband_hz = [20.0, 600.0]\nvaries = \"constant\"\nbounds = { storage = [5e2, 8e3], loss_factor = [0.0, 0.5] }\n";
    let folder = folder("mm-t-s", made, &load_of(0), keys);
    let out = folder.path().join("out");
    let case = folder.path().join("case.toml");
    let job = identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {}).unwrap();
    assert_eq!(job.summary["unknowns"][0]["unit"], "MPa");
    let storage = job.run.found.constants[0].numbers[0].value;
    assert!((storage / (TRUTH.re / 1e6) - 1.0).abs() < 1e-6, "{storage}");
}

/// A model in mm-t-s whose case does not say so: the diagnostics finds a factor of a thousandth, and the key. At translations m-t-s
/// makes the same factor.
#[test]
fn a_model_in_other_units_than_the_case_says_is_found() {
    let made = SYSTEMS[1].1;
    let folder = folder("mm-t-s", made, &load_of(0), &identify_keys(made));
    let case = folder.path().join("case.toml");
    let text = fs::read_to_string(&case).unwrap();
    // What is attached in numbers of mm-t-s, as the matrices are; and one sensor, which is no rotation.
    let attached = "[[attached]]\ndof = \"11+Z\"\nmass = 1.2e-5\nstiffness = 1.2\ndamping = 3e-4\n\
                    [[attached]]\ndof = \"11+RY\"\nstiffness = 800.0\n";
    let at = |part: &str| text.find(part).unwrap();
    let (first, measured) = (at("[[attached]]"), at("[[measurement]]\nfile = \"0.csv\""));
    let (second, identify) = (at("[[measurement]]\nfile = \"1.csv\""), at("[identify]"));
    let text = format!("{}{attached}{}{}", &text[..first], &text[measured..second], &text[identify..]);
    let agreed = check_text(&check_case(&case, &Overrides::default(), None).unwrap());
    assert!(agreed.all.contains("no finding"), "{}", agreed.all);
    let without = text.replace("units = \"mm-t-s\"\n", "");
    fs::write(&case, &without).unwrap();
    let job = check_case(&case, &Overrides::default(), None).unwrap();
    let said = check_text(&job);
    assert!(said.all.contains("units = \"mm-t-s\" or \"m-t-s\" of the case (now \"SI\")"), "{}", said.all);
}

fn refusal(keys: &str, case: impl Fn(&str) -> String) -> String {
    let made = SYSTEMS[1].1;
    let folder = folder("mm-t-s", made, &load_of(0), &(identify_keys(made) + keys));
    let path = folder.path().join("case.toml");
    fs::write(&path, case(&fs::read_to_string(&path).unwrap())).unwrap();
    let message = run(&folder).expect_err("a refusal").to_string();
    message.replace(&format!("{}", folder.path().join(Path::new("")).display()), "")
}

#[test]
fn units_that_are_not_known_are_refused() {
    let said = refusal("", |text| text.replace("units = \"mm-t-s\"", "units = \"mm-T-s\""));
    let message = "case.toml:2:1: units: expected \"m-kg-s\", \"SI\", \"mm-t-s\", \"mm-kg-ms\", \"mm-g-ms\", \"mm-kg-s\", \"m-t-s\", \
                   \"cm-g-s\", \"in-lbf-s\" or \"ft-lbf-s\", found \"mm-T-s\"; did you mean \"mm-t-s\"?";
    assert_eq!(said, message);
    for (keys, message) in [
        (
            "[[attached]]\ndof = \"7+RY\"\nstiffness = \"3 N/mm\"\n",
            "attached.stiffness: expected a unit as that of N/m, of a rotation N m/rad, found the unit of a translation",
        ),
        (
            "[[attached]]\ndof = \"7+Z\"\ndamping = \"3 N m s\"\n",
            "attached.damping: expected a unit as that of N s/m, of a rotation N m s/rad, found the unit of a rotation",
        ),
        (
            "[[attached]]\ndof = \"7+Z\"\nmass = \"3 gr\"\n",
            "attached.mass: expected a mass above 0: a number in the units of the case, or a text as \"12 g\", found the unknown unit \"gr\"; did you mean \"g\"?",
        ),
        (
            "[[attached]]\ndof = \"7+Z\"\nmass = \"-3 g\"\n",
            "attached.mass: expected a mass above 0: a number in the units of the case, or a text as \"12 g\", found the text \"-3 g\"",
        ),
        (
            "[[attached]]\ndof = \"7+Z\"\nmass = 1\nmass_kg = 1\n",
            "attached.mass_kg: expected one of mass and mass_kg, found both",
        ),
    ] {
        let said = refusal(keys, str::to_owned);
        assert!(said.ends_with(message), "{said}");
    }
    let said =
        refusal("", |text| text.replace("file = \"M.mtx\"", "file = \"M.mtx\"\nfactor_is = \"relative\""));
    assert!(
        said.ends_with(
            "matrix.factor_is: expected the factor of a stiffness, found that of a mass or a damping"
        ),
        "{said}"
    );
}
