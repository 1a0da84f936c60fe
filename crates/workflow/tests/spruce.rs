//! Free plates of spruce: four orthotropic constants from five hammer impacts and one accelerometer, against published moduli.
//!
//! The plates are those of D. G. Badiane and others, J. Acoust. Soc. Am. 154 (2023) 730–738, whose moduli come from another method (networks and another
//! finite element code). Units and sense of the acceleration are not stated: g, and reversed, with an unknown scale.

use crate::shared_data::shared;
use crate::tier::of_tier;

use flate2::read::GzDecoder;
use frfit::diagnostics::{Fault, KnownFactor};
use frfit::signal::Options;
use frfit_formats::{CoordinateMatrix, Entries, Symmetry, matrix_market};
use frfit_workflow::check::check_case;
use frfit_workflow::job::{frf_of_records, identify_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::records::ChannelOptions;
use frfit_workflow::run::RunOptions;
use std::fmt::Write;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

type Square = Vec<Vec<f64>>;

/// Square matrices in one direction, of the cubic Hermite functions of values and slopes at all nodes: ∫ N″N″ᵀ, ∫ N′N′ᵀ, ∫ NNᵀ and ∫ NN″ᵀ.
struct Hermite {
    bends: Square,
    slopes: Square,
    values: Square,
    value_bend: Square,
}

/// Gauss points and weights on (0, 1): exact up to the seventh power.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Hermite {
    fn new(nodes: &[f64]) -> Self {
        let n = 2 * nodes.len();
        let zero = || vec![vec![0.0; n]; n];
        let mut all = Self { bends: zero(), slopes: zero(), values: zero(), value_bend: zero() };
        for (e, pair) in nodes.windows(2).enumerate() {
            let h = pair[1] - pair[0];
            for (s, weight) in GAUSS {
                let (s2, s3) = (s * s, s * s * s);
                let value =
                    [1.0 - 3.0 * s2 + 2.0 * s3, h * (s - 2.0 * s2 + s3), 3.0 * s2 - 2.0 * s3, h * (s3 - s2)];
                let slope =
                    [6.0 * (s2 - s) / h, 1.0 - 4.0 * s + 3.0 * s2, 6.0 * (s - s2) / h, 3.0 * s2 - 2.0 * s];
                let bend = [
                    (12.0 * s - 6.0) / (h * h),
                    (6.0 * s - 4.0) / h,
                    (6.0 - 12.0 * s) / (h * h),
                    (6.0 * s - 2.0) / h,
                ];
                for i in 0..4 {
                    for j in 0..4 {
                        let (row, column) = (2 * e + i, 2 * e + j);
                        all.bends[row][column] += weight * h * bend[i] * bend[j];
                        all.slopes[row][column] += weight * h * slope[i] * slope[j];
                        all.values[row][column] += weight * h * value[i] * value[j];
                        all.value_bend[row][column] += weight * h * value[i] * bend[j];
                    }
                }
            }
        }
        all
    }
}

/// Σ A ⊗ B with its factor, as a file.
fn kronecker(sum: &[[&Square; 2]], factor: f64) -> Vec<u8> {
    let [n, m] = sum[0].map(Vec::len);
    let (mut rows, mut cols, mut entries) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column) in (0..n * m).flat_map(|column| (column..n * m).map(move |row| (row, column))) {
        let of = |[a, b]: &[&Square; 2]| a[row / m][column / m] * b[row % m][column % m];
        let entry = factor * sum.iter().map(of).sum::<f64>();
        if entry != 0.0 {
            rows.push(row);
            cols.push(column);
            entries.push(entry);
        }
    }
    let (nrows, ncols, symmetry) = (n * m, n * m, Symmetry::Symmetric);
    let entries = Entries::Real(entries);
    let matrix = CoordinateMatrix { nrows, ncols, symmetry, rows, cols, entries, title: "plate".into() };
    matrix_market::write(&matrix).unwrap()
}

fn transposed(matrix: &Square) -> Square {
    (0..matrix.len()).map(|j| matrix.iter().map(|row| row[j]).collect()).collect()
}

/// A row of the table of plates: length, width, thickness, mass, then E_L, E_R and G_LR with their standard deviations, in SI units.
struct Plate {
    size: [f64; 3],
    mass: f64,
    published: [(f64, f64); 3],
}

