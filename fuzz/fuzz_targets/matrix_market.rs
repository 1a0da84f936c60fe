//! What the Matrix Market reader accepts is valid, and can be written and read back equal.

#![no_main]

use frfit_formats::matrix_market;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(matrix) = matrix_market::read(bytes) {
        let written = matrix_market::write(&matrix).unwrap();
        assert_eq!(matrix_market::read(&written), Ok(matrix));
    }
});
