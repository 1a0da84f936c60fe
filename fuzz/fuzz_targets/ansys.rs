//! A mapping that the reader accepts is read back equal.

#![no_main]

use frfit_formats::ansys;
use libfuzzer_sys::fuzz_target;
use std::fmt::Write;

fuzz_target!(|bytes: &[u8]| {
    let Ok(labels) = ansys::read_mapping(bytes) else { return };
    let names = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"];
    let mut text = String::from("Matrix Eqn Node DOF\n");
    for (k, label) in labels.iter().enumerate() {
        let _ = writeln!(text, "{} {} {}", k + 1, label.node, names[usize::from(label.component) - 1]);
    }
    assert_eq!(ansys::read_mapping(text.as_bytes()), Ok(labels));
});