impl Plate {
    fn new(name: &str) -> Self {
        let table = fs::read_to_string(shared("spruce/plates.csv")).unwrap();
        let row = table.lines().find(|line| line.split(',').next() == Some(name)).unwrap();
        let of: Vec<f64> = row.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        let modulus = |k: usize| (1e9 * of[k], 1e9 * of[k] * of[k + 1] / 100.0);
        Self {
            size: [of[0], of[1], of[2]].map(|mm| 1e-3 * mm),
            mass: 1e-3 * of[3],
            published: [4, 6, 8].map(modulus),
        }
    }
}

/// Nodes with one at 20 mm from either end, where the plates are hit and measured.
fn nodes(length: f64, elements: usize) -> Vec<f64> {
    const INSET: f64 = 0.02;
    let inner = |k: usize| INSET + (length - 2.0 * INSET) * k as f64 / elements as f64;
    std::iter::once(0.0).chain((0..=elements).map(inner)).chain([length]).collect()
}

/// How fine the plate is, the highest frequency in Hz, and the most lines: the lowest five elastic modes, or eighteen.
fn size_of_tier() -> ([usize; 2], f64, usize) {
    of_tier(([6, 3], 220.0, 24), ([14, 6], 700.0, 400))
}

/// The case of a plate in a folder, with the FRF of its impacts, the acceleration in a unit as the records are said to have it, and a line of the measurement.
fn case_of(name: &str, plate: &Plate, folder: &Path, unit: &str, measurement: &str) -> PathBuf {
    let path = |name: &str| folder.join(name);
    let [length, width, thickness] = plate.size;
    let ([along, across], last, lines) = size_of_tier();
    let (xs, ys) = (nodes(length, along), nodes(width, across));
    let (x, y) = (Hermite::new(&xs), Hermite::new(&ys));
    let inertia = thickness.powi(3) / 12.0;
    let of = |matrix: &str| match matrix {
        "D11" => kronecker(&[[&x.bends, &y.values]], inertia),
        "D22" => kronecker(&[[&x.values, &y.bends]], inertia),
        "D66" => kronecker(&[[&x.slopes, &y.slopes]], 4.0 * inertia),
        "D12" => {
            let [bend_value_x, bend_value_y] = [&x.value_bend, &y.value_bend].map(transposed);
            kronecker(&[[&bend_value_x, &y.value_bend], [&x.value_bend, &bend_value_y]], inertia)
        }
        _ => kronecker(&[[&x.values, &y.values]], plate.mass / (length * width)),
    };
    let mut case = String::from("title = \"Spruce\"\n");
    let unknowns = [
        ("D11", 1.05e10, [4e9, 2.5e10]),
        ("D22", 9e8, [3e8, 3e9]),
        ("D66", 7e8, [2e8, 2e9]),
        ("D12", 3e8, [3e7, 1.5e9]),
    ];
    for (matrix, nominal, _) in unknowns {
        fs::write(path(matrix), of(matrix)).unwrap();
        write!(case, "[[matrix]]\nname = \"{matrix}\"\nrole = \"stiffness\"\nfile = \"{matrix}\"\nfactor = {{ storage = {nominal:e}, loss_factor = 0.015 }}\n").unwrap();
    }
    fs::write(path("M"), of("M")).unwrap();
    // The node at 20 mm from both edges of a corner, and of the opposite one: rows of their values, from 1.
    let row = |i: usize, j: usize| 1 + 2 * i * 2 * ys.len() + 2 * j;
    let (hit, sensor) = (row(1, 1), row(xs.len() - 2, ys.len() - 2));
    write!(
        case,
        "[[matrix]]\nname = \"mass\"\nrole = \"mass\"\nfile = \"M\"\n[load]\nrow = {hit}\n\
         [[measurement]]\nfile = \"frf.uff\"\nrow = {sensor}\nquantity = \"accelerance\"\n{measurement}\n"
    )
    .unwrap();
    for (matrix, _, [low, high]) in unknowns {
        write!(case, "[[identify]]\nmatrix = \"{matrix}\"\nvaries = \"constant\"\nbounds = {{ storage = [{low:e}, {high:e}], loss_factor = [0.0, 0.1] }}\n").unwrap();
        if matrix == "D11" {
            write!(case, "band_hz = [35.0, {last:?}]\nmax_lines = {lines}\n").unwrap();
        }
    }
    fs::write(path("case.toml"), case).unwrap();
    let impact = |k: usize| -> PathBuf {
        let packed = File::open(shared(&format!("spruce/plate_{name}_hit_{k}.csv.gz"))).unwrap();
        let mut text = String::new();
        GzDecoder::new(packed).read_to_string(&mut text).unwrap();
        let mut table = format!("time_s,Force (N),Acceleration ({unit})\n");
        for (k, line) in text.lines().skip(1).enumerate() {
            writeln!(table, "{:.9},{line}", k as f64 / 48_000.0).unwrap();
        }
        let file = path(&format!("{k}.csv"));
        fs::write(&file, table).unwrap();
        file
    };
    let impacts: Vec<PathBuf> = (1..=5).map(impact).collect();
    frf_of_records(&impacts, &ChannelOptions::default(), &Options::default(), &path("frf.uff"), None)
        .unwrap();
    path("case.toml")
}

