//! Conversions there and back.

use crate::shared_data;

use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::{CoordinateMatrix, Entries, csv, op4, read_matrices, read_matrix, uff};
use frfit_workflow::Reads;
use frfit_workflow::convert::{ConvertOptions, convert};
use frfit_workflow::load::{Choice, load_frf, read_frf};
use insta::assert_snapshot;
use proptest::prelude::*;
use shared_data::shared;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder in which files are converted.
struct Folder(TempDir);

impl Folder {
    fn with(name: &str, content: impl AsRef<[u8]>) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path(name), content).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Converts, writes and gives the bytes.
    fn convert(&self, from: &str, to: &str, options: &ConvertOptions) -> Vec<u8> {
        let bytes = convert(&self.path(from), &self.path(to), options, &mut Reads::default()).unwrap();
        fs::write(self.path(to), &bytes).unwrap();
        bytes
    }

    fn refused(&self, from: &str, to: &str, options: &ConvertOptions) -> String {
        let error = convert(&self.path(from), &self.path(to), options, &mut Reads::default())
            .unwrap_err()
            .to_string();
        error.replace(&format!("{}/", self.0.path().display()), "")
    }
}

const PLAIN: ConvertOptions = ConvertOptions {
    name: None,
    records: Vec::new(),
    columns: None,
    quantity: None,
    response: None,
    reference: None,
    to: None,
    binary: false,
};

fn of_table(binary: bool) -> ConvertOptions {
    ConvertOptions {
        quantity: Some(Quantity::Accelerance),
        response: Some("34-Z".parse().unwrap()),
        reference: Some("1+RX".parse().unwrap()),
        binary,
        ..PLAIN
    }
}

const MATRIX: &str = "%%MatrixMarket matrix coordinate real symmetric\n% springs\n2 2 3\n1 1 0.1\n2 1 -3e-7\n2 2 12345678.901234567\n";
const TABLE: &str = "frequency_hz,re,im,coherence\n10.0,0.1,-3e-7,0.9\n10.5,1e-12,2.5,1.0\n11.0,-7.0,0.3333333333333333,0.0\n";

#[test]
fn matrices_keep_every_bit() {
    let folder = Folder::with("K.mtx", MATRIX);
    folder.convert("K.mtx", "K.rsa", &PLAIN);
    let back = folder.convert("K.rsa", "back.mm", &PLAIN);
    assert_eq!(read_matrix(&back), read_matrix(MATRIX.as_bytes()));
    assert_eq!(folder.convert("K.mtx", "K.HB", &PLAIN), folder.convert("K.mtx", "K.RSA", &PLAIN));
}

