//! What the OUTPUT4 reader accepts is valid, and can be written and read back equal.

#![no_main]

use frfit_formats::{CoordinateMatrix, NamedMatrix, op4};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for NamedMatrix { matrix, .. } in op4::read(bytes).into_iter().flatten() {
        let Ok(matrix) = matrix else { continue };
        matrix.validate().unwrap();
        // The text has room for fewer rows than the binary form.
        if let Ok(written) = op4::write(&[("K", &matrix)]) {
            let again = op4::read(&written).unwrap().remove(0).matrix.unwrap();
            assert_eq!(CoordinateMatrix { title: matrix.title.clone(), ..again }, matrix);
        }
    }
});
