//! What `inspect` says about files of every kind.

use crate::shared_data;

use frfit_workflow::inspect::{inspect, natural_frequencies};
use insta::assert_snapshot;
use serde_json::{Value, json};
use shared_data::shared;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A file of this name and content in a folder of its own.
fn file(name: &str, content: &str) -> (TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    (folder, path)
}

/// Words without the folder, which is another one each time.
fn without_folder(path: &Path, words: &str) -> String {
    words.replace(&format!("{}/", path.parent().unwrap().display()), "")
}

fn text(name: &str, content: &str) -> String {
    let (_folder, path) = file(name, content);
    without_folder(&path, &inspect(&path).unwrap().text())
}

fn text_of(path: &Path) -> String {
    without_folder(path, &inspect(path).unwrap().text())
}

fn json_of(name: &str, content: &str) -> Value {
    let (_folder, path) = file(name, content);
    let mut json = inspect(&path).unwrap().json();
    assert_eq!(json["file"], path.to_str().unwrap());
    json["file"] = json!(name);
    json
}

fn refused(name: &str, content: &str) -> String {
    let (_folder, path) = file(name, content);
    without_folder(&path, &inspect(&path).unwrap_err().to_string())
}

/// OUTPUT4: a symmetric K, and a form that stores nothing.
const OP4: &str = "       2      -2       6       2KAA     1P,3E24.16
       1       0       6
       5       1
  3.0000000000000000E+00 -1.0000000000000000E+00
       2       0       6
       5       1
 -1.0000000000000000E+00  2.0000000000000000E+00
       3       1       1
  1.0000000000000000E+00
       2       2       8       2ID
       3       1       1
 1.000000000E+00
";

