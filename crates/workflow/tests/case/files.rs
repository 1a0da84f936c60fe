//! A small complete case: three masses on springs, and what becomes of it when one text in it is replaced.

use frfit_workflow::error::InputError;
use frfit_workflow::load::{Case, Overrides, Purpose, load};
use std::fs;
use tempfile::TempDir;

pub(crate) const CASE: &str = r#"title = "Three masses"
[[matrix]]
name = "springs"
role = "stiffness"
file = "K.mtx"
factor = { storage = 2.0e5, loss_factor = 0.1 }
[[matrix]]
name = "core"
role = "stiffness"
file = "core.mtx"
factor = { table = "modulus.csv" }
[[matrix]]
name = "mass"
role = "mass"
file = "M.mtx"
[dofs]
file = "dofs.csv"
[load]
dof = "1+Z"
[[measurement]]
file = "a.csv"
dof = "2-Z"
quantity = "accelerance"
[[measurement]]
file = "b.csv"
row = 3
quantity = "receptance"
[identify]
matrix = "springs"
band_hz = [10.0, 30.0]
order = 20
bounds = { storage = [1e5, 1e6], loss_factor = [0.0, 1.0] }
reference = { law = "fractional", e0 = 1.0e5, e1 = 2.0e4, alpha = 0.5 }
[respond]
band_hz = [10, 40]
points = 4
"#;

/// All files of the case.
pub(crate) const FILES: [(&str, &str); 8] = [
    ("case.toml", CASE),
    (
        "K.mtx",
        "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 1 -1\n2 2 2\n3 2 -1\n3 3 1\n",
    ),
    ("core.mtx", "%%MatrixMarket matrix coordinate real general\n3 3 4\n1 1 1\n1 3 -1\n3 1 -1\n3 3 1\n"),
    ("M.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 1.5\n2 2 1.5\n3 3 0.5\n"),
    ("modulus.csv", "frequency_hz,storage,loss_factor\n1,10,0.1\n100,20,0.2\n"),
    ("dofs.csv", "row,node,direction\n1,1,Z\n2,2,Z\n3,2,RX\n"),
    ("a.csv", "frequency_hz,re,im,std\n0,0,0,1\n10,1,-1,0.5\n20,2,-1,0.5\n30,3,-1,0.5\n40,4,-1,0.5\n"),
    ("b.csv", "frequency_hz,re,im,coherence\n10,1,0,0.9\n20,2,0,0.8\n30,3,0,1\n"),
];

/// Writes the case with one file's text replaced, or the file left out where there is none.
pub(crate) fn folder(name: &str, bytes: Option<&[u8]>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (file, text) in FILES {
        match bytes {
            _ if file != name => fs::write(folder.path().join(file), text).unwrap(),
            Some(bytes) => fs::write(folder.path().join(file), bytes).unwrap(),
            None => {}
        }
    }
    folder
}

/// Loads the case with one file's text replaced.
pub(crate) fn with(
    name: &str,
    bytes: &[u8],
    overrides: &Overrides,
    purpose: Purpose,
) -> Result<Case, InputError> {
    let folder = folder(name, Some(bytes));
    load(&folder.path().join("case.toml"), overrides, purpose)
}

/// A file of the case with the first occurrence of one text replaced by another.
pub(crate) fn edited(name: &str, from: &str, to: &str) -> String {
    let text = FILES.iter().find(|(file, _)| *file == name).unwrap().1;
    assert!(text.contains(from), "{name} does not contain {from:?}");
    text.replacen(from, to, 1)
}

/// The message of an error, with the folder's path left out.
pub(crate) fn message(folder: &TempDir, error: &InputError) -> String {
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}

/// Asserts what is said about the case with one file's text replaced.
pub(crate) fn refused(name: &str, text: &str, expected: &str) {
    let folder = folder(name, Some(text.as_bytes()));
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify);
    assert_eq!(message(&folder, &case.expect_err(expected)), expected, "{name}:\n{text}");
}
