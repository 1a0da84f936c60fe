//! Any bytes are listed, summed up, read or refused; and a function that is read can be written and read again.
#![no_main]

use frfit_formats::uff::{self, DataType, Endian, Form, Function, FunctionHeader, Values};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = uff::File::new(bytes) else { return };
    for index in 0..file.entries().len() {
        let _ = file.record(index);
        let _ = file.summary(index);
        if let Ok(function) = file.function(index) {
            check_copies(function);
        }
    }
});

fn check_copies(function: Function) {
    let function = Function { header: writable(&function), ..function };
    let first = copy(&function, Endian::Little);
    assert_eq!(bits(&function), bits(&first));
    // Minimum, increment and third coordinate have as many digits as fit their columns.
    let FunctionHeader { spacing, z_value, .. } = first.header;
    assert_eq!(FunctionHeader { spacing, z_value, ..function.header }, first.header);

    // What has been written once fits.
    let second = copy(&first, Endian::Big);
    assert_eq!(first.header, second.header);
    assert_eq!(bits(&first), bits(&second));
    assert_eq!(first.abscissa.len(), second.abscissa.len());
    assert!(uff::write::function(&first, Form::Ascii).is_ok());
}

/// The header with the points that are there, in double precision: numbers in text are not those of single.
fn writable(function: &Function) -> FunctionHeader {
    let data_type = match function.values {
        Values::Real(_) => DataType::RealDouble,
        Values::Complex(_) => DataType::ComplexDouble,
    };
    FunctionHeader { data_type, points: function.values.len(), ..function.header.clone() }
}

fn copy(function: &Function, endian: Endian) -> Function {
    let bytes = uff::write::function(function, Form::Binary { endian }).expect("a writable function");
    uff::File::new(&bytes).and_then(|file| file.function(0)).expect("a readable copy")
}

/// All stored numbers as bits, so that not-a-number is equal to itself.
fn bits(function: &Function) -> Vec<u64> {
    let stored = function.header.spacing == uff::Spacing::Uneven;
    let abscissa = function.abscissa.iter().filter(|_| stored).copied();
    let values: Vec<f64> = match &function.values {
        Values::Real(values) => values.clone(),
        Values::Complex(values) => values.iter().flat_map(|value| [value.re, value.im]).collect(),
    };
    abscissa.chain(values).map(f64::to_bits).collect()
}