#[test]
fn matrices_go_to_nastran_and_back_one_by_one() {
    let folder = Folder::with("K_skins.mtx", MATRIX);
    let op4 = folder.convert("K_skins.mtx", "model.op4", &PLAIN);
    assert_eq!(read_matrices(&op4).unwrap()[0].name, "KSKINS");
    let title = |bytes: &[u8]| CoordinateMatrix { title: String::new(), ..read_matrix(bytes).unwrap() };
    assert_eq!(title(&folder.convert("model.op4", "back.mtx", &PLAIN)), title(MATRIX.as_bytes()));

    let k = read_matrix(MATRIX.as_bytes()).unwrap();
    let m = CoordinateMatrix { entries: Entries::Real(vec![1.0, 0.5, 1.0]), ..k.clone() };
    fs::write(folder.path("two.op4"), op4::write(&[("K", &k), ("M", &m)]).unwrap()).unwrap();
    let named = |name: &str| ConvertOptions { name: Some(name.into()), ..PLAIN };
    assert_eq!(
        title(&folder.convert("two.op4", "M.rsa", &named("M"))),
        CoordinateMatrix { title: String::new(), ..m }
    );
    assert_eq!(folder.convert("two.op4", "again.op4", &PLAIN), fs::read(folder.path("two.op4")).unwrap());
    let one = folder.convert("two.op4", "one.op4", &named("M"));
    assert_eq!(read_matrices(&one).unwrap().len(), 1);
    assert_snapshot!(folder.refused("two.op4", "K.mtx", &PLAIN), @"two.op4: expected one matrix, or --name, found K (2 x 2), M (2 x 2)");
    assert_snapshot!(folder.refused("two.op4", "C.mtx", &named("C")), @r#"--name: expected one matrix named "C", found K (2 x 2), M (2 x 2)"#);
    assert_snapshot!(folder.refused("two.op4", "K.csv", &PLAIN), @"K.csv: expected an ending to which a Nastran OUTPUT4 file can be converted: .mtx or .mm (Matrix Market), .hb, .rb, .rsa, .rua, .csa, .cua, .psa or another matrix type (Harwell-Boeing), .op4 (Nastran OUTPUT4), .npz (SciPy), .mat (MATLAB), found the ending of an FRF");
    assert_snapshot!(folder.refused("K_skins.mtx", "K.mtx", &named("K")), @"--name: expected no name beside a file that names no matrix, found K");
}

/// Both triangles, every bit; what SciPy makes of them is tried beside the writers.
#[test]
fn matrices_go_to_scipy_and_matlab_and_back() {
    let folder = Folder::with("K_skins.mtx", MATRIX);
    let full = |bytes: &[u8]| {
        let matrix = read_matrix(bytes).unwrap();
        (matrix.rows, matrix.cols, matrix.entries)
    };
    let values = Entries::Real(vec![0.1, -3e-7, -3e-7, 12345678.901234567]);
    let expected = (vec![0, 1, 0, 1], vec![0, 0, 1, 1], values);
    for file in ["K.npz", "K.mat"] {
        assert_eq!(full(&folder.convert("K_skins.mtx", file, &PLAIN)), expected, "{file}");
    }
    assert_eq!(read_matrices(&folder.convert("K_skins.mtx", "K.mat", &PLAIN)).unwrap()[0].name, "K_skins");
    let k = read_matrix(MATRIX.as_bytes()).unwrap();
    fs::write(folder.path("two.op4"), op4::write(&[("K", &k), ("M", &k)]).unwrap()).unwrap();
    assert_eq!(read_matrices(&folder.convert("two.op4", "two.mat", &PLAIN)).unwrap().len(), 2);
    assert_snapshot!(folder.refused("two.op4", "two.npz", &PLAIN), @"two.op4: expected one matrix, or --name, found K (2 x 2), M (2 x 2)");
}

#[test]
fn frfs_are_picked_with_what_belongs_to_them() {
    let folder = Folder::with("frf.csv", TABLE);
    let mut all = Vec::new();
    for dof in ["1+Z", "2+Z", "3+Z"] {
        let options = ConvertOptions { response: Some(dof.parse().unwrap()), ..of_table(true) };
        all.extend(folder.convert("frf.csv", "one.uff", &options));
    }
    fs::write(folder.path("all.uff"), &all).unwrap();
    let picked = |records: Vec<i64>| {
        let options = ConvertOptions { records, binary: true, ..PLAIN };
        let bytes = folder.convert("all.uff", "picked.uff", &options);
        let dofs = |record: i64| {
            let choice = Choice { record: Some(record), ..Choice::default() };
            let frf = read_frf(&bytes, &choice).ok()?;
            assert!(frf.coherence.is_some());
            Some(frf.measured_at?.to_string())
        };
        (1..=3).map_while(dofs).collect::<Vec<_>>()
    };
    assert_eq!(picked(vec![]), ["1+Z", "2+Z", "3+Z"]);
    assert_eq!(picked(vec![3, 1]), ["1+Z", "3+Z"]);
    let beyond = ConvertOptions { records: vec![4], ..PLAIN };
    assert_snapshot!(folder.refused("all.uff", "x.uff", &beyond), @"all.uff: expected --record from 1 to 3, found 4");
}

#[test]
fn columns_of_a_table_are_named_by_option() {
    let folder = Folder::with("analyser.csv", "Hz;dB;deg;n\n10;20;90;1\n20;0;-180,0;2\n");
    let columns = ["frequency_hz", "magnitude_db", "phase_deg", "-"].map(str::to_owned).to_vec();
    let options = ConvertOptions { columns: Some(columns), ..PLAIN };
    let table = folder.convert("analyser.csv", "frf.csv", &options);
    let frf = read_frf(&table, &Choice::default()).unwrap();
    assert_eq!(frf.frequency_hz, [10.0, 20.0]);
    let expected = [frfit::c64::new(0.0, 10.0), frfit::c64::new(-1.0, 0.0)];
    assert!(frf.response.iter().zip(expected).all(|(value, expected)| (value - expected).norm() < 1e-14));
}

#[test]
fn a_table_becomes_a_uff_file_that_says_everything() {
    let folder = Folder::with("frf.csv", TABLE);
    let text = String::from_utf8(folder.convert("frf.csv", "frf.uff", &of_table(false))).unwrap();
    // Fields are filled with blanks up to column 80: the snapshot is without them.
    let shown: Vec<&str> = text.lines().map(str::trim_end).collect();
    assert_snapshot!(shown.join("\n"), @r"
        -1
       164
             1SI: m, N                     1
       1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D+00
       0.0000000000000000D+00
        -1
        -1
        58
    frf.csv
    NONE
    NONE
    NONE
    NONE
        4         0    0         0 NONE              34  -3 NONE               1   4
             6         3         1  1.00000E+01  5.00000E-01  0.00000E+00
            18    0    0    0 Frequency            Hz
            12    0    0    0 accelerance          m/s^2
            13    0    0    0 Force                N
             0    0    0    0 NONE                 NONE
      1.000000000000E-01 -3.000000000000E-07  1.000000000000E-12  2.500000000000E+00
     -7.000000000000E+00  3.333333333333E-01
        -1
        -1
        58
    frf.csv
    NONE
    NONE
    NONE
    NONE
        6         0    0         0 NONE              34  -3 NONE               1   4
             4         3         1  1.00000E+01  5.00000E-01  0.00000E+00
            18    0    0    0 Frequency            Hz
             0    0    0    0 Coherence            NONE
             0    0    0    0 NONE                 NONE
             0    0    0    0 NONE                 NONE
      9.000000000000E-01  1.000000000000E+00  0.000000000000E+00
        -1
    ");
    let frf = load_frf(&folder.path("frf.uff"), &Choice::default()).unwrap();
    assert_eq!(frf.quantity, Some(Quantity::Accelerance));
    assert_eq!(frf.measured_at.map(|dof| dof.to_string()).as_deref(), Some("34-Z"));
    assert_eq!(frf.driven_at.map(|dof| dof.to_string()).as_deref(), Some("1+RX"));
}

#[test]
fn binary_and_back_keeps_every_bit_of_frf_and_coherence() {
    let folder = Folder::with("frf.csv", TABLE);
    folder.convert("frf.csv", "frf.unv", &of_table(true));
    let back = folder.convert("frf.unv", "back.csv", &PLAIN);
    assert_eq!(String::from_utf8(back).unwrap(), TABLE);
    let agreeing = ConvertOptions { quantity: Some(Quantity::Accelerance), ..PLAIN };
    assert_eq!(folder.convert("frf.unv", "back.csv", &agreeing), TABLE.as_bytes());
}

#[test]
fn a_table_is_sorted_and_separated_by_commas() {
    let folder = Folder::with("frf.csv", "im;re;frequency_hz;std\n1;2;20;0.5\n3;4;10;0.25\n");
    let table = String::from_utf8(folder.convert("frf.csv", "sorted.csv", &PLAIN)).unwrap();
    assert_eq!(table, "frequency_hz,re,im,std\n10.0,4.0,3.0,0.25\n20.0,2.0,1.0,0.5\n");
}

#[test]
fn what_is_no_function_is_copied_byte_for_byte() {
    // A dataset of unknown number with a line end of its own, and no line end after the last -1.
    let other = "    -1\r\n  2420\r\n anything\r\n    -1";
    let folder = Folder::with("frf.csv", TABLE);
    let mut file = folder.convert("frf.csv", "frf.uff", &of_table(false));
    file.extend(other.as_bytes());
    fs::write(folder.path("both.uff"), &file).unwrap();
    let binary = folder.convert("both.uff", "binary.uff", &ConvertOptions { binary: true, ..PLAIN });
    assert!(binary.ends_with(format!("{other}\n").as_bytes()));
    assert!(binary.starts_with(&file[..100]), "dataset 164");
    let text = folder.convert("binary.uff", "text.uff", &PLAIN);
    assert_eq!(String::from_utf8(text).unwrap(), format!("{}\n", String::from_utf8(file).unwrap()));
}

#[test]
fn endings_say_what_the_output_is() {
    let folder = Folder::with("K.mtx", MATRIX);
    fs::write(folder.path("frf.csv"), TABLE).unwrap();
    fs::write(folder.path("note.txt"), "Dear reader").unwrap();
    assert_snapshot!(folder.refused("K.mtx", "K.dat", &PLAIN), @"K.dat: expected an ending that names a format: .mtx or .mm (Matrix Market), .hb, .rb, .rsa, .rua, .csa, .cua, .psa or another matrix type (Harwell-Boeing), .op4 (Nastran OUTPUT4), .npz (SciPy), .mat (MATLAB), .uff, .unv or .uf (UFF), .csv (table); or --to with one, for a name without (standard output, a device), found .dat");
    assert_snapshot!(folder.refused("K.mtx", "K", &PLAIN), @"K: expected an ending that names a format: .mtx or .mm (Matrix Market), .hb, .rb, .rsa, .rua, .csa, .cua, .psa or another matrix type (Harwell-Boeing), .op4 (Nastran OUTPUT4), .npz (SciPy), .mat (MATLAB), .uff, .unv or .uf (UFF), .csv (table); or --to with one, for a name without (standard output, a device), found none");
    assert_snapshot!(folder.refused("K.mtx", "K.csv", &PLAIN), @"K.csv: expected an ending to which a Matrix Market file can be converted: .mtx or .mm (Matrix Market), .hb, .rb, .rsa, .rua, .csa, .cua, .psa or another matrix type (Harwell-Boeing), .op4 (Nastran OUTPUT4), .npz (SciPy), .mat (MATLAB), found the ending of an FRF");
    assert_snapshot!(folder.refused("frf.csv", "frf.mtx", &of_table(false)), @"frf.mtx: expected an ending to which a table (CSV) can be converted: .uff, .unv or .uf (UFF), .csv (table), found the ending of a matrix");
    assert_snapshot!(folder.refused("K.mtx", "K.rua", &PLAIN), @"K.rua: expected the ending .rsa of what the matrix is, or .hb, found .rua");
    assert_snapshot!(folder.refused("note.txt", "K.rua", &PLAIN), @"note.txt: expected a UFF file, matrices (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB), a table (CSV), found none of them (no %%MatrixMarket or -1 at the top, no matrix type in line 3, no names of columns)");
}

#[test]
fn an_option_that_is_missing_or_has_no_meaning_is_named() {
    let folder = Folder::with("K.mtx", MATRIX);
    fs::write(folder.path("frf.csv"), TABLE).unwrap();
    folder.convert("frf.csv", "frf.uff", &of_table(false));
    let mut options = PLAIN;
    assert_snapshot!(folder.refused("frf.csv", "a.uff", &options), @"--quantity: expected receptance, mobility or accelerance: the table does not say, found none");
    options.quantity = Some(Quantity::Receptance);
    assert_snapshot!(folder.refused("frf.csv", "a.uff", &options), @"--response: expected where it was measured, such as 34+Z: the table does not say, found none");
    options.response = Some("1+X".parse().unwrap());
    assert_snapshot!(folder.refused("frf.csv", "a.uff", &options), @"--reference: expected where it was driven, such as 12+Z: the table does not say, found none");
    options.reference = Some(DofName { node: u64::MAX, ..options.response.unwrap() });
    assert_snapshot!(folder.refused("frf.csv", "a.uff", &options), @"--reference: expected a node of at most ten digits, found 18446744073709551615+X");
    assert_snapshot!(folder.refused("K.mtx", "K.rsa", &ConvertOptions { binary: true, ..PLAIN }), @"--binary: expected no such option for a matrix, found it");
    assert_snapshot!(folder.refused("frf.csv", "a.csv", &ConvertOptions { records: vec![1], ..PLAIN }), @"--record: expected no such option for a table made of a table, found 1");
    assert_snapshot!(folder.refused("frf.uff", "a.csv", &ConvertOptions { records: vec![1, 2], ..PLAIN }), @"--record: expected one FRF for a table, found 1,2");
    let other = ConvertOptions { quantity: Some(Quantity::Mobility), ..PLAIN };
    assert_snapshot!(folder.refused("frf.uff", "a.csv", &other), @"--quantity: expected accelerance, as the file says (values are not converted), found mobility");
    let beyond = ConvertOptions { records: vec![2], ..PLAIN };
    let refusal = folder.refused("frf.uff", "a.csv", &beyond);
    assert!(refusal.contains("record") && refusal.ends_with("found 2"), "{refusal}");
}

#[test]
fn nothing_is_lost_silently() {
    let close = "frequency_hz,re,im\n1000.001,1,0\n1000.002,2,0\n1000.004,3,0\n";
    let folder = Folder::with("close.csv", close);
    assert_snapshot!(folder.refused("close.csv", "close.uff", &of_table(false)), @"close.csv: expected an abscissa that the text of a UFF file can show, or binary data (--binary), found one that would move by 0.50 of its step");
    folder.convert("close.csv", "close.uff", &of_table(true));
    assert_snapshot!(folder.refused("close.uff", "text.uff", &PLAIN), @"close.uff:7: expected an abscissa that the text of a UFF file can show, or binary data (--binary), found one that would move by 2.00 of its step");
    let with_std = "frequency_hz,re,im,coherence,std\n1.0,1.0,0.0,0.5,0.1\n2.0,1.0,0.0,0.25,0.2\n";
    fs::write(folder.path("std.csv"), with_std).unwrap();
    folder.convert("std.csv", "std.uff", &of_table(true));
    assert_eq!(folder.convert("std.uff", "again.csv", &PLAIN), with_std.as_bytes());
    // The last point is missing.
    fs::write(folder.path("frf.csv"), TABLE).unwrap();
    let text = String::from_utf8(folder.convert("frf.csv", "frf.uff", &of_table(false))).unwrap();
    let cut = text.replacen("         6         3", "         6         4", 1);
    fs::write(folder.path("cut.uff"), cut).unwrap();
    assert_snapshot!(folder.refused("cut.uff", "whole.uff", &ConvertOptions { binary: true, ..PLAIN }), @"cut.uff:7: expected 4 points, as the header says, found 3");
}

/// Frequencies in ascending order: even, or not.
fn frequencies() -> impl Strategy<Value = Vec<f64>> {
    let even = (0.0..1e4, 1e-3..10.0, 1usize..40)
        .prop_map(|(first, step, count)| (0..count).map(|k| first + step * k as f64).collect());
    let uneven = proptest::collection::vec(1e-3f64..10.0, 1..40).prop_map(|steps| {
        steps.iter().scan(0.0, |sum, step| Some(std::mem::replace(sum, *sum + step))).collect()
    });
    prop_oneof![even, uneven]
}

/// The table of an FRF at these frequencies.
fn table(frequency_hz: &[f64], seed: f64) -> String {
    let value = |k: usize| (seed * (k + 1) as f64).sin() * 10f64.powi(k as i32 % 30 - 15);
    let row = |(k, f): (usize, &f64)| format!("{f:?},{:?},{:?}\n", value(2 * k), value(2 * k + 1));
    format!("frequency_hz,re,im\n{}", frequency_hz.iter().enumerate().map(row).collect::<String>())
}

proptest! {
    #[test]
    fn any_frf_survives_binary_bit_for_bit(frequency_hz in frequencies(), seed in 0.1..3.0f64) {
        let table = table(&frequency_hz, seed);
        let folder = Folder::with("frf.csv", &table);
        folder.convert("frf.csv", "frf.uff", &of_table(true));
        prop_assert_eq!(String::from_utf8(folder.convert("frf.uff", "back.csv", &PLAIN)).unwrap(), table);
    }

    #[test]
    fn any_frf_survives_text_to_twelve_digits_or_is_refused(frequency_hz in frequencies(), seed in 0.1..3.0f64) {
        let folder = Folder::with("frf.csv", table(&frequency_hz, seed));
        let Ok(text) = convert(&folder.path("frf.csv"), Path::new("frf.uff"), &of_table(false), &mut Reads::default()) else {
            return Ok(());
        };
        fs::write(folder.path("frf.uff"), text).unwrap();
        let frf = |name| load_frf(&folder.path(name), &Choice::default()).unwrap();
        let (before, after) = (frf("frf.csv"), frf("frf.uff"));
        prop_assert_eq!(after.frequency_hz.len(), before.frequency_hz.len());
        for (a, b) in before.response.iter().zip(&after.response) {
            // E20.12 has 13 digits: each part is off by at most 5 in the fourteenth.
            prop_assert!((a.re - b.re).abs() <= 5e-13 * a.re.abs());
            prop_assert!((a.im - b.im).abs() <= 5e-13 * a.im.abs());
        }
        for (k, f) in before.frequency_hz.iter().enumerate().skip(1) {
            let step = f - before.frequency_hz[k - 1];
            prop_assert!((f - after.frequency_hz[k]).abs() <= 0.05 * step);
        }
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn real_matrices_there_and_back_needs_data() {
    let data = shared("");
    for name in ["plate/bcsstk09.mtx", "plate/bcsstm09.mtx", "hb/bcsstm01.mtx", "hb/bcsstk12.mtx"] {
        let folder = Folder::with("A.mtx", fs::read(data.join(name)).unwrap());
        folder.convert("A.mtx", "A.rsa", &PLAIN);
        let mut back = read_matrix(&folder.convert("A.rsa", "back.mtx", &PLAIN)).unwrap();
        let there = read_matrix(&fs::read(folder.path("A.mtx")).unwrap()).unwrap();
        back.title.clone_from(&there.title); // longer than Harwell-Boeing has room for
        assert_eq!(back, there, "{name}");
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn real_measurements_there_and_back_needs_data() {
    let beam = shared("uff/beam.uff");
    let folder = Folder::with("x", "");
    let binary = convert(
        &beam,
        Path::new("beam.uff"),
        &ConvertOptions { binary: true, ..PLAIN },
        &mut Reads::default(),
    )
    .unwrap();
    fs::write(folder.path("binary.uff"), &binary).unwrap();
    for record in 1..=3 {
        let options = ConvertOptions { records: vec![record], ..PLAIN };
        let from_text = convert(&beam, Path::new("frf.csv"), &options, &mut Reads::default()).unwrap();
        assert_eq!(folder.convert("binary.uff", "frf.csv", &options), from_text);
        let frf = csv::read_frf(&from_text).unwrap();
        assert_eq!((frf.frequency_hz.len(), frf.frequency_hz[63_999]), (64_000, 6399.9));
    }
    let text = folder.convert("binary.uff", "text.uff", &PLAIN);
    let (there, back) = (fs::read(&beam).unwrap(), uff::File::new(&text).unwrap());
    let there = uff::File::new(&there).unwrap();
    for index in there.functions() {
        assert_eq!(there.function(index), back.function(index));
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn real_uff_files_become_binary_and_are_the_same_needs_data() {
    let folder = shared("uff");
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let options = ConvertOptions { binary: true, ..PLAIN };
        if path.ends_with("dataset_milestone_in_header.uff") {
            let error =
                convert(&path, Path::new("a.uff"), &options, &mut Reads::default()).unwrap_err().to_string();
            assert!(error.contains("expected 2508876 points, as the header says, found 42"), "{error}");
            continue;
        }
        let binary = convert(&path, Path::new("a.uff"), &options, &mut Reads::default())
            .unwrap_or_else(|error| panic!("{error}"));
        let there = fs::read(&path).unwrap();
        let (there, back) = (uff::File::new(&there).unwrap(), uff::File::new(&binary).unwrap());
        assert_eq!(there.entries().len(), back.entries().len(), "{}", path.display());
        for index in 0..there.entries().len() {
            assert_eq!(there.entries()[index].dataset, back.entries()[index].dataset);
        }
    }
}
