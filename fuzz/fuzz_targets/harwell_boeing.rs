//! What the Harwell–Boeing reader accepts is valid, and can be written and read back equal.

#![no_main]

use frfit_formats::harwell_boeing;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let with_rhs = harwell_boeing::read_with_rhs(bytes);
    if let Ok(matrix) = harwell_boeing::read(bytes) {
        if let Ok(with_rhs) = with_rhs {
            assert_eq!(with_rhs.matrix, matrix);
        }
        let written = harwell_boeing::write(&matrix).unwrap();
        assert_eq!(harwell_boeing::read(&written), Ok(matrix));
    }
});
