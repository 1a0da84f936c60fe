//! No reader of binary files takes memory for what a header promises and the file does not hold.

use frfit_formats::{mat, numpy, op4};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// A file of a few hundred bytes: whatever a reader needs for itself is far below, what the headers promise far above.
const MOST: usize = 200_000;

// One test, because the count is for the whole process.
#[test]
fn memory_is_not_taken_for_promises() {
    for (name, bytes) in files() {
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let is_read = match name {
            "op4" => op4::read(&bytes).is_ok_and(|all| all[0].matrix.is_ok()),
            "numpy" => numpy::read(&bytes).is_ok_and(|all| all[0].matrix.is_ok()),
            _ => mat::read(&bytes).is_ok_and(|all| all[0].matrix.is_ok()),
        };
        let used = MEMORY.peak_usage() - before;
        assert!(used < MOST, "{name}: {used} bytes");
        // Nothing of such a file may be taken for a matrix.
        assert!(!is_read, "{name}");
    }
}

fn files() -> Vec<(&'static str, Vec<u8>)> {
    let integers = |numbers: &[i32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let record = |body: Vec<u8>| {
        [integers(&[body.len() as i32]), body.clone(), integers(&[body.len() as i32])].concat()
    };
    let head = record([integers(&[2_000_000_000, 2_000_000_000, 2, 2]), b"KAA     ".to_vec()].concat());
    let dense = [integers(&[1, 1, 2_000_000_000]), vec![0; 80]].concat();
    let text = "200000002000000000       2       2KAA     1P,3E23.16\n       1       120000000\n 1.0000000000000000E+00\n";
    let sparse = "20000000-2000000       2       2KAA     1P,3E23.16\n       1       090000000\n80000001       1\n 1.0000000000000000E+00\n";
    let array = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        [
            b"\x93NUMPY\x01\x00".to_vec(),
            (header.len() as u16).to_le_bytes().to_vec(),
            header.into_bytes(),
            vec![0; 80],
        ]
        .concat()
    };
    let matlab = |class: i32, length: i32| {
        let mut bytes = vec![b' '; 124];
        bytes.extend(b"\x00\x01IM");
        bytes.extend(integers(&[14, 160, 6, 8, class, 2_000_000_000, 5, 8, 2_000_000_000, 2_000_000_000]));
        bytes.extend(integers(&[1 | 1 << 16, i32::from(b'K'), 5, length]));
        bytes.extend([0; 200]);
        bytes
    };
    vec![
        ("op4", [head.clone(), record(dense)].concat()),
        ("op4", [head, integers(&[2_000_000_000]), vec![0; 80]].concat()),
        ("op4", text.into()),
        ("op4", sparse.into()),
        ("numpy", array("(2000000000, 2000000000)")),
        ("numpy", array("(4000000000000000000, 0)")),
        ("numpy", array("(2000000000,)")),
        ("mat", matlab(6, 8)),
        ("mat", matlab(5, 8)),
        ("mat", matlab(5, 2_000_000_000)),
        ("mat", matlab(2, 2_000_000_000)),
    ]
}
