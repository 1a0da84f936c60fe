//! Inputs at the edge of what the reader accepts and the writer can write, kept where one of them once failed.

use std::fs;
use std::path::Path;

use frfit_formats::uff::{self, Endian, Form};

#[test]
fn every_kept_input_is_read_or_refused_and_what_is_read_can_be_written() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions/uff");
    for file in fs::read_dir(folder).expect("the folder of kept inputs") {
        let path = file.expect("a readable entry").path();
        let bytes = fs::read(&path).expect("a readable file");
        let Ok(file) = uff::File::new(&bytes) else { continue };
        for index in 0..file.entries().len() {
            let _ = (file.record(index), file.summary(index));
            let Ok(function) = file.function(index) else { continue };
            let form = Form::Binary { endian: Endian::Big };
            let written = uff::write::function(&function, form)
                .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let copy = uff::File::new(&written).and_then(|file| file.function(0));
            let copy = copy.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert_eq!(copy.values.len(), function.values.len(), "{}", path.display());
            assert_eq!(copy.header.id, function.header.id, "{}", path.display());
        }
    }
}