/// E_L, E_R and G_LR, each with its standard deviation, and the verdict.
fn identified(name: &str, plate: &Plate) -> ([(f64, f64); 3], String) {
    let folder = tempfile::tempdir().unwrap();
    let case = case_of(name, plate, folder.path(), "g", "scale = \"unknown\"");
    let out = folder.path().join("out");
    let job = identify_case(&case, &Overrides::default(), RunOptions::default(), &out, &|_, _| {}).unwrap();
    let number = |k: usize| {
        let number = &job.run.found.constants[k].numbers[0];
        (number.value, number.std.unwrap())
    };
    let [d11, d22, d66, d12] = [0, 1, 2, 3].map(number);
    // D₁₁ = E_L/(1 − ν_LR ν_RL).
    let share = 1.0 - d12.0 * d12.0 / (d11.0 * d22.0);
    let moduli = [(d11.0 * share, d11.1 * share), (d22.0 * share, d22.1 * share), d66];
    (moduli, job.run.found.fit.unwrap().verdict.name().to_owned())
}

/// Of plates whose frequencies agree with their published moduli and sizes these are found from the impacts alone, with bars that say how far they can be trusted: natural
/// frequencies of model and measurement are some tenths of a per cent apart, shapes near the corners a sixth, and some per cent of the response are left between resonances.
#[test]
#[ignore = "needs the data of ../shared/data"]
fn four_constants_of_wooden_plates_are_the_published_ones_needs_data() {
    for name in of_tier(&["2L"][..], &["1L", "2L", "4L", "5L"][..]) {
        let plate = Plate::new(name);
        let (found, verdict) = identified(name, &plate);
        for ((value, std), (published, of_published)) in found.into_iter().zip(plate.published) {
            let at =
                format!("{name}: {value:.3e} ± {std:.1e}, published {published:.3e} ± {of_published:.1e}");
            assert!((value - published).abs() < 2.0 * std.hypot(of_published), "{at}");
            assert!((0.003..0.13).contains(&(std / value)), "{at}");
        }
        assert_eq!(verdict, "nearly explained", "{name}");
    }
}

/// The records say neither unit nor sense of the acceleration. Taken for m/s² and in the sense of the force, both faults are named beside four constants that are 10 to 30 % off, and
/// without the unit's the sign alone.
#[test]
#[ignore = "needs the data of ../shared/data"]
fn unit_and_sign_of_wooden_plates_are_named_needs_data() {
    for name in of_tier(&["2L"][..], &["1L", "2L", "3L", "4L", "5L"][..]) {
        let plate = Plate::new(name);
        for (unit, expected) in [("m/s^2", 2), ("g", 1)] {
            let folder = tempfile::tempdir().unwrap();
            let case = case_of(name, &plate, folder.path(), unit, "");
            let found = check_case(&case, &Overrides::default(), None).unwrap().diagnosis.findings;
            let is_sign = |fault: &Fault| *fault == Fault::Sign;
            let is_gravity = |fault: &Fault| {
                matches!(fault, Fault::Factor { known: Some(KnownFactor::PerStandardGravity), .. })
            };
            let count = |is: &dyn Fn(&Fault) -> bool| found.iter().filter(|one| is(&one.fault)).count();
            assert_eq!(found.len(), expected, "{name}, {unit}: {found:?}");
            assert_eq!([count(&is_sign), count(&is_gravity)], [1, expected - 1], "{name}, {unit}: {found:?}");
            let margin = found[0].evidence.unwrap().margin;
            assert!(margin.is_none_or(|margin| margin > 30.0), "{name}, {unit}: {found:?}");
        }
    }
}
