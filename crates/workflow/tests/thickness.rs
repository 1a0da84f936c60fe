//! A solid block whose thickness enters its stiffness as 1/h, 1 and h: three matrices give it at every thickness, and a fourth checks them.

use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::quantity::Quantity;
use frfit::response::{FullModel, Response};
use frfit_fem::brick::{Face, Formulation, Layer};
use frfit_fem::{Assembled, Brick, Direction};
use frfit_linalg::sparse::SymmetricMatrix;
use frfit_workflow::job::{identify_case, respond_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

/// Storage modulus in Pa, loss factor, and density in kg/m³: known.
const MODULUS: c64 = c64::new(3.2e9, 0.02 * 3.2e9);
const DENSITY: f64 = 1200.0;

/// Thickness in m: the one that is looked for, and those at which there are matrices.
const TRUTH: f64 = 0.0217;
const VALUES: [f64; 4] = [0.016, 0.018, 0.021, 0.025];

/// A block on its wall, its nodes in the direction of the thickness moving with it.
fn block(thickness: f64) -> Assembled {
    let brick = Brick {
        length: 0.12,
        width: 0.03,
        elements: [6, 2],
        layers: vec![Layer { thickness, elements: 2, poisson: 0.36, material: 0 }],
        clamped: vec![Face::XMin],
        formulation: Formulation::Standard,
        ..Brick::default()
    };
    brick.assemble().unwrap()
}

fn mtx(matrix: &SymmetricMatrix) -> String {
    let dim = matrix.dim();
    let (mut entries, mut count) = (String::new(), 0);
    for ((i, j), value) in matrix.pattern().positions().zip(matrix.real_values().unwrap()) {
        writeln!(entries, "{} {} {value:e}", i + 1, j + 1).unwrap();
        count += 1;
    }
    format!("%%MatrixMarket matrix coordinate real symmetric\n{dim} {dim} {count}\n{entries}")
}

/// Driven row and sensors' rows (from 0), off the block's plane of symmetry.
fn rows() -> (usize, [usize; 2]) {
    let block = block(1.0);
    let at =
        |x: f64, y: f64, z: f64, direction| block.row(block.nearest([x, y, z]).unwrap(), direction).unwrap();
    (at(0.12, 0.0, 1.0, Direction::Z), [at(0.12, 0.03, 1.0, Direction::Z), at(0.06, 0.0, 0.0, Direction::Y)])
}

/// Receptance of the block that was assembled with this thickness.
fn receptance(thickness: f64, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    let block = block(thickness);
    let term = |name: &str, role, matrix: &SymmetricMatrix, factor| Term {
        name: name.into(),
        role,
        matrix: matrix.clone(),
        factor: Law::Constant(factor),
    };
    let model = DynamicStiffness::new(vec![
        term("K", Role::Stiffness, &block.stiffness[0], MODULUS),
        term("M", Role::Mass, &block.mass[0], c64::new(DENSITY, 0.0)),
    ])
    .unwrap();
    let (driven, sensors) = rows();
    let sensor = |row| Sensor { row, sign: 1.0 };
    let experiment = Experiment::driven_at(model.dim(), sensor(driven), sensors.map(sensor).to_vec());
    let at = |&f: &f64| FullModel::new(model.at(f, &[]).unwrap(), &experiment).unwrap();
    frequency_hz.iter().map(|f| at(f).respond_nominal().unwrap()).collect()
}

/// Matrices at the values, the measurement of the true block, and a case whose stiffness has these `powers` and `values`.
fn folder(powers: &str, values: &[f64], keys: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    for (k, &value) in VALUES.iter().enumerate() {
        let block = block(value);
        write(&format!("k{k}.mtx"), &mtx(&block.stiffness[0]));
        write(&format!("m{k}.mtx"), &mtx(&block.mass[0]));
    }
    let frequency_hz = linear_hz(100.0, 4000.0, 40);
    let exact = receptance(TRUTH, &frequency_hz);
    for m in 0..2 {
        let mut text = "frequency_hz,re,im\n".to_owned();
        for (&f, x) in frequency_hz.iter().zip(&exact) {
            let value = Quantity::Accelerance.from_receptance(f, x[m]);
            writeln!(text, "{f:e},{:e},{:e}", value.re, value.im).unwrap();
        }
        write(&format!("{m}.csv"), &text);
    }
    let (driven, sensors) = rows();
    let files = |kind: &str, count: usize| {
        (0..count).map(|k| format!("\"{kind}{}.mtx\"", k % VALUES.len())).collect::<Vec<_>>().join(", ")
    };
    let case = format!(
        "[[matrix]]\nname = \"block\"\nrole = \"stiffness\"\n\
         at = {{ dimension = \"thickness\", {powers}values = {values:?}, files = [{}] }}\n\
         factor = {{ storage = {:e}, loss_factor = {:e} }}\n\
         [[matrix]]\nname = \"mass\"\nrole = \"mass\"\n\
         at = {{ dimension = \"thickness\", powers = [1], values = {:?}, files = [{}] }}\nfactor = {DENSITY}\n\
         [load]\nrow = {}\n\
         [[measurement]]\nfile = \"0.csv\"\nrow = {}\nquantity = \"accelerance\"\n\
         [[measurement]]\nfile = \"1.csv\"\nrow = {}\nquantity = \"accelerance\"\n{keys}",
        files("k", values.len()),
        MODULUS.re,
        MODULUS.im / MODULUS.re,
        &VALUES[..2],
        files("m", 2),
        driven + 1,
        sensors[0] + 1,
        sensors[1] + 1,
    );
    write("case.toml", &case);
    folder
}

const POWERS: &str = "powers = [-1, 0, 1], ";

fn unknown(nominal: f64) -> String {
    format!(
        "[[identify]]\nname = \"thickness\"\nband_hz = [100.0, 4000.0]\nnominal = {nominal}\nbounds = [0.015, 0.03]\n"
    )
}

#[test]
fn three_matrices_give_a_solid_at_every_thickness() {
    // One between the values, and one beyond them.
    for thickness in [TRUTH, 0.029] {
        let keys = unknown(thickness) + "[respond]\nband_hz = [100.0, 4000.0]\npoints = 40\n";
        let folder = folder(POWERS, &VALUES, &keys);
        let (case, out) = (folder.path().join("case.toml"), folder.path().join("out"));
        let (case, run) = respond_case(&case, &Overrides::default(), None, Some(&out), &|_, _| {}).unwrap();
        let names: Vec<_> = case.model.terms().iter().map(|term| term.name.as_str()).collect();
        assert_eq!(names[..3], ["block (thickness^-1)", "block (thickness^0)", "block (thickness^1)"]);
        assert_eq!(names[3..], ["mass (thickness^1)"]);
        let exact = receptance(thickness, &run.frequency_hz);
        for (found, exact) in run.receptance.iter().zip(&exact) {
            let found = found.as_ref().unwrap();
            let off = found.iter().zip(exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            let size = exact.iter().map(|x| x.norm()).fold(0.0, f64::max);
            // Rounding of the matrices, amplified by resonances.
            assert!(off < 1e-9 * size, "{off:e} of {size:e} at {thickness}");
        }
    }
}

#[test]
fn the_thickness_of_a_solid_is_found() {
    let folder = folder(POWERS, &VALUES, &(unknown(0.019) + &format!("reference = {TRUTH}\n")));
    let (case, out) = (folder.path().join("case.toml"), folder.path().join("out"));
    let job = identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {}).unwrap();
    let found = job.run.found.constants[0].numbers[0].value;
    // Exact data, and answers that are asked to 1e-6.
    assert!((found / TRUTH - 1.0).abs() < 1e-6, "{found}\n{:#}", job.summary);
}

fn refusal(powers: &str, values: &[f64]) -> String {
    let folder = folder(powers, values, &unknown(0.02));
    let (case, out) = (folder.path().join("case.toml"), folder.path().join("out"));
    let error =
        identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {}).unwrap_err();
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn powers_that_are_not_those_of_the_matrix_are_refused() {
    let said = refusal("powers = [0, 1, 2], ", &VALUES);
    assert!(said.starts_with("case.toml:4:33: matrix.at.powers: expected a matrix with the powers 0, 1, 2 of thickness through the other values"), "{said}");
    assert!(said.contains("of its largest entry beside it at 0.021"), "{said}");
    // Without powers the same matrices need a polynomial of more terms than there are values.
    let said = refusal("", &VALUES);
    assert!(
        said.contains("a polynomial of degree 2 in thickness") && said.contains("or its powers"),
        "{said}"
    );
}

#[test]
fn powers_and_values_that_do_not_fit_are_refused() {
    for (powers, values, message) in [
        (
            "powers = [-1, 0], ",
            &VALUES[..],
            "matrix.at.values: expected 3 values: one for each of 2 powers, and one that checks them, found 4",
        ),
        (
            "powers = [-1, 0, -1], ",
            &VALUES,
            "matrix.at.powers: expected a list of 1 to 9 whole numbers, each once, found the list [-1, 0, -1]",
        ),
        (
            "powers = [], ",
            &VALUES,
            "matrix.at.powers: expected a list of 1 to 9 whole numbers, each once, found the list []",
        ),
        (
            "powers = [-1, 0, 13], ",
            &VALUES,
            "matrix.at.powers: expected a whole number from -12 to 12, found 13",
        ),
        ("powers = [-1, 0, 0.5], ", &VALUES, "matrix.at.powers: expected a whole number, found 0.5"),
        (
            POWERS,
            &[0.016, -0.018, 0.021, 0.025],
            "matrix.at.values: expected values above 0, each once, found -0.018",
        ),
        (
            POWERS,
            &[0.016, 0.021, 0.021, 0.025],
            "matrix.at.values: expected values above 0, each once, found 0.021",
        ),
        (
            POWERS,
            &[0.016, 0.016_000_000_1, 0.016_000_000_2, 0.016_000_000_3],
            "matrix.at.powers: expected values of thickness far enough apart for its powers -1, 0, 1, found 0.016, 0.0160000001, 0.0160000003, 0.0160000002",
        ),
    ] {
        let said = refusal(powers, values);
        assert!(said.ends_with(message), "{said}");
    }
}