#[test]
fn matrices_with_names_are_listed_one_by_one() {
    assert_snapshot!(text("model.op4", OP4), @r#"
    model.op4: a Nastran OUTPUT4 file
      KAA
        size      2 x 2
        values    real, declared symmetric
        entries   3 stored, 4 not zero in all
        diagonal  2 to 3
        largest   3
        use       a term of a model (file of a [[matrix]])
      ID
        model.op4: expected a matrix that stores its entries, found form 8, an identity
    "#);
    let json = json_of("model.op4", OP4);
    assert_eq!(json["kind"], "op4");
    assert_eq!(json["matrices"][0]["name"], "KAA");
    assert_eq!(json["matrices"][0]["triangle"], "one");
    let error = json["matrices"][1]["error"].as_str().unwrap();
    assert!(
        error.ends_with("model.op4: expected a matrix that stores its entries, found form 8, an identity")
    );
}

#[test]
fn of_an_array_without_a_name_it_is_told_which_triangle_is_there() {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend([2.0_f64, -1.0, 0.0, 2.0].iter().flat_map(|x| x.to_le_bytes()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("K.npy");
    fs::write(&path, bytes).unwrap();
    assert_snapshot!(text_of(&path), @r#"
    K.npy: a NumPy file (.npy, .npz)
      size      2 x 2
      values    real, only the upper triangle stored
      entries   3 stored, 3 not zero in all
      diagonal  2 to 2
      largest   2
      use       not a term of a model: expected a symmetric matrix (its transpose is A), found -1 at (1, 2) but 0 at (2, 1)
    "#);
}

const LUMPED: &str = "%%MatrixMarket matrix coordinate real symmetric\n% ----\n% Lumped masses\n3 3 3\n1 1 2.5\n2 2 0\n3 1 -0.5\n";
const NOT_SYMMETRIC: &str = "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 2\n2 1 0.5\n2 2 3\n";

#[test]
fn a_term_of_a_model() {
    assert_snapshot!(text("M.mtx", LUMPED), @r"
    M.mtx: a Matrix Market file
      title      Lumped masses
      size       3 x 3
      values     real, declared symmetric
      entries    3 stored, 3 not zero in all
      diagonal   0 to 2.5, 2 of them zero
      zero rows  1
      largest    2.5
      use        a term of a model (file of a [[matrix]])
    ");
    // One triangle is stored: (3, 1) stands for (1, 3) too; the stored zero at (2, 2) is no nonzero.
    assert_eq!(
        json_of("M.mtx", LUMPED),
        json!({
            "file": "M.mtx", "kind": "matrix market", "rows": 3, "columns": 3, "stored": 3, "nonzeros": 3,
            "field": "real", "declared_symmetry": "symmetric", "triangle": "one", "numerically_symmetric": true, "asymmetry": null, "labels": null,
            "zero_rows": 1, "zero_diagonals": 2, "diagonal": {"min": 0.0, "max": 2.5}, "largest": 2.5,
            "title": "----\nLumped masses", "term": true,
        })
    );
}

#[test]
fn what_is_no_term_says_why() {
    assert_snapshot!(text("A.mtx", NOT_SYMMETRIC), @r"
    A.mtx: a Matrix Market file
      size      2 x 2
      values    real, declared general, only the lower triangle stored
      entries   3 stored, 3 not zero in all
      diagonal  2 to 3
      largest   3
      use       not a term of a model: expected a symmetric matrix (its transpose is A), found 0.5 at (2, 1) but 0 at (1, 2)
    ");
    let json = json_of("A.mtx", NOT_SYMMETRIC);
    assert_eq!(json["numerically_symmetric"], false);
    assert_eq!(json["asymmetry"], "0.5 at (2, 1) but 0 at (1, 2)");
    let wide = "%%MatrixMarket matrix coordinate pattern general\n2 3 1\n1 3\n";
    assert_snapshot!(text("wide.mtx", wide), @r"
    wide.mtx: a Matrix Market file
      size       2 x 3
      values     pattern, declared general
      entries    1 stored, 1 not zero in all
      diagonal   0 to 0, 2 of them zero
      zero rows  1
      largest    1
      use        not a term of a model: expected a square matrix, found 2 rows and 3 columns
    ");
    let hermitian = "%%MatrixMarket matrix coordinate complex hermitian\n2 2 2\n1 1 -3 0\n2 1 0 4\n";
    assert_snapshot!(text("H.mtx", hermitian), @r"
    H.mtx: a Matrix Market file
      size      2 x 2
      values    complex, declared hermitian
      entries   2 stored, 3 not zero in all
      diagonal  -3 to 0, 1 of them zero
      largest   4
      use       not a term of a model: expected a symmetric matrix (its transpose is A), found a Hermitian one (its transpose is the conjugate of A)
    ");
}

#[test]
fn a_header_of_many_rows_costs_nothing() {
    let json =
        json_of("huge.mtx", "%%MatrixMarket matrix coordinate real general\n2147483647 2147483647 0\n");
    assert_eq!((&json["zero_rows"], &json["diagonal"]["max"]), (&json!(2_147_483_647), &json!(0.0)));
    let (_k_folder, k) =
        file("K.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2147483647 2147483647 1\n1 1 1\n");
    let error = natural_frequencies(&k, &k, 1).unwrap_err();
    assert_snapshot!(without_folder(&k, &error.to_string()), @"K.mtx: expected a nonzero in every row of K or M, found 2 entries in both for 2147483647 rows");
}

/// A diagonal matrix as a file of its own.
fn diagonal(name: &str, values: [f64; 3]) -> (TempDir, std::path::PathBuf) {
    let rows: String = (1..).zip(values).map(|(n, value)| format!("{n} {n} {value}\n")).collect();
    file(name, &format!("%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n{rows}"))
}

#[test]
fn matrices_of_a_part_of_a_model_are_refused_in_words() {
    let refused = |k: [f64; 3], m: [f64; 3]| {
        let ((_k_folder, k), (_m_folder, m)) = (diagonal("K.mtx", k), diagonal("M.mtx", m));
        without_folder(&k, &natural_frequencies(&k, &m, 2).unwrap_err().to_string())
    };
    let whole = "K.mtx: expected K and M of the whole model, in which each degree of freedom has a stiffness or a mass; \
                 where they are matrices of a part, name all matrices in a case file and run `frfit modes` on it, found";
    assert_eq!(refused([1.0, 0.0, 2.0], [1.0, 0.0, 1.0]), format!("{whole} no value in row 2 of both"));
    assert_eq!(
        refused([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        format!("{whole} no value in 2 rows of both (the first is 2)")
    );
    // Only the mass has it: a mode of 0 Hz.
    let ((_k_folder, k), (_m_folder, m)) = (diagonal("K.mtx", [1.0, 0.0, 4.0]), diagonal("M.mtx", [1.0; 3]));
    let found = natural_frequencies(&k, &m, 3).unwrap();
    assert!(found[0] < 1e-4 && (found[2] * std::f64::consts::TAU - 2.0).abs() < 1e-6, "{found:?}");
}

#[test]
fn a_motion_without_stiffness_and_mass_is_refused_in_words() {
    // The sum of both rows is zero in K and in M.
    let springs = "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1\n2 1 -1\n2 2 1\n";
    let ((_k_folder, k), (_m_folder, m)) = (file("K.mtx", springs), file("M.mtx", springs));
    let error = natural_frequencies(&k, &m, 1).unwrap_err().to_string();
    assert!(error.contains("frfit modes"), "{error}");
    assert!(
        error.ends_with("a motion that has neither stiffness nor mass: K + s M is singular for every s"),
        "{error}"
    );
}

#[test]
fn tables_by_what_they_can_serve_as() {
    assert_snapshot!(text("frf.csv", "frequency_hz,re,im,std\n20,1,0,1\n10,2,0,1\n"), @r"
    frf.csv: a table (CSV)
      columns  4 (frequency_hz, re, im, std)
      rows     2
      range    10 to 20 Hz
      use      an FRF (file of a [[measurement]])
    ");
    assert_snapshot!(text("f.csv", "row;re\n1;1.5\n"), @r"
    f.csv: a table (CSV)
      columns  2 (row, re)
      rows     1
      use      a load (file of [load])
    ");
    assert_snapshot!(text("dofs.csv", "row,node,direction\n1,7,Z\n"), @r"
    dofs.csv: a table (CSV)
      columns  3 (row, node, direction)
      rows     1
      use      names of rows (file of [dofs])
    ");
    assert_snapshot!(text("e.csv", "frequency_hz,storage,loss_factor,status\n1,2e9,0.1,ok\n5,,,no_root\n"), @r"
    e.csv: a table (CSV)
      columns  4 (frequency_hz, storage, loss_factor, status)
      rows     2
      range    1 to 1 Hz
      use      a modulus over frequency (table of a factor)
    ");
    let json = json_of("frf.csv", "frequency_hz,re,im\n20,1,0\n10,2,0\n");
    assert_eq!(json["serves_as"], json!(["frf"]));
    assert_eq!((&json["range_hz"], &json["rows"]), (&json!([10.0, 20.0]), &json!(2)));
}

#[test]
fn a_table_that_serves_as_nothing_says_why() {
    assert_snapshot!(text("frf.csv", "freqency_hz,re,im\n10,1,0\n"), @r#"
    frf.csv: a table (CSV)
      columns  3 (freqency_hz, re, im)
      rows     1
      use      none
               not an FRF (file of a [[measurement]]): frf.csv:1:1: expected one of the columns frequency_hz, re, im, magnitude, magnitude_db, phase_deg, phase_rad, coherence, std, found "freqency_hz"; did you mean "frequency_hz"?
               not a load (file of [load]): frf.csv:1:1: expected one of the columns row, re, im, found "freqency_hz"
               not names of rows (file of [dofs]): frf.csv:1:1: expected one of the columns row, node, direction, found "freqency_hz"
               not a modulus over frequency (table of a factor): frf.csv:1: expected a column "frequency_hz", found no such name; the nearest is "freqency_hz"
    "#);
    assert_eq!(json_of("x.csv", "a,b\n1,2\n")["serves_as"], json!([]));
}

#[test]
fn what_is_no_file_of_any_kind() {
    assert_snapshot!(refused("note.txt", "Dear reader\n"), @"note.txt: expected a UFF file, matrices (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB), a table (CSV) or time records (.lvm), found none of them (no %%MatrixMarket or -1 at the top, no matrix type in line 3, no names of columns)");
    assert_snapshot!(refused("empty", ""), @"empty: expected a UFF file, matrices (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB), a table (CSV) or time records (.lvm), found an empty file");
    assert_snapshot!(refused("torn.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n1 1 1\n"), @"torn.mtx:3: expected 2 entries, as line 2 says, found 1");
    let folder = tempfile::tempdir().unwrap();
    assert!(inspect(folder.path()).unwrap_err().to_string().ends_with("expected a file, found a folder"));
}

/// A 58 as the writer has it, after an edit.
fn uff(edit: impl Fn(String) -> String) -> String {
    use frfit_formats::uff::{Dof, Form, Function, FunctionHeader, Quantity, Spacing, Units, Values, write};
    let mut header = FunctionHeader {
        spacing: Spacing::Even { minimum: 10.0, increment: 0.5 },
        response: Dof { node: 34, direction: 3, ..Dof::default() },
        reference: Dof { node: 1, direction: -3, ..Dof::default() },
        ..FunctionHeader::default()
    };
    header.id[0] = "impact 1".into();
    header.abscissa.unit = "Hz".into();
    header.ordinate.quantity = Quantity::Acceleration;
    header.denominator.quantity = Quantity::ExcitationForce;
    let function = Function::new(header, vec![10.0, 10.5], Values::Complex(vec![1.0.into(), 2.0.into()]));
    let function = String::from_utf8(write::function(&function, Form::Ascii).unwrap()).unwrap();
    let units = String::from_utf8(write::units(&Units::default()).unwrap()).unwrap();
    format!("{units}{}{function}", edit(function.clone()))
}

#[test]
fn a_broken_dataset_is_listed_with_its_error() {
    let broken = uff(|function| function.replacen("         6         2", "         7         2", 1));
    assert_snapshot!(text("frf.uff", &broken), @r#"
    frf.uff: a Universal File Format (UFF) file, 3 datasets, 1 FRF
      line  1  164  units "SI: m, N": 1 to the metre, 1 to the newton
      line  7  58   broken: frf.uff:15:1: expected an ordinate data type: 2, 4, 5 or 6, found "7"
      line 22  58   FRF 1: 34+Z / 1-Z, acceleration / excitation force, 2 points, 10 to 10.5 Hz, even, complex, double precision
    "#);
    let json = json_of("frf.uff", &broken);
    assert_eq!(
        json["records"][2],
        json!({
            "dataset": 58, "binary": false, "line": 22, "record": 1, "id": "impact 1",
            "function_type": "frequency response function", "response": "34+Z", "reference": "1-Z",
            "points": 2, "range": [10.0, 10.5], "even": true, "data_type": "complex, double precision",
            "quantities": {"abscissa": "frequency", "ordinate": "acceleration", "denominator": "excitation force"},
            "units": {"abscissa": "Hz", "ordinate": "", "denominator": ""},
        })
    );
    assert!(json["records"][1]["error"].as_str().unwrap().contains("data type"), "{json}");
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn the_clamped_plate_has_the_natural_frequencies_of_the_paper_needs_data() {
    let plate = shared("plate");
    let found = natural_frequencies(&plate.join("bcsstk09.mtx"), &plate.join("bcsstm09.mtx"), 5).unwrap();
    // With half of the last digit that is known: below 2e-6 of each.
    let known = [(858.089, 5e-4), (1748.538, 5e-4), (1748.538, 5e-4), (2566.205, 5e-4), (3134.19, 5e-3)];
    assert_eq!(found.len(), known.len());
    for (found, (known, half_digit)) in found.iter().zip(known) {
        assert!((found - known).abs() <= half_digit, "{found} is not {known}");
    }
    let error =
        natural_frequencies(&plate.join("bcsstk09.mtx"), &plate.join("../hb/bcsstm01.mtx"), 5).unwrap_err();
    assert!(error.to_string().contains("bcsstk09.mtx: 1083), found 48"), "{error}");
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn real_matrices_needs_data() {
    let data = shared("");
    assert_snapshot!(text_of(&data.join("plate/bcsstk09.rsa")), @r"
    bcsstk09.rsa: a Harwell-Boeing file
      title     1SYMMETRIC STIFFNESS MATRIX, SQUARE PLATE CLAMPED
      size      1083 x 1083
      values    real, declared symmetric
      entries   9760 stored, 18437 not zero in all
      diagonal  5.65593e6 to 3.9412e7
      largest   3.9412e7
      use       a term of a model (file of a [[matrix]])
    ");
    assert_snapshot!(text_of(&data.join("hb/bcsstm01.mtx")), @r"
    bcsstm01.mtx: a Matrix Market file
      title      UF Sparse Matrix Collection, Tim Davis
      size       48 x 48
      values     real, declared symmetric
      entries    48 stored, 24 not zero in all
      diagonal   0 to 200, 24 of them zero
      zero rows  24
      largest    200
      use        a term of a model (file of a [[matrix]])
    ");
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn real_measurements_needs_data() {
    let uff = shared("uff");
    assert_snapshot!(text_of(&uff.join("beam.uff")), @r#"
    beam.uff: a Universal File Format (UFF) file, 7 datasets, 3 FRFs
      line      1  151   file header: NewModel, DefaultDecription, modaldata v1, 29-Jan-16 14:48:16
      line     11  164   units "User unit system": 1 to the metre, 1 to the newton
      line     17  2420  3643 bytes, not read
      line     82  2411  10 nodes
      line    105  58    FRF 1: 1+X / 21+X, acceleration / excitation force, 64000 points, 0 to 6399.9 (frequency), uneven, complex, double precision
      line  64119  58    FRF 2: 2+X / 21+X, acceleration / excitation force, 64000 points, 0 to 6399.9 (frequency), uneven, complex, double precision
      line 128133  58    FRF 3: 3+X / 21+X, acceleration / excitation force, 64000 points, 0 to 6399.9 (frequency), uneven, complex, double precision
    "#);
    assert_snapshot!(text_of(&uff.join("TestLab 161 164 18 15 82.uff")), @r#"
    TestLab 161 164 18 15 82.uff: a Universal File Format (UFF) file, 7 datasets, 0 FRFs
      line   1  151  file header: AME_Test, LMS Test.Lab Rev project-15A, 11-Oct-17 09:34:21
      line  11  164  units "USER_DEFINED": 1 to the metre, 1 to the newton
      line  17  18   6495 bytes, not read
      line 164  15   36 nodes
      line 203  82   trace line "Massif" over 9 nodes
      line 210  82   trace line "Stator" over 32 nodes
      line 219  82   trace line "Dalle" over 11 nodes
    "#);
    assert_snapshot!(text_of(&uff.join("Sample_UFF58b_bin.uff")), @r"
    Sample_UFF58b_bin.uff: a Universal File Format (UFF) file, 1 dataset, 0 FRFs
      line 1  58b  time response: 0+X / 0, unnamed quantity, 79292 points, 0 to 1.20989 s, even, real, single precision
    ");
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn every_real_uff_file_is_listed_without_an_error_needs_data() {
    let uff = shared("uff");
    for file in fs::read_dir(uff).unwrap() {
        let path = file.unwrap().path();
        let json = inspect(&path).unwrap().json();
        for record in json["records"].as_array().unwrap() {
            assert_eq!(record["error"], Value::Null, "{}", path.display());
        }
    }
}
