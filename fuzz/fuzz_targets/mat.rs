//! What the MATLAB reader accepts is valid.

#![no_main]

use frfit_formats::mat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for named in mat::read(bytes).into_iter().flatten() {
        if let Ok(matrix) = named.matrix {
            matrix.validate().unwrap();
        }
    }
});
