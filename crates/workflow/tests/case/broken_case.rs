//! Broken case files: what is said, and where it points.

use super::files::{edited, folder, message, refused, with};
use frfit_workflow::load::{Overrides, Purpose, load};

#[test]
fn text_that_is_not_toml() {
    for (from, to, message) in [
        (
            "order = 20",
            "order = ",
            "case.toml:31:9: expected TOML, found a mistake in it (string values must be quoted, expected literal string)",
        ),
        (
            "order = 20",
            "order = 20\norder = 21",
            "case.toml:32:1: expected TOML, found a mistake in it (duplicate key)",
        ),
        (
            "[dofs]",
            "[dofs",
            "case.toml:16:6: expected TOML, found a mistake in it (unclosed table, expected `]`)",
        ),
        (
            "title = \"Three masses\"",
            "title = \"Three masses",
            "case.toml:1:22: expected TOML, found a mistake in it (invalid basic string, expected `\"`)",
        ),
        (
            "file = \"K.mtx\"",
            "file = \"K.mtx\" # \u{0}",
            "case.toml:5:18: expected TOML, found a mistake in it (invalid comment character, expected printable characters)",
        ),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn a_key_with_its_old_name_is_refused_with_the_new_one() {
    for (old, new) in [
        ("space = \"full\"", "reduction"),
        ("robust = false", "reject_outliers"),
        ("most_lines = 20", "max_lines"),
        ("leave_out_hz = [50.0]", "exclude_hz"),
        ("nominal = \"estimate\"", "start"),
        ("truth = 1.0", "reference"),
    ] {
        let text = edited("case.toml", "[identify]", &format!("[identify]\n{old}"));
        let folder = folder("case.toml", Some(text.as_bytes()));
        let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify);
        let name = old.split(' ').next().unwrap();
        let expected = format!("identify: expected the key {new:?}, which was renamed, found {name:?}");
        let error = message(&folder, &case.unwrap_err());
        assert!(error.contains(&expected), "{error}");
    }
}

#[test]
fn keys_that_are_unknown_or_missing() {
    for (from, to, message) in [
        (
            "order = 20",
            "odrer = 20",
            "case.toml:31:1: identify: expected a known key, of which \"order\" is nearest, found \"odrer\"",
        ),
        (
            "points = 4",
            "colour = 4",
            "case.toml:36:1: respond: expected a known key (band_hz, points), found \"colour\"",
        ),
        (
            "title = ",
            "titel = ",
            "case.toml:1:1: expected a known key, of which \"title\" is nearest, found \"titel\"",
        ),
        ("role = \"stiffness\"\n", "", "case.toml:2:1: matrix: expected the key \"role\", found none"),
        ("[load]\ndof = \"1+Z\"\n", "", "case.toml: expected a table [load], found none"),
        (
            "dof = \"1+Z\"\n",
            "",
            "case.toml:18:1: load: expected one of the keys dof, row and file, found none",
        ),
        (
            "[dofs]\nfile = \"dofs.csv\"\n",
            "",
            "case.toml:17:1: load.dof: expected a table [dofs] that names the rows, or a row number instead of a name, found the name 1+Z without [dofs]",
        ),
        (
            "[dofs]\nfile = \"dofs.csv\"\n",
            "dofs = \"dofs.csv\"\n",
            "case.toml:16:1: matrix: expected a known key (name, role, file, at, factor, factor_is); dofs belongs to the top of the file, before the first table, found \"dofs\"",
        ),
        (
            "[[measurement]]\nfile = \"a.csv\"\ndof = \"2-Z\"\nquantity = \"accelerance\"\n[[measurement]]",
            "[measurement]",
            "case.toml:20:1: measurement: expected at least one table [[measurement]], found [measurement]",
        ),
        ("file = \"a.csv\"\n", "", "case.toml:20:1: measurement: expected the key \"file\", found none"),
        (
            "dof = \"2-Z\"\n",
            "",
            "case.toml:20:1: measurement: expected the key \"dof\" or \"row\", because no file says where it was measured, found none",
        ),
        (
            "quantity = \"accelerance\"\n",
            "",
            "case.toml:20:1: measurement: expected the key \"quantity\" (receptance, mobility or accelerance), because the file does not say, found none",
        ),
        (
            "band_hz = [10.0, 30.0]\n",
            "",
            "case.toml:28:1: identify: expected the key \"band_hz\", found none",
        ),
        (
            "storage = [1e5, 1e6]",
            "storag = [1e6, 1e5]",
            "case.toml:32:12: identify.bounds: expected a known key, of which \"storage\" is nearest, found \"storag\"",
        ),
        (
            "reference = {",
            "reference = { storage = 1, ",
            "case.toml:33:15: identify.reference: expected a known key (law, e0, e1, alpha), found \"storage\"",
        ),
        (
            "[identify]\nmatrix",
            "[identify]\nmodel_error = \"none\"\nmatrix",
            "case.toml:29:1: identify: expected a known key (name, matrix, powers, varies, law, branches, nominal, bounds, real, reference, band_hz, exclude_hz, max_lines, reject_outliers, check, method, order, selection, reduction, start); model_error belongs to the top of the file, before the first table, found \"model_error\"",
        ),
        ("e1 = 2.0e4, ", "", "case.toml:33:13: identify.reference: expected the key \"e1\", found none"),
        (
            "[identify]\nmatrix = \"springs\"",
            "[identify]",
            "case.toml:28:1: identify: expected the key matrix (whose factor is unknown) or powers (a dimension), found none",
        ),
        (
            "[[measurement]]\nfile = \"b.csv\"",
            "[[measurment]]\nfile = \"b.csv\"",
            "case.toml:24:3: expected a known key, of which \"measurement\" is nearest, found \"measurment\"",
        ),
        ("points = 4\n", "", "case.toml:34:1: respond: expected the key \"points\", found none"),
        ("band_hz = [10, 40]\n", "", "case.toml:34:1: respond: expected the key \"band_hz\", found none"),
        (
            "{ table = \"modulus.csv\" }",
            "{ table = \"modulus.csv\", storage = 1 }",
            "case.toml:11:35: matrix.factor: expected a known key, of which \"storage_std\" is nearest, found \"storage\"",
        ),
        (
            "{ table = \"modulus.csv\" }",
            "{}",
            "case.toml:11:10: matrix.factor: expected the key \"storage\", found none",
        ),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn matrices_and_factors() {
    for (from, to, message) in [
        (
            "role = \"stiffness\"",
            "role = \"stifness\"",
            "case.toml:4:1: matrix.role: expected \"stiffness\", \"mass\" or \"viscous\", found \"stifness\"",
        ),
        (
            "loss_factor = 0.1 }",
            "loss_factor = inf }",
            "case.toml:6:29: matrix.factor.loss_factor: expected a finite number, found inf",
        ),
        (
            "factor = { storage = 2.0e5, loss_factor = 0.1 }",
            "factor = true",
            "case.toml:6:1: matrix.factor: expected a finite number, { storage = ..., loss_factor = ... }, { law = \"fractional\", e0 = ..., e1 = ..., alpha = ... }, { law = \"zener\", ... }, { law = \"maxwell\", ... } or { table = \"file\" }, found true",
        ),
        (
            "factor = { storage = 2.0e5, loss_factor = 0.1 }",
            "factor = { storage = 1e300, loss_factor = 1e300 }",
            "case.toml:6:10: matrix.factor: expected a finite storage * loss_factor, found 1e300 * 1e300",
        ),
        (
            "name = \"core\"",
            "name = \"springs\"",
            "case.toml:8:1: matrix.name: expected a name of its own for each matrix, found \"springs\" a second time",
        ),
        (
            "file = \"K.mtx\"",
            "file = \"missing.mtx\"",
            "case.toml:5:1: matrix.file: expected a file at missing.mtx, found none",
        ),
        (
            "file = \"K.mtx\"",
            "file = \"\"",
            "case.toml:5:1: matrix.file: expected the path of a file, found an empty text",
        ),
        (
            "file = \"K.mtx\"",
            "file = \"a.csv\"",
            "a.csv: expected a matrix (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB), found a table (CSV)\nnamed in case.toml:5:1: matrix.file",
        ),
        (
            "file = \"K.mtx\"",
            "file = 3",
            "case.toml:5:1: matrix.file: expected a text in quotes or { file = \"...\", name = \"...\" }, found 3",
        ),
        (
            "file = \"K.mtx\"",
            "file = { file = \"K.mtx\", name = \"KAA\" }",
            "K.mtx: expected no name beside a file that names no matrix, found KAA\nnamed in case.toml:5:10: matrix.file.file",
        ),
        (
            "file = \"K.mtx\"",
            "file = { name = \"KAA\" }",
            "case.toml:5:8: matrix.file: expected the key \"file\", found none",
        ),
        (
            "name = \"core\"",
            "name = 1979-05-27",
            "case.toml:8:1: matrix.name: expected a text in quotes, found the date 1979-05-27",
        ),
        (
            "{ table = \"modulus.csv\" }",
            "{ table = \"K.mtx\" }",
            "K.mtx:1: expected a column \"frequency_hz\", found only \"%%MatrixMarket matrix coordinate real sy\"...\nnamed in case.toml:11:12: matrix.factor.table",
        ),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn what_is_known_of_the_model() {
    let table = "{ table = \"modulus.csv\" }";
    for (from, to, message) in [
        (
            "loss_factor = 0.1 }",
            "loss_factor = 0.1, storage_std = \"2 %\" }",
            "case.toml:6:48: matrix.factor.storage_std: expected a standard deviation of a known factor, found one of \"springs\", which is unknown",
        ),
        (
            table,
            "{ table = \"modulus.csv\", storage_std = 0.3 }",
            "case.toml:11:35: matrix.factor.storage_std: expected a text as \"2 %\", for a factor that varies, found 0.3",
        ),
        (
            table,
            "{ storage = 15.0, loss_factor = 0.1, storage_std = \"2\" }",
            "case.toml:11:47: matrix.factor.storage_std: expected a number above 0 in the unit of storage, or a text as \"2 %\", found the text \"2\"",
        ),
        (
            table,
            "{ storage = 15.0, loss_factor = 0.1, loss_factor_std = -0.1 }",
            "case.toml:11:47: matrix.factor.loss_factor_std: expected a number above 0, or a text as \"20 %\" of a constant loss factor, found -0.1",
        ),
        (
            "file = \"M.mtx\"",
            "file = \"M.mtx\"\nfactor = { storage = 1.0, loss_factor = 0.0, loss_factor_std = 0.1 }",
            "case.toml:16:46: matrix.factor.loss_factor_std: expected loss_factor_std of a stiffness, found that of a mass or a damping",
        ),
        (
            "title = \"Three masses\"",
            "model_error = \"non\"",
            "case.toml:1:1: model_error: expected \"estimated\", \"none\", a number above 0 up to 0.5, or a text as \"0.5 %\", found the text \"non\"",
        ),
        (
            "[identify]",
            "[model_error]\nfrequency = 3\n[identify]",
            "case.toml:29:1: model_error.frequency: expected a number above 0 up to 0.5, or a text as \"0.5 %\", found 3",
        ),
        (
            "[identify]",
            "[model_error]\n[identify]",
            "case.toml:28:1: model_error: expected one of the keys frequency, shape and calibration, found none",
        ),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn loads_and_measurements() {
    for (from, to, message) in [
        (
            "dof = \"1+Z\"",
            "dof = \"1+Z\"\nrow = 1",
            "case.toml:20:1: load.row: expected either dof or row, found both",
        ),
        (
            "dof = \"1+Z\"",
            "dof = \"1+Z\"\nfile = \"f.csv\"",
            "case.toml:20:1: load.file: expected one of dof, row and file, found two of them",
        ),
        ("dof = \"1+Z\"", "row = 0", "case.toml:19:1: load.row: expected 1 to 3, found 0"),
        ("dof = \"1+Z\"", "row = 4", "case.toml:19:1: load.row: expected 1 to 3, found 4"),
        ("dof = \"1+Z\"", "row = -1", "case.toml:19:1: load.row: expected 1 to 3, found -1"),
        (
            "dof = \"1+Z\"",
            "file = \"f.csv\"",
            "case.toml:19:1: load.file: expected a file at f.csv, found none",
        ),
        ("dof = \"1+Z\"", "file = \".\"", "case.toml:19:1: load.file: expected a file at ., found a folder"),
        (
            "dof = \"1+Z\"",
            "file = \"a.csv\"",
            "a.csv:1:1: expected one of the columns row, re, im, found \"frequency_hz\"\nnamed in case.toml:19:1: load.file",
        ),
        (
            "dof = \"1+Z\"",
            "dof = \"1Z\"",
            "case.toml:19:1: load.dof: expected a node, a sign and a direction such as 12+Z or 7-RX, found \"1Z\"",
        ),
        (
            "dof = \"1+Z\"",
            "dof = \"1+X\"",
            "case.toml:19:1: load.dof: expected a degree of freedom that [dofs] names, found 1+X (node 1 has Z)",
        ),
        (
            "dof = \"1+Z\"",
            "dof = \"7+X\"",
            "case.toml:19:1: load.dof: expected a degree of freedom that [dofs] names, found 7+X (no node 7; the nearest is 2 with Z, RX)",
        ),
        (
            "quantity = \"accelerance\"",
            "quantity = \"inertance\"",
            "case.toml:23:1: measurement.quantity: expected \"receptance\", \"mobility\" or \"accelerance\", found \"inertance\"",
        ),
        (
            "quantity = \"accelerance\"",
            "quantity = \"accelerance\"\naverages = 1",
            "case.toml:24:1: measurement.averages: expected a whole number from 2 on: the coherence of one record is always 1, found 1",
        ),
        (
            "quantity = \"accelerance\"",
            "quantity = \"accelerance\"\nrecord = 2",
            "a.csv: expected no record number, or 1: a table has one FRF, found 2\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "quantity = \"accelerance\"",
            "quantity = \"accelerance\"\ncolumns = []",
            "case.toml:24:1: measurement.columns: expected a list of names such as [\"frequency_hz\", \"magnitude\", \"phase_deg\", \"-\"], found the list []",
        ),
        (
            "quantity = \"accelerance\"",
            "quantity = \"accelerance\"\ncolumns = [\"f\", \"re\", \"im\"]",
            "a.csv:1: expected 3 columns, one for each name, found 4\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            "dof = \"1+Z\"",
            "file = \"dofs.csv\"",
            "dofs.csv:1:5: expected one of the columns row, re, im, found \"node\"\nnamed in case.toml:19:1: load.file",
        ),
        ("row = 3", "row = 1.0", "case.toml:26:1: measurement.row: expected a whole number, found 1.0"),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn options_and_bands() {
    for (from, to, message) in [
        (
            "order = 20",
            "order = 20\nmax_lines = 2",
            "case.toml:32:1: identify.max_lines: expected a whole number of at least 3, found 2",
        ),
        (
            "order = 20",
            "order = \"20\"",
            "case.toml:31:1: identify.order: expected a whole number, found the text \"20\"",
        ),
        ("order = 20", "order = 20.5", "case.toml:31:1: identify.order: expected a whole number, found 20.5"),
        ("order = 20", "order = -3", "case.toml:31:1: identify.order: expected 1 to 200, found -3"),
        ("order = 20", "order = 201", "case.toml:31:1: identify.order: expected 1 to 200, found 201"),
        (
            "order = 20",
            "order = 99999999999999999999",
            "case.toml:31:1: identify.order: expected a whole number, found 99999999999999999999",
        ),
        (
            "matrix = \"springs\"",
            "matrix = \"spring\"",
            "case.toml:29:1: identify.matrix: expected a matrix of the case (\"springs\", \"core\", \"mass\"), found \"spring\"; did you mean \"springs\"?",
        ),
        (
            "matrix = \"springs\"",
            "matrix = []",
            "case.toml:29:1: identify.matrix: expected a text in quotes or a list of at least one, found the list []",
        ),
        (
            "matrix = \"springs\"",
            "matrix = [\"springs\", 3]",
            "case.toml:29:22: identify.matrix: expected a text in quotes, found 3",
        ),
        (
            "matrix = \"springs\"",
            "matrix = [\"springs\", \"springs\"]",
            "case.toml:29:22: identify.matrix: expected each matrix once, found \"springs\" a second time",
        ),
        (
            "matrix = \"springs\"",
            "matrix = [\"springs\", \"core\"]",
            "case.toml:29:22: identify.matrix: expected matrices with one factor, that of \"springs\", found \"core\" with another",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [30.0, 10.0]",
            "case.toml:30:1: identify.band_hz: expected two frequencies [low, high] in Hz with 0 <= low <= high, found [30, 10]",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [10.0]",
            "case.toml:30:1: identify.band_hz: expected two finite numbers [low, high], found the list [10.0]",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [nan, 30.0]",
            "case.toml:30:1: identify.band_hz: expected two finite numbers [low, high], found the list [nan, 30.0]",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [-10, 30.0]",
            "case.toml:30:1: identify.band_hz: expected two frequencies [low, high] in Hz with 0 <= low <= high, found [-10, 30]",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [11.0, 12.0]",
            "case.toml:30:1: identify.band_hz: expected a band with frequencies of a.csv (0 to 40 Hz in 4 steps), found [11, 12]",
        ),
        (
            "band_hz = [10.0, 30.0]",
            "band_hz = [1000.0, 2000.0]",
            "case.toml:30:1: identify.band_hz: expected a band with frequencies of a.csv (0 to 40 Hz in 4 steps), found [1000, 2000]",
        ),
        (
            "[[measurement]]\nfile = \"b.csv\"\nrow = 3\nquantity = \"receptance\"\n[identify]\nmatrix = \"springs\"\nband_hz = [10.0, 30.0]",
            "[identify]\nmatrix = \"springs\"\nband_hz = [0.0, 30.0]",
            "case.toml:26:1: identify.band_hz: expected a band in which accelerance can be converted to receptance, found 0 Hz in it",
        ),
        (
            "order = 20",
            "method = \"newton\"",
            "case.toml:31:1: identify.method: expected \"series\", \"rational\" or \"nelder-mead\", found \"newton\"",
        ),
        (
            "order = 20",
            "method = \"series\"\nselection = \"joint\"",
            "case.toml:32:1: identify.selection: expected \"smallest\" with method \"series\", found \"joint\"",
        ),
        ("order = 20", "start = 2e5", "case.toml:31:1: identify.start: expected a text in quotes, found 2e5"),
        (
            "order = 20",
            "start = \"guess\"",
            "case.toml:31:1: identify.start: expected \"bounds\" (a nominal value is the factor of the matrix), found \"guess\"",
        ),
        (
            "order = 20",
            "selection = \"best\"",
            "case.toml:31:1: identify.selection: expected \"joint\" or \"smallest\", found \"best\"",
        ),
        (
            "storage = [1e5, 1e6]",
            "storage = [1e6, 1e5]",
            "case.toml:32:12: identify.bounds.storage: expected [low, high] with low <= high, found [1000000, 100000]",
        ),
        (
            "alpha = 0.5",
            "alpha = 5",
            "case.toml:33:59: identify.reference.alpha: expected a number from 0 (elastic) to 1 (viscous), found 5",
        ),
        (
            "alpha = 0.5",
            "alpha = inf",
            "case.toml:33:59: identify.reference.alpha: expected a finite number, found inf",
        ),
        (
            "law = \"fractional\"",
            "law = \"fractal\"",
            "case.toml:33:15: identify.reference.law: expected \"fractional\", \"zener\" or \"maxwell\", found \"fractal\"",
        ),
        (
            "reference = { law = \"fractional\", e0 = 1.0e5, e1 = 2.0e4, alpha = 0.5 }",
            "reference = \"x.csv\"",
            "case.toml:33:1: identify.reference: expected a finite number, { storage = ..., loss_factor = ... }, { law = \"fractional\", e0 = ..., e1 = ..., alpha = ... }, { law = \"zener\", ... }, { law = \"maxwell\", ... } or { table = \"file\" }, found the text \"x.csv\"",
        ),
        ("points = 4", "points = 0", "case.toml:36:1: respond.points: expected 1 to 1000000, found 0"),
        (
            "points = 4",
            "points = 2000000",
            "case.toml:36:1: respond.points: expected 1 to 1000000, found 2000000",
        ),
        ("order = 20", "real = 1", "case.toml:31:1: identify.real: expected true or false, found 1"),
        (
            "order = 20",
            "order = [1, \"a\", [], {}, 5]",
            "case.toml:31:1: identify.order: expected a whole number, found the list [1, the text \"a\", the list [], a table, ...]",
        ),
        (
            "storage = [1e5, 1e6]",
            "storage = 1e5",
            "case.toml:32:12: identify.bounds.storage: expected two finite numbers [low, high], found 1e5",
        ),
        (
            "order = 20",
            "order = 20\nvaries = \"constant\"",
            "case.toml:31:1: identify.order: expected nothing here: several unknowns, constants and negative powers have one method only, found a choice",
        ),
        (
            "e1 = 2.0e4",
            "e1 = 1e308",
            "case.toml:33:13: identify.reference: expected a factor with a value at 10 Hz, found inf+infi",
        ),
    ] {
        refused("case.toml", &edited("case.toml", from, to), message);
    }
}

#[test]
fn cases_without_the_main_things() {
    for (text, message) in [
        ("", "case.toml: expected at least one table [[matrix]], found none"),
        ("title = \"only a title\"\n", "case.toml: expected at least one table [[matrix]], found none"),
        (
            "matrix = []\n",
            "case.toml:1:1: matrix: expected at least one table [[matrix]], found an empty list",
        ),
        ("matrix = 3\n", "case.toml:1:1: matrix: expected at least one table [[matrix]], found 3"),
        ("[[matrix]]\n", "case.toml: expected at least one table [[measurement]], found none"),
    ] {
        refused("case.toml", text, message);
    }
}

#[test]
fn a_case_that_is_no_text_or_no_file() {
    let bytes = b"title = \"ok\"\nx = \xff".as_slice();
    let error = with("case.toml", bytes, &Overrides::default(), Purpose::Identify).unwrap_err();
    assert!(
        error.to_string().ends_with("case.toml:2:5: expected text in UTF-8, found the byte 0xFF"),
        "{error}"
    );
    let folder = folder("case.toml", None);
    for (name, found) in [("case.toml", "none"), ("", "a folder")] {
        let path = folder.path().join(name);
        let error = load(&path, &Overrides::default(), Purpose::Identify).unwrap_err();
        assert_eq!(error.to_string(), format!("{}: expected a case file, found {found}", path.display()));
    }
}

#[test]
fn what_the_command_line_says_is_checked_like_the_case() {
    let none = Overrides::default;
    for (overrides, expected) in [
        (
            Overrides { method: Some("joint".into()), ..none() },
            "--method: expected \"series\", \"rational\" or \"nelder-mead\", found \"joint\"",
        ),
        (
            Overrides { selection: Some("best".into()), ..none() },
            "--selection: expected \"joint\" or \"smallest\", found \"best\"",
        ),
        (
            Overrides { selection: Some("joint".into()), method: Some("series".into()), ..none() },
            "--selection: expected \"smallest\" with method \"series\", found \"joint\"",
        ),
        (
            Overrides { reduction: Some("half".into()), ..none() },
            "--reduction: expected \"auto\", \"full\" or \"subspace\", found \"half\"",
        ),
        (Overrides { order: Some(0), ..none() }, "--order: expected 1 to 200, found 0"),
        (
            Overrides { band_hz: Some([3.0, 2.0]), ..none() },
            "--band: expected two frequencies [low, high] in Hz with 0 <= low <= high, found [3, 2]",
        ),
        (
            Overrides { band_hz: Some([3.0, f64::NAN]), ..none() },
            "--band: expected two frequencies [low, high] in Hz with 0 <= low <= high, found [3, NaN]",
        ),
        (
            Overrides { band_hz: Some([41.0, 50.0]), ..none() },
            "--band: expected a band with frequencies of a.csv (0 to 40 Hz in 4 steps), found [41, 50]",
        ),
    ] {
        let folder = folder("", None);
        let error = load(&folder.path().join("case.toml"), &overrides, Purpose::Identify).unwrap_err();
        assert_eq!(message(&folder, &error), expected);
    }
}

#[test]
fn nesting_without_end_is_refused() {
    let text = format!("title = {}", "[".repeat(100_000));
    let error = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap_err();
    assert!(error.found.contains("recursion depth"), "{error}");
}
