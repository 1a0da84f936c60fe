//! Every sample file is read, header and data, and says what is known about it.

use crate::uff_support;

use std::fs;

use frfit_formats::uff::{self, DataType, FunctionType, Quantity, Record, Spacing, Values};

fn read(name: &str) -> Vec<u8> {
    fs::read(uff_support::samples().join(name)).expect("the sample file is readable")
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn all_samples_read_and_binary_copies_of_their_functions_too_needs_data() {
    let samples = uff_support::samples();
    let mut functions = 0;
    for file in fs::read_dir(samples).expect("a readable folder") {
        let path = file.expect("a readable entry").path();
        let bytes = fs::read(&path).expect("a readable file");
        let file = uff::File::new(&bytes).unwrap_or_else(|error| panic!("{}", error.in_file(&path)));
        for index in 0..file.entries().len() {
            let record = file.record(index).unwrap_or_else(|error| panic!("{}", error.in_file(&path)));
            file.summary(index).unwrap_or_else(|error| panic!("{}", error.in_file(&path)));
            let Record::Function(function) = record else { continue };
            functions += 1;
            let copy = uff::write::function(&function, uff::Form::Ascii).expect("a writable function");
            let copy = uff::File::new(&copy).and_then(|file| file.function(0)).expect("a readable copy");
            assert_eq!(copy.abscissa.len(), function.abscissa.len());
            assert_eq!(copy.header.id, function.header.id);
            assert_eq!(copy.header.response, function.header.response);
            assert_eq!(copy.header.ordinate, function.header.ordinate);
        }
    }
    assert_eq!(functions, 18);
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn the_beam_is_three_responses_over_an_uneven_abscissa_needs_data() {
    let bytes = read("beam.uff");
    let file = uff::File::new(&bytes).expect("a readable list");
    let numbers: Vec<_> = file.entries().iter().map(|entry| (entry.dataset, entry.line)).collect();
    assert_eq!(numbers[..4], [(151, 1), (164, 11), (2420, 17), (2411, 82)]);
    assert_eq!(file.entries()[4].dataset, 58);
    let summary = file.summary(5).expect("a readable header").function.expect("a function");
    assert_eq!(
        (summary.function_type, summary.data_type),
        ("frequency response function", "complex, double precision")
    );
    assert_eq!((summary.response.as_str(), summary.reference.as_str()), ("2+X", "21+X"));
    assert_eq!((summary.points, summary.even, summary.range), (64_000, false, Some([0.0, 6399.9])));
    assert_eq!(summary.quantities, ["frequency", "acceleration", "excitation force"]);
    let function = file.function(6).expect("a readable function");
    let Values::Complex(values) = function.values else { panic!("a complex function") };
    assert_eq!(
        (values.len(), values[63_999].re, values[63_999].im),
        (64_000, -1.96455290343e-3, -2.13040254619e-3)
    );
    let Ok(Record::Nodes(nodes)) = file.record(3) else { panic!("nodes") };
    assert_eq!((nodes.len(), nodes[9].label, nodes[2].position[0]), (10, 10, 0.3));
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn a_file_cut_short_says_how_many_points_are_missing_needs_data() {
    let bytes = read("dataset_milestone_in_header.uff");
    let function = uff::File::new(&bytes).and_then(|file| file.function(0)).expect("a readable function");
    assert_eq!((function.values.len(), function.header.points), (42, 2_508_876));
    assert_eq!(function.missing_points(), 2_508_834);
    assert_eq!(function.header.reference.node, -1);
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn latin_1_and_utf_8_units_read_the_same_needs_data() {
    let latin_1 = read("sample_dataset58_psd.uff");
    let utf_8 = read("time-history-not-all-columns-filled.uff");
    let psd = uff::File::new(&latin_1).and_then(|file| file.function(0)).expect("a readable function");
    assert_eq!(psd.header.function_type, FunctionType::PowerSpectralDensity);
    assert_eq!((psd.header.ordinate.unit.as_str(), psd.abscissa[3200]), ("g²/Hz", 3200.0));
    let time = uff::File::new(&utf_8).and_then(|file| file.function(0)).expect("a readable function");
    assert_eq!((time.header.ordinate.unit.as_str(), time.values.len()), ("m/s²", 13));
    assert_eq!(time.header.abscissa.quantity, Quantity::Time);
    assert_eq!(time.header.spacing, Spacing::Even { minimum: 0.0, increment: 5e-5 });
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn binary_data_are_stepped_over_and_read_needs_data() {
    let bytes = read("MPSTD#Set001_2024_10_08_10_27_07.uff");
    let file = uff::File::new(&bytes).expect("a readable list");
    let lines: Vec<_> = file.entries().iter().map(|entry| (entry.is_binary(), entry.line)).collect();
    assert_eq!(lines, [(true, 1), (true, 2467), (true, 4251), (true, 6499)]);
    let function = file.function(1).expect("a readable function");
    assert_eq!((function.values.len(), function.header.data_type), (222_400, DataType::RealSingle));
    assert_eq!(function.missing_points(), 0);
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn meshes_are_nodes_trace_lines_and_units_needs_data() {
    let bytes = read("TestLab 161 164 18 15 82.uff");
    let records = uff::read_all(&bytes).expect("a readable file");
    let Record::Units(units) = &records[1] else { panic!("units") };
    assert_eq!((units.temperature_mode, units.temperature_offset), (0, -273.15));
    let Record::Other { dataset: 18, .. } = &records[2] else { panic!("dataset 18") };
    let Record::Nodes(nodes) = &records[3] else { panic!("nodes") };
    assert_eq!(
        (nodes.last().map(|node| node.label), nodes.last().map(|node| node.position[1])),
        (Some(36), Some(8.4))
    );
    let Record::TraceLine(line) = &records[6] else { panic!("a trace line") };
    assert_eq!((line.name.as_str(), line.nodes.len(), line.nodes[9]), ("Dalle", 11, 32));
}
