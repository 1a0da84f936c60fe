//! What is written is read again, and no bytes make the reader panic.

use crate::uff_support;

use frfit_formats::uff::{
    self, DataType, Dof, Endian, FileHeader, Form, Function, Node, Record, Spacing, Units, Values,
};
use proptest::prelude::*;

use uff_support::{function, variants};

fn read_back(bytes: &[u8]) -> Function {
    uff::File::new(bytes).and_then(|file| file.function(0)).expect("a readable function")
}

/// `value` with this many significant digits, as decimal text keeps them.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().expect("a number")
}

/// The function with all numbers rounded as the text form rounds them.
fn as_text(mut function: Function) -> Function {
    let ordinate = if function.header.data_type.is_double() { 13 } else { 6 };
    if function.header.spacing == Spacing::Uneven {
        function.abscissa.iter_mut().for_each(|x| *x = rounded(*x, 6));
    }
    match &mut function.values {
        Values::Real(values) => values.iter_mut().for_each(|y| *y = rounded(*y, ordinate)),
        Values::Complex(values) => values.iter_mut().for_each(|y| {
            (y.re, y.im) = (rounded(y.re, ordinate), rounded(y.im, ordinate));
        }),
    }
    function
}

/// Finite numbers that single precision holds too where they have to.
fn numbers(data_type: DataType) -> BoxedStrategy<Vec<f64>> {
    if data_type.is_double() {
        prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::ZERO, 0..40).boxed()
    } else {
        prop::collection::vec((prop::num::f32::NORMAL | prop::num::f32::ZERO).prop_map(f64::from), 0..40)
            .boxed()
    }
}

fn any_function() -> impl Strategy<Value = Function> {
    prop::sample::select(variants())
        .prop_flat_map(|(data_type, spacing)| (Just(data_type), Just(spacing), numbers(data_type)))
        .prop_map(|(data_type, spacing, numbers)| function(data_type, spacing, &numbers))
}

proptest! {
    #[test]
    fn binary_keeps_every_bit(function in any_function(), big in any::<bool>()) {
        let endian = if big { Endian::Big } else { Endian::Little };
        let bytes = uff::write::function(&function, Form::Binary { endian }).expect("a writable function");
        prop_assert_eq!(read_back(&bytes), function);
    }

    #[test]
    fn text_keeps_every_digit_of_the_format(function in any_function()) {
        let bytes = uff::write::function(&function, Form::Ascii).expect("a writable function");
        prop_assert!(bytes.split(|&byte| byte == b'\n').all(|line| String::from_utf8_lossy(line).chars().count() <= 80));
        prop_assert_eq!(read_back(&bytes), as_text(function));
    }

    #[test]
    fn header_fields_come_back(
        id in "[!-~]([ -~äß²]{0,70}[!-~])?",
        entity in "[!-~äß²]{1,10}",
        node in -999_999_999_i64..=9_999_999_999,
        direction in -6..=6_i32,
        minimum in -1e6..1e6_f64,
        increment in 1e-6..1e3_f64,
    ) {
        prop_assume!(id != "NONE" && entity != "NONE");
        let mut function = function(DataType::RealDouble, Spacing::Even { minimum, increment }, &[1.0, 2.0]);
        function.header.id[4] = id;
        function.header.response = Dof { entity, node, direction };
        function.header.reference = function.header.response.clone();
        let bytes = uff::write::function(&function, Form::Ascii).expect("a writable function");
        let read = read_back(&bytes);
        let Spacing::Even { minimum: read_minimum, increment: read_increment } = read.header.spacing else {
            return Err(TestCaseError::fail("an even spacing"));
        };
        // Six significant digits always fit, and the last of them may be off by half.
        prop_assert!((read_minimum - minimum).abs() <= 5e-6 * minimum.abs());
        prop_assert!((read_increment - increment).abs() <= 5e-6 * increment);
        let spacing = function.header.spacing;
        prop_assert_eq!(uff::FunctionHeader { spacing, ..read.header }, function.header);
    }

    #[test]
    fn nodes_come_back(
        label in 0..=9_999_999_999_i64,
        systems in [-9..99_i64, -9..99, 0..20],
        position in prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::ZERO),
    ) {
        let [definition_system, displacement_system, color] = systems;
        let node = Node { label, definition_system, displacement_system, color, position };
        let double = uff::write::nodes_2411(&[node, node]).expect("writable nodes");
        prop_assert_eq!(uff::read_all(&double), Ok(vec![Record::Nodes(vec![node, node])]));
        let single = uff::write::nodes_15(&[node, node]).expect("writable nodes");
        let node = Node { position: position.map(|x| rounded(x, 6)), ..node };
        prop_assert_eq!(uff::read_all(&single), Ok(vec![Record::Nodes(vec![node, node])]));
    }

    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = uff::read_all(&bytes);
    }

    #[test]
    fn damaged_files_are_read_or_refused(
        function in any_function(),
        form in prop::sample::select(vec![Form::Ascii, Form::Binary { endian: Endian::Little }]),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..6),
    ) {
        let mut bytes = uff::write::function(&function, form).expect("a writable function");
        for (place, byte, insert) in damage {
            let place = place.index(bytes.len());
            if insert { bytes.insert(place, byte) } else { bytes[place] = byte }
        }
        if let Ok(file) = uff::File::new(&bytes) {
            for index in 0..file.entries().len() {
                let _ = (file.record(index), file.summary(index));
            }
        }
    }
}

