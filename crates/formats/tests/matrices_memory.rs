//! No reader takes more than 16 times its input plus 1 MB, whatever the header promises.

use frfit_formats::{FormatError, abaqus, ansys, csv, dmig, harwell_boeing, matrix_market, triplets};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// So many lines or fields that the bound of 16 bytes each outweighs the megabyte.
const LARGE: usize = 400_000;

// One test, because the count is for the whole process.
#[test]
fn memory_is_bounded_by_the_bytes_that_are_there() {
    for (name, text) in matrix_market_files() {
        bounded(name, &text, matrix_market::read);
    }
    for (name, text) in harwell_boeing_files() {
        bounded(name, &text, harwell_boeing::read_with_rhs);
    }
    for (name, text) in files_with_labels() {
        bounded(name, &text, triplets::read);
        bounded(name, &text, triplets::read_dofs);
        bounded(name, &text, abaqus::read);
        bounded(name, &text, dmig::read);
        bounded(name, &text, ansys::read_mapping);
    }
    for (name, text) in tables() {
        bounded(name, &text, csv::Table::read);
        bounded(name, &text, csv::read_frf);
        bounded(name, &text, csv::read_vector);
        bounded(name, &text, csv::read_dof_names);
        bounded(name, &text, csv::read_modulus);
    }
}

/// Reads, keeping the result until the peak is taken.
fn bounded<T>(name: &str, text: &str, read: impl Fn(&[u8]) -> Result<T, FormatError>) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let result = read(text.as_bytes());
    let used = MEMORY.peak_usage() - before;
    let bound = 16 * text.len() + 1_000_000;
    assert!(used <= bound, "{name}: {used} bytes for {} of input", text.len());
    drop(result);
}

fn matrix_market_files() -> Vec<(&'static str, String)> {
    let file = |kind: &str, size: &str, line: &str, count: usize| {
        format!("%%MatrixMarket matrix {kind}\n{size}\n{}", line.repeat(count))
    };
    let descending: String = (0..LARGE).map(|k| format!("{} 1\n", 1 + (LARGE - k) % 9)).collect();
    let distinct: String =
        (0..LARGE).rev().map(|k| format!("{} {} 1\n", k % 1000 + 1, k / 1000 + 1)).collect();
    vec![
        ("rows", file("coordinate real general", "2147483647 2147483647 1", "1 1 1\n", 1)),
        ("entries", file("coordinate complex general", "9 9 2147483647", "1 1 1 1\n", LARGE)),
        ("array", file("array real general", "2147483647 2147483647", "1\n", LARGE)),
        ("full array", file("array real general", "1000 400", "1\n", LARGE)),
        ("full complex array", file("array complex symmetric", "800 800", "1 1\n", 800 * 801 / 2)),
        ("pattern of one place", file("coordinate pattern general", "9 9 400000", "1 1\n", LARGE)),
        ("pattern out of order", file("coordinate pattern general", "9 9 400000", "", 0) + &descending),
        ("entries out of order", file("coordinate real general", "1000 400 400000", "", 0) + &distinct),
        ("comments", file("coordinate real general", "%", "%\n", LARGE)),
        (
            "one long comment",
            file("coordinate real general", &format!("%{}", "\u{e9}".repeat(LARGE)), "1 1 0\n", 1),
        ),
        (
            "one long number",
            file("coordinate real general", "1 1 1", &format!("1 1 {}\n", "7".repeat(LARGE)), 1),
        ),
    ]
}

