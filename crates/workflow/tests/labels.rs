//! Cases whose matrices name their rows: no `[dofs]`, whatever the order of the rows.

use crate::shared_data;
use frfit_workflow::Reads;

use frfit::c64;
use frfit::identify::Status;
use frfit_workflow::convert::{ConvertOptions, convert};
use frfit_workflow::inspect::{inspect, natural_frequencies};
use frfit_workflow::job::identify_case;
use frfit_workflow::load::{Case, Overrides, Purpose, load};
use frfit_workflow::run::RunOptions;
use insta::assert_snapshot;
use shared_data::shared;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The chain of springs in the files of four programs.
fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../formats/tests/labels/samples")
}

/// A case of K and M as the keys `file` say, in a folder with the samples and these files; loaded for a response.
fn chain(k: &str, m: &str, more: &str, files: &[(&str, &str)]) -> Result<Case, String> {
    let folder = tempfile::tempdir().unwrap();
    for sample in fs::read_dir(samples()).unwrap() {
        let sample = sample.unwrap();
        fs::copy(sample.path(), folder.path().join(sample.file_name())).unwrap();
    }
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    let case = format!(
        "[[matrix]]\nname = \"K\"\nrole = \"stiffness\"\nfile = {k}\n[[matrix]]\nname = \"M\"\nrole = \"mass\"\n\
         file = {m}\n{more}[load]\ndof = \"1+X\"\n[[measurement]]\ndof = \"4-Y\"\nquantity = \"receptance\"\n\
         [respond]\nband_hz = [10, 40]\npoints = 4\n"
    );
    let file = folder.path().join("case.toml");
    fs::write(&file, case).unwrap();
    let loaded = load(&file, &Overrides::default(), Purpose::Respond);
    loaded.map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

/// K and M of a case at two names: what the model is, whatever the order of its rows.
fn entries(case: &Case) -> Vec<[c64; 2]> {
    let names = ["1+X", "2+X", "3+X", "4+X", "4+Y"];
    let row = |name: &str| *case.row_names.iter().find(|(_, there)| *there == name).unwrap().0;
    let terms = case.model.terms();
    names
        .iter()
        .flat_map(|a| names.iter().map(|b| [0, 1].map(|k| terms[k].matrix.get(row(a), row(b)))))
        .collect()
}

#[test]
fn one_structure_from_four_programs_is_one_model() {
    const SAME: [(&str, &str); 5] = [
        ("\"chain.sti\"", "\"chain.mas\""),
        ("\"chain_STIF1.mtx\"", "\"chain_MASS1.mtx\""),
        ("{ file = \"chain.pch\", name = \"KAAX\" }", "{ file = \"chain.pch\", name = \"MAAX\" }"),
        // Of two programs, in two orders.
        ("{ file = \"chain.pch\", name = \"KAAX\" }", "\"chain.mas\""),
        ("\"chain.sti\"", "\"chain_MASS1.mtx\""),
    ];
    let first = chain(SAME[0].0, SAME[0].1, "", &[]).unwrap();
    assert_eq!(first.model.dim(), 5);
    assert_eq!(first.row_name(0), "4+X");
    let names: Vec<_> = first.inputs.iter().map(|input| input.path.to_string_lossy().into_owned()).collect();
    assert_eq!(
        names,
        ["case.toml", "chain.sti", "chain.dof", "chain.mas"].map(|name| match name {
            "case.toml" => names[0].clone(),
            name => name.to_owned(),
        })
    );
    for (k, m) in &SAME[1..4] {
        let case = chain(k, m, "", &[]).unwrap();
        assert_eq!(entries(&case), entries(&first), "{k} {m}");
        assert_eq!(case.experiment.sensors[0].sign, -1.0);
        assert_eq!(case.row_names[&case.experiment.sensors[0].row], "4+Y");
    }
    // What Abaqus holds fixed is shown by its stiffness alone.
    let message = chain(SAME[4].0, SAME[4].1, "", &[]).unwrap_err();
    assert_snapshot!(message, @r"
    chain_MASS1.mtx: expected rows that some stiffness has too, by their names, found 1 that none has: 9+X
    named in case.toml:8:1: matrix.file
    ");
}

#[test]
fn ansys_names_the_rows_of_its_harwell_boeing_files() {
    let rsa = convert(
        &samples().join("chain.sti"),
        Path::new("K.rsa"),
        &ConvertOptions::default(),
        &mut Reads::default(),
    )
    .unwrap();
    let rsa = String::from_utf8(rsa).unwrap();
    let mapping = fs::read_to_string(samples().join("chain.mapping")).unwrap();
    let files = [("K.rsa", &*rsa), ("K.mapping", &*mapping)];
    let case = chain("\"K.rsa\"", "\"chain.mas\"", "", &files).unwrap();
    assert_eq!(entries(&case), entries(&chain("\"chain.sti\"", "\"chain.mas\"", "", &[]).unwrap()));
    let short: String = mapping.lines().take(5).map(|line| format!("{line}\n")).collect();
    let files = [("K.rsa", &*rsa), ("K.mapping", &*short)];
    assert_snapshot!(chain("\"K.rsa\"", "\"chain.mas\"", "", &files).unwrap_err(), @r"
    K.mapping: expected 5 names, one for each row of the matrix beside it, found 4
    named in case.toml:4:1: matrix.file
    ");
}

#[test]
fn a_table_of_dofs_rules_and_what_is_not_there_is_refused() {
    let dofs = "[dofs]\nfile = \"dofs.csv\"\n";
    let table = "row,node,direction\n2,1,X\n1,4,Y\n";
    let case = chain("\"chain.sti\"", "\"chain.mas\"", dofs, &[("dofs.csv", table)]).unwrap();
    assert_eq!(case.experiment.sensors[0].row, 0);
    let refused = |k: &str, m: &str, files: &[(&str, &str)]| chain(k, m, "", files).unwrap_err();
    assert_snapshot!(refused("\"chain.pch\"", "\"chain.mas\"", &[]), @r#"
    chain.pch: expected one matrix, or a name: { file = "...", name = "..." }, found KAAX (5 x 5), MAAX (5 x 5), ZAAX (3 x 3), BAAX (2 x 2)
    named in case.toml:4:1: matrix.file
    "#);
    let without_y = ("K.mtx", "1,1, 1,1, 2.0\n2,1, 2,1, 2.0\n");
    let mass = ("M.mtx", "1,1, 1,1, 2.0\n2,1, 2,1, 2.0\n");
    assert_snapshot!(refused("\"K.mtx\"", "\"M.mtx\"", &[without_y, mass]), @r#"case.toml:12:1: measurement.dof: expected a degree of freedom that the files of the matrices name, found 4-Y (no node 4; the nearest is 2 with X)"#);
    let fixed = ("K.mtx", "1 1 2.0\n2 2 1.0e36\n");
    assert_snapshot!(refused("\"K.mtx\"", "\"M.mtx\"", &[fixed, mass]), @r"
    K.mtx: expected no row that is held fixed by 1e36 on the diagonal (written with FORMAT=MATRIX INPUT, the names of such rows say which rows to leave out), found it in row 2
    named in case.toml:4:1: matrix.file
    ");
    let idle = ("K.mtx", "1,1, 1,1, 2.0\n2,1, 2,1, 0.0\n");
    let mass = ("M.mtx", "1,1, 1,1, 2.0\n");
    assert_snapshot!(refused("\"K.mtx\"", "\"M.mtx\"", &[idle, mass]), @"case.toml:4:1: matrix.file: expected an entry in each of the 2 rows, in some matrix, found none in row 2 (2+X)");
}

#[test]
fn inspect_shows_the_rows_and_the_triangle() {
    let shown = |name: &str| {
        inspect(&samples().join(name)).unwrap().text().replace(&format!("{}/", samples().display()), "")
    };
    assert_snapshot!(shown("chain.sti"));
    assert_snapshot!(shown("chain_STIF1.mtx"));
    assert_snapshot!(shown("chain_coordinate.mtx"));
    assert_snapshot!(shown("chain.pch"));
    let json = inspect(&samples().join("chain.pch")).unwrap().json();
    assert_eq!(json["kind"], "dmig");
    assert_eq!((&json["matrices"][0]["name"], &json["matrices"][0]["rows"]), (&"KAAX".into(), &5.into()));
    assert_eq!(json["matrices"][0]["labels"]["directions"], serde_json::json!(["X", "Y"]));
}

#[test]
fn names_of_rows_and_one_of_several_matrices_can_be_converted() {
    let plain = ConvertOptions::default();
    let text = |name: &str, to: &str, options: &ConvertOptions| {
        convert(&samples().join(name), Path::new(to), options, &mut Reads::default())
            .map(|bytes| String::from_utf8(bytes).unwrap())
    };
    assert_eq!(
        text("chain.sti", "dofs.csv", &plain).unwrap(),
        "row,node,direction\n1,4,X\n2,1,X\n3,4,Y\n4,2,X\n5,3,X\n"
    );
    let named = ConvertOptions { name: Some("MAAX".into()), ..ConvertOptions::default() };
    let mass = text("chain.pch", "M.mtx", &named).unwrap();
    assert!(mass.contains("5 5 5\n1 1 0.125\n2 2 0.25\n"), "{mass}");
    let refused = text("chain.pch", "M.mtx", &plain).unwrap_err().to_string();
    assert!(refused.contains("expected one matrix, or --name, found KAAX (5 x 5)"), "{refused}");
    let unnamed = text("chain_coordinate.mtx", "dofs.csv", &plain).unwrap_err().to_string();
    assert!(unnamed.ends_with("found no names"), "{unnamed}");
}

#[test]
fn modes_do_not_depend_on_the_order_of_the_rows() {
    let modes = |k: &str, m: &str| natural_frequencies(&samples().join(k), &samples().join(m), 3).unwrap();
    let calculix = modes("chain.sti", "chain.mas");
    for (a, b) in calculix.iter().zip(modes("chain_STIF1.mtx", "chain_MASS1.mtx")) {
        // Two orders of elimination.
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

/// The measurement of a column of frf_ccx.csv, and the load on the bar's end, in a folder.
fn calculix_bar(shared: &Path) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| shared.join(name).canonicalize().unwrap().display().to_string();
    let mut frf = String::from("frequency_hz,re,im\n");
    for line in fs::read_to_string(shared.join("frf_ccx.csv")).unwrap().lines().skip(1) {
        let cells: Vec<_> = line.split(',').collect();
        let _ = writeln!(frf, "{},{},{}", cells[0], cells[3], cells[4]);
    }
    fs::write(folder.path().join("far.csv"), frf).unwrap();
    // *CLOAD of bar_frf.inp: node, direction, force; the rows of the load are those of the first stiffness.
    let input = fs::read_to_string(shared.join("bar_frf.inp")).unwrap();
    let rows = fs::read_to_string(shared.join("bar_matrix.dof")).unwrap();
    let mut load = String::from("row,re\n");
    for line in
        input.lines().skip_while(|line| *line != "*CLOAD").skip(1).take_while(|line| !line.starts_with('*'))
    {
        let cells: Vec<_> = line.split(',').collect();
        let name = format!("{}.{}", cells[0], cells[1]);
        let row = rows.lines().position(|row| row == name).unwrap();
        let _ = writeln!(load, "{},{}", row + 1, cells[2]);
    }
    fs::write(folder.path().join("force.csv"), load).unwrap();
    let case = format!(
        "title = \"Bar by CalculiX\"\n[[matrix]]\nname = \"rubber\"\nrole = \"stiffness\"\nfile = {:?}\n\
         factor = {{ storage = 1.2, loss_factor = 0.1 }}\n[[matrix]]\nname = \"mass\"\nrole = \"mass\"\nfile = {:?}\n\
         [load]\nfile = \"force.csv\"\n[[measurement]]\nfile = \"far.csv\"\ndof = \"712+X\"\n\
         quantity = \"receptance\"\n[identify]\nmatrix = \"rubber\"\nband_hz = [20.0, 700.0]\n\
         bounds = {{ storage = [0.3, 3.0], loss_factor = [0.0, 1.0] }}\n",
        path("bar_matrix.sti"),
        path("bar_matrix.mas"),
    );
    fs::write(folder.path().join("case.toml"), case).unwrap();
    folder
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn the_loss_factor_of_a_bar_is_found_from_the_files_of_calculix_alone_needs_data() {
    let shared = shared("calculix_bar");
    let folder = calculix_bar(&shared);
    let case = folder.path().join("case.toml");
    let done = identify_case(
        &case,
        &Overrides::default(),
        RunOptions::default(),
        &folder.path().join("out"),
        &|_, _| {},
    )
    .unwrap();
    assert_eq!(done.case.sensors[0].label, "712+X");
    assert_eq!((done.case.inputs.len(), done.run.found.lines.len()), (6, 121));
    // CalculiX sums 60 modes, which is an error of the mode shapes at the far end: of 0.3 % in the middle of all
    // frequencies against a direct solve. Its effect is largest at the first frequencies, where the bar moves as
    // a rigid body and the modulus hardly matters: 2.2 % with a standard deviation of 6 %.
    let shape_std = done.run.found.model_errors.as_ref().unwrap().shape_std;
    assert!((1e-3..1e-2).contains(&shape_std), "{shape_std}");
    let ok = done.run.found.lines.iter().filter(|line| line.status == Status::Ok);
    assert!(ok.clone().count() >= 119, "{} ok", ok.count());
    for line in ok {
        let at = format!("{} Hz: {line:?}", line.frequency_hz);
        let factor = line.nominal() + line.correction().unwrap();
        let uncertainty = line.values[0].uncertainty.as_ref().unwrap();
        let loss_factor = factor.im / factor.re;
        assert!((factor.re - 1.0).abs() < (2.0 * uncertainty.storage_std).min(0.025), "{at}");
        assert!((loss_factor - 0.2).abs() < (2.0 * uncertainty.loss_factor_std.unwrap()).min(0.005), "{at}");
    }
}
