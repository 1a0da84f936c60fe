//! Any bytes are read or refused; a file that is read can be written and read back equal.

#![no_main]

use frfit_formats::lvm::{Lvm, read, write};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = read(bytes) else { return };
    // Texts with replaced bytes or inner blanks of other kinds, and mixed abscissae, may be refused by the writer.
    let Ok(written) = write(&file) else { return };
    let again = read(written.as_bytes()).unwrap();
    assert_eq!(channels(&file), channels(&again));
});

fn channels(file: &Lvm) -> Vec<&[frfit_formats::lvm::Channel]> {
    file.segments.iter().map(|segment| &segment.channels[..]).collect()
}