fn harwell_boeing_files() -> Vec<(&'static str, String)> {
    let file = |kind: &str, sizes: [usize; 3], formats: &str, counts: [usize; 4], body: &str| {
        let total: usize = counts.iter().sum();
        let ([rows, cols, entries], [a, b, c, d]) = (sizes, counts);
        format!(
            "T\n{total:14}{a:14}{b:14}{c:14}{d:14}\n{kind:<14}{rows:14}{cols:14}{entries:14}\n{formats}\n{body}"
        )
    };
    // The densest file there can be: nine rows of one digit in each column, values of one digit.
    let cols = LARGE / 9;
    let pointers: String = (0..=cols).map(|k| format!("{:6}\n", 9 * k + 1)).collect();
    let dense = |rows: &str, values: &str| {
        let indices = format!("{rows}\n").repeat(cols);
        let values = if values.is_empty() { String::new() } else { format!("{values}\n").repeat(cols) };
        pointers.clone() + &indices + &values
    };
    let counts = |values| [cols + 1, cols, values, 0];
    let size = [9, cols, 9 * cols];
    let ones = "1\n".repeat(LARGE);
    let (many, more) = (2_000_000_000, 2_000_000_001);
    vec![
        ("columns", file("RUA", [9, many, 1], "(I1)(I1)(F1.0)", [more, 1, 1, 0], "1\n2\n1\n1\n")),
        ("entries", file("RUA", [9, 1, many], "(I1)(I1)(F1.0)", [2, many, many, 0], "1\n2\n1\n1\n")),
        ("pattern", file("PRA", size, "(I6)(9I1)", counts(0), &dense("123456789", ""))),
        ("dense", file("RRA", size, "(I6)(9I1)(9F1.0)", counts(cols), &dense("987654321", "123456789"))),
        (
            "dense complex",
            file("CRA", size, "(I6)(9I1)(18F1.0)", counts(cols), &dense("987654321", "123456789123456789")),
        ),
        (
            "duplicates",
            file(
                "PRA",
                [9, 1, LARGE],
                "(I6)(I1)",
                [2, LARGE, 0, 0],
                &format!("     1\n{:6}\n{ones}", LARGE + 1),
            ),
        ),
        (
            "right-hand sides",
            file(
                "RRA",
                [LARGE, 9, 0],
                "(10I1)(I1)(F1.0)(F1.0)\nF                          1",
                [1, 0, 0, LARGE],
                &format!("1111111111\n{ones}"),
            ),
        ),
        ("repeats", file("RUA", [1, 1, 1], "(999(999(999I1)))(99999I1)(F1.0)", [1, 1, 1, 0], "1\n2\n1\n")),
    ]
}

fn files_with_labels() -> Vec<(&'static str, String)> {
    let lines = |head: &str, line: &dyn Fn(usize) -> String| {
        format!("{head}{}", (1..=LARGE).map(line).collect::<String>())
    };
    let (symmetric, complex) = ("DMIG,K,0,6,1\nDMIG,K,1\n", "DMIG,K,0,1,4\nDMIG,K,1\n");
    vec![
        ("triplets on one row", lines("", &|k| format!("1 {k} 1.\n"))),
        (
            "triplets out of order",
            lines("", &|k| format!("{} {} 1.\n", (LARGE - k) % 700 + 1, k / 700 + 701)),
        ),
        (
            "both triangles",
            lines("", &|k| {
                let (i, j) = (k / 2 % 9, k / 2 / 9 + 9);
                let (i, j) = if k % 2 == 0 { (i, j) } else { (j, i) };
                format!("{} {} 1.\n", i + 1, j + 1)
            }),
        ),
        ("a triplet far out", "1 2147483647 1.\n".into()),
        ("labels", lines("", &|k| format!("1,1,{k},1,1.\n"))),
        ("fixed", lines("", &|k| format!("{k},1,{k},1,1E36\n"))),
        ("names of rows", lines("", &|k| format!("{k}.1\n"))),
        ("comments", "**\n".repeat(LARGE)),
        ("a title", format!("** {}\n1 1 1.\n", "\u{e9}".repeat(LARGE))),
        ("a column", lines(symmetric, &|k| format!("+,{k},,1.\n"))),
        ("a column in a row", lines(symmetric, &|k| format!("+,{},,1.,,{},,1.\n", 2 * k, 2 * k + 1))),
        ("a complex column", lines(complex, &|k| format!("+,{k},,1.,1.\n"))),
        ("columns", lines(symmetric, &|k| format!("DMIG,K,{k},,,{k},,1.\n"))),
        ("a huge NCOL", "DMIG,K,0,9,1,,,,2147483647\nDMIG,K,1,,,1,1,1.\n".into()),
        ("headers", lines("", &|k| format!("DMIG,A{k},0,6,1\n"))),
        ("blank cards", "DMIG\n".repeat(LARGE)),
        ("mapping", lines("Matrix Eqn Node DOF\n", &|k| format!("{k} {k} UX\n"))),
    ]
}

fn tables() -> Vec<(&'static str, String)> {
    let lines = |names: &str, line: &dyn Fn(usize) -> String| {
        format!("{names}\n{}", (1..LARGE / 8).map(line).collect::<String>())
    };
    vec![
        ("names", ",".repeat(LARGE)),
        ("short names", "a,".repeat(LARGE)),
        ("empty rows", "\"\"\n".repeat(LARGE)),
        ("rows", "a\n".repeat(LARGE)),
        ("wide rows", ",,,,,,,\n".repeat(LARGE / 8)),
        ("one long name", "a".repeat(LARGE)),
        ("one open quote", format!("\"{}", "\"\"".repeat(LARGE))),
        ("response", lines("frequency_hz,re,im", &|k| format!("{k},0,0\n"))),
        ("vector", lines("row,re", &|k| format!("{k},0\n"))),
        ("dofs", lines("row,node,direction", &|k| format!("{k},{k},X\n"))),
        ("modulus", lines("frequency_hz,storage,loss", &|k| format!("{k},1,1\n"))),
    ]
}