#[test]
fn a_file_of_all_that_can_be_written_reads_again() {
    let header = FileHeader {
        model: "plate".to_owned(),
        created_by: "frfit".to_owned(),
        created: "05-MAR-24 10:11:12".to_owned(),
        versions: [1, 2],
        written_by: "frfit".to_owned(),
        ..FileHeader::default()
    };
    let units = Units { length: 1000.0, temperature_offset: 273.15, ..Units::default() };
    let nodes = vec![Node { label: 1, position: [0.1, -0.2, 1.0 / 3.0], ..Node::default() }];
    let frf = function(DataType::ComplexDouble, Spacing::Uneven, &[1.0, -2.0, 0.5, 0.25]);
    let form = Form::Binary { endian: Endian::Big };
    let bytes = [
        uff::write::file_header(&header),
        uff::write::units(&units),
        uff::write::nodes_2411(&nodes),
        uff::write::function(&frf, form),
        uff::write::function(&frf, Form::Ascii),
    ];
    let bytes = bytes.into_iter().collect::<Result<Vec<_>, _>>().expect("writable datasets").concat();
    let records = [
        Record::FileHeader(Box::new(header)),
        Record::Units(Box::new(units)),
        Record::Nodes(nodes),
        Record::Function(Box::new(frf.clone())),
        Record::Function(Box::new(frf)),
    ];
    assert_eq!(uff::read_all(&bytes).expect("a readable file"), records);
}

#[test]
fn what_cannot_be_written_is_refused() {
    let good = function(DataType::RealDouble, Spacing::Uneven, &[1.0, 2.0]);
    let refused = |change: &dyn Fn(&mut Function)| {
        let mut bad = good.clone();
        change(&mut bad);
        uff::write::function(&bad, Form::Ascii).is_err()
    };
    assert!(!refused(&|_| ()));
    assert!(refused(&|function| function.abscissa.truncate(1)));
    assert!(refused(&|function| function.header.data_type = DataType::ComplexDouble));
    assert!(refused(&|function| function.header.z_value = f64::NAN));
    assert!(refused(&|function| function.header.id[0] = "two\nlines".to_owned()));
    assert!(refused(&|function| function.header.response.entity = "more than ten".to_owned()));
    assert!(refused(&|function| function.header.response.node = 10_000_000_000));
    assert!(refused(
        &|function| function.header.spacing = Spacing::Even { minimum: 0.0, increment: f64::INFINITY }
    ));
}
