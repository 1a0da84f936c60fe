//! FRFs in UFF files: which one is taken, and what is taken from it.

use super::files::{edited, folder, message};
use frfit::c64;
use frfit::quantity::Quantity;
use frfit_formats::uff::{
    Axis, Dof, Form, Function, FunctionHeader, FunctionType, Quantity as Measured, Spacing, Units, Values,
    write,
};
use frfit_workflow::load::{Case, MeasuredNoise, Overrides, Purpose, load};

/// An FRF at three frequencies whose real part says which it is.
fn function(response: (i64, i32), reference: (i64, i32), value: f64, measured: Measured) -> Function {
    let dof = |(node, direction)| Dof { node, direction, ..Dof::default() };
    let header = FunctionHeader {
        response: dof(response),
        reference: dof(reference),
        spacing: Spacing::Even { minimum: 10.0, increment: 10.0 },
        ordinate: Axis { quantity: measured, ..Axis::default() },
        denominator: Axis { quantity: Measured::ExcitationForce, ..Axis::default() },
        ..FunctionHeader::default()
    };
    Function::new(header, vec![10.0, 20.0, 30.0], Values::Complex(vec![c64::new(value, 0.0); 3]))
}

fn file(functions: &[Function]) -> Vec<u8> {
    functions.iter().flat_map(|function| write::function(function, Form::Ascii).unwrap()).collect()
}

/// Node 2 in +Z and about +X, driven at node 1 in +Z and in +X.
fn several() -> Vec<u8> {
    file(&[
        function((2, 3), (1, 1), 1.0, Measured::Displacement),
        function((2, 3), (1, 3), 2.0, Measured::Velocity),
        function((2, 4), (1, 3), 3.0, Measured::Acceleration),
    ])
}

/// The case with one measurement, from a UFF file, and these keys.
fn measured(uff: &[u8], keys: &str) -> Result<Case, String> {
    let head = edited("case.toml", "file = \"a.csv\"\ndof = \"2-Z\"\nquantity = \"accelerance\"\n", keys);
    let second = "[[measurement]]\nfile = \"b.csv\"\nrow = 3\nquantity = \"receptance\"\n";
    let folder = folder("case.toml", Some(head.replace(second, "").as_bytes()));
    std::fs::write(folder.path().join("a.uff"), uff).unwrap();
    let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Identify);
    case.map_err(|error| message(&folder, &error))
}

/// Label, quantity and the value of the FRF that was taken.
fn taken(case: &Case) -> (&str, Quantity, f64) {
    let identify = case.identify.as_ref().unwrap();
    let (f, x) = (identify.frequency_hz[0], identify.measured[0][0]);
    let sensor = &case.sensors[0];
    (&sensor.label, sensor.quantity, sensor.quantity.from_receptance(f, x).re.round())
}

/// The coherence between two degrees of freedom.
fn coherence(response: (i64, i32), reference: (i64, i32), values: [f64; 3]) -> Function {
    let Function { header, abscissa, .. } = function(response, reference, 0.0, Measured::Unknown);
    let header = FunctionHeader { function_type: FunctionType::Coherence, ..header };
    Function::new(header, abscissa, Values::Real(values.to_vec()))
}

#[test]
fn a_coherence_record_belongs_to_the_frf_between_its_degrees_of_freedom() {
    let keys = "file = \"a.uff\"\ndof = \"2+Z\"\n";
    let both =
        [file(&[coherence((2, 4), (1, 3), [0.1; 3]), coherence((2, 3), (1, 3), [0.5, 0.8, 1.0])]), several()];
    let case = measured(&both.concat(), keys).unwrap();
    let identify = case.identify.unwrap();
    let MeasuredNoise::Relative(std) = &identify.noise else { panic!("{:?}", identify.noise) };
    // √E|δH|² of the complex value as of one average: |H| √((1 − γ²)/γ²).
    let expected = |k: usize, averages: f64| {
        let factor = [1.0f64, 0.2 / 0.8][k];
        identify.measured[k][0].norm() * (factor / averages).sqrt()
    };
    (0..2).for_each(|k| assert!((std[k][0] / expected(k, 1.0) - 1.0).abs() < 1e-14));
    // With the number of averages it is known: of so many each line says enough by itself.
    let case = measured(&both.concat(), &format!("{keys}averages = 101\n")).unwrap();
    let MeasuredNoise::Known(std) = case.identify.unwrap().noise else { panic!() };
    (0..2).for_each(|k| assert!((std[k][0] / expected(k, 100.0 / 1.01) - 1.0).abs() < 1e-14));
    // Without one of its own there is none; two of them contradict each other.
    let without = [file(&[coherence((2, 4), (1, 3), [0.1; 3])]), several()];
    let twice =
        [file(&[coherence((2, 3), (1, 3), [0.5; 3]), coherence((2, 3), (1, 3), [0.6; 3])]), several()];
    for bytes in [without, twice] {
        let case = measured(&bytes.concat(), keys).unwrap();
        assert_eq!(case.identify.unwrap().noise, MeasuredNoise::Unknown);
    }
    let wrong = [file(&[coherence((2, 3), (1, 3), [0.5, 1.5, 1.0])]), several()];
    let error = measured(&wrong.concat(), keys).unwrap_err();
    assert!(error.contains("expected coherences from 0 to 1, found 1.5"), "{error}");
}

#[test]
fn a_record_is_found_by_response_and_reference() {
    let case = measured(&several(), "file = \"a.uff\"\ndof = \"2+Z\"\n").unwrap();
    assert_eq!(taken(&case), ("2+Z", Quantity::Mobility, 2.0));
}

/// The hammer moves and the accelerometer stays, where the case has its load.
#[test]
fn a_record_is_found_by_load_and_response_exchanged() {
    let moving = |node, direction, value| function((1, 3), (node, direction), value, Measured::Acceleration);
    let roving = file(&[moving(2, 3, 4.0), moving(2, -3, 5.0), moving(3, 3, 6.0)]);
    let case = measured(&roving, "file = \"a.uff\"\ndof = \"2-Z\"\n").unwrap();
    assert_eq!(taken(&case), ("2-Z", Quantity::Accelerance, 5.0));
    assert_eq!((case.experiment.sensors[0].row, case.experiment.sensors[0].sign), (1, -1.0));
}

#[test]
fn a_record_is_found_by_its_number_and_says_where_it_was_measured() {
    let case = measured(&several(), "file = \"a.uff\"\nrecord = 3\n").unwrap();
    assert_eq!(taken(&case), ("2+RX", Quantity::Accelerance, 3.0));
    assert_eq!((case.experiment.sensors[0].row, case.experiment.sensors[0].sign), (2, 1.0));
}

#[test]
fn the_only_record_is_taken_with_the_sign_of_its_direction() {
    let only = file(&[function((2, -3), (1, 3), 7.0, Measured::Displacement)]);
    let case = measured(&only, "file = \"a.uff\"\n").unwrap();
    assert_eq!(taken(&case), ("2-Z", Quantity::Receptance, 7.0));
    assert_eq!((case.experiment.sensors[0].row, case.experiment.sensors[0].sign), (1, -1.0));
}

#[test]
fn the_case_overrides_the_file() {
    let only = file(&[function((2, 3), (1, 3), 7.0, Measured::Displacement)]);
    let case = measured(&only, "file = \"a.uff\"\nrow = 3\nquantity = \"mobility\"\n").unwrap();
    assert_eq!(taken(&case), ("row 3", Quantity::Mobility, 7.0));
}

#[test]
fn two_measurements_may_be_of_one_file() {
    let keys = "file = \"a.uff\"\ndof = \"2+Z\"\n[[measurement]]\nfile = \"a.uff\"\ndof = \"2+RX\"\n";
    let case = measured(&several(), keys).unwrap();
    let identify = case.identify.as_ref().unwrap();
    assert_eq!(identify.measured[0].len(), 2);
    assert_eq!(case.inputs.iter().filter(|input| input.path.ends_with("a.uff")).count(), 1);
}

#[test]
fn what_cannot_be_used_is_said() {
    let good = function((2, 3), (1, 3), 7.0, Measured::Displacement);
    let edit = |change: &dyn Fn(&mut Function)| {
        let mut function = good.clone();
        change(&mut function);
        file(&[function])
    };
    let mut text = String::from_utf8(edit(&|_| {})).unwrap();
    let value = text.rfind("7.0").unwrap();
    text.replace_range(value..value + 3, "nan");
    let cut = {
        let bytes = String::from_utf8(edit(&|_| {})).unwrap();
        bytes.replacen("         6         3", "         6         9", 1).into_bytes()
    };
    let units = Units { code: 9, length: 1000.0, ..Units::default() };
    let metres = |f: &mut Function| f.header.ordinate.unit = "m/s^2".into();
    let contradicted = [write::units(&units).unwrap(), edit(&metres)].concat();
    let only = "file = \"a.uff\"\n";
    for (uff, keys, expected) in [
        (
            several(),
            only,
            "a.uff: expected one frequency response function, found several, and no dof or record that says which (1: 2+Z/1+X, 2: 2+Z/1+Z, 3: 2+RX/1+Z)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            several(),
            "file = \"a.uff\"\ndof = \"1+Z\"\n",
            "a.uff: expected one frequency response function, found none with the dof and load of the case (1: 2+Z/1+X, 2: 2+Z/1+Z, 3: 2+RX/1+Z)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            several(),
            "file = \"a.uff\"\nrecord = 4\n",
            "a.uff: expected record = 1 to 3 (1: 2+Z/1+X, 2: 2+Z/1+Z, 3: 2+RX/1+Z), found 4\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            several(),
            "file = \"a.uff\"\nrecord = 0\n",
            "a.uff: expected record = 1 to 3 (1: 2+Z/1+X, 2: 2+Z/1+Z, 3: 2+RX/1+Z), found 0\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            [several(), several()].concat(),
            "file = \"a.uff\"\ndof = \"2+RX\"\n",
            "a.uff: expected one frequency response function, found several with the dof and load of the case, and no record that says which (1: 2+Z/1+X, 2: 2+Z/1+Z, 3: 2+RX/1+Z, 4: 2+Z/1+X, 5: 2+Z/1+Z, 6: 2+RX/1+Z)\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| f.header.function_type = FunctionType::Coherence),
            only,
            "a.uff: expected a frequency response function (dataset 58 of function type 4), found none, and 1 functions of other types\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| f.header.response.direction = 0),
            only,
            "case.toml:20:1: measurement: expected the key \"dof\" or \"row\", because no file says where it was measured, found none",
        ),
        (
            edit(&|f| f.header.response.node = 5),
            only,
            "case.toml:21:1: measurement.file: expected a degree of freedom that [dofs] names, found 5+Z (no node 5; the nearest is 2 with Z, RX)",
        ),
        (
            edit(&|f| f.header.reference.direction = -3),
            only,
            "a.uff: expected an FRF driven at 1+Z, as [load] says, found 1-Z\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| f.header.ordinate.quantity = Measured::Unknown),
            only,
            "case.toml:20:1: measurement: expected the key \"quantity\" (receptance, mobility or accelerance), because the file does not say, found none",
        ),
        (
            edit(&|f| f.header.denominator.quantity = Measured::Acceleration),
            only,
            "case.toml:20:1: measurement: expected the key \"quantity\" (receptance, mobility or accelerance), because the file does not say, found none",
        ),
        (
            edit(&|f| f.header.abscissa.quantity = Measured::Time),
            only,
            "a.uff:1: expected an abscissa in Hz, found time\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| f.header.abscissa.unit = "rad/s".into()),
            only,
            "a.uff:1: expected an abscissa in Hz, found the unit \"rad/s\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| *f = Function::new(f.header.clone(), vec![10.0; 3], Values::Real(vec![1.0; 3]))),
            only,
            "a.uff:1: expected complex values of an FRF, found real ones\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| f.header.spacing = Spacing::Even { minimum: 30.0, increment: -10.0 }),
            only,
            "a.uff:1: expected frequencies from 0 on in ascending order, found 20 Hz after 30 Hz\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            edit(&|f| *f = Function::new(f.header.clone(), vec![], Values::Complex(vec![]))),
            only,
            "a.uff:1: expected at least one point, found none\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            text.into_bytes(),
            only,
            "a.uff:15:1: expected a number in columns 1-20, found \"nan00000000000E+00\"\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            cut,
            only,
            "a.uff:1: expected 9 points, as the header says, found 3\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            contradicted,
            only,
            "a.uff:1: expected units of the file (dataset 164) that agree with the label \"m/s^2\", found unit factors 1000 of length and 1 of force\nnamed in case.toml:21:1: measurement.file",
        ),
        (
            b"    -1\n    58\n".to_vec(),
            only,
            "a.uff:1: expected dataset 58 closed by a line with -1, found the end of the file\nnamed in case.toml:21:1: measurement.file",
        ),
    ] {
        assert_eq!(measured(&uff, keys).unwrap_err(), expected);
    }
}

/// SI is the value of the file times force over length of dataset 164; an angle has no length.
#[test]
fn units_of_the_file_are_converted() {
    let units = Units { code: 9, length: 1000.0, force: 0.5, ..Units::default() };
    let head = write::units(&units).unwrap();
    let std = |response, values: [f64; 3]| {
        let Function { header, abscissa, .. } = coherence(response, (1, 3), values);
        let ordinate = Axis { label: "Standard deviation".into(), ..header.ordinate };
        let header = FunctionHeader { function_type: FunctionType::General, ordinate, ..header };
        Function::new(header, abscissa, Values::Real(values.to_vec()))
    };
    for (response, dof, expected) in [((2, 3), "2+Z", 8e3 * 0.5e-3), ((2, 4), "2+RX", 8e3 * 0.5)] {
        let mut frf = function(response, (1, 3), 8e3, Measured::Displacement);
        frf.header.ordinate.unit = "mm".into();
        frf.header.ordinate.unit.truncate(if response.1 > 3 { 0 } else { 2 });
        let bytes = [head.clone(), file(&[frf, std(response, [80.0; 3])])].concat();
        let case = measured(&bytes, &format!("file = \"a.uff\"\ndof = \"{dof}\"\n")).unwrap();
        let identify = case.identify.unwrap();
        assert!(
            (identify.measured[0][0].re / expected - 1.0).abs() < 1e-12,
            "{dof}: {}",
            identify.measured[0][0]
        );
        let MeasuredNoise::Known(std) = &identify.noise else { panic!("{:?}", identify.noise) };
        assert!((std[0][0] / (0.01 * expected) - 1.0).abs() < 1e-12, "{dof}: {}", std[0][0]);
    }
}

/// An analyser's first + k · step ends beside the end of the band by a rounding.
#[test]
fn an_end_of_the_band_is_met_but_for_rounding() {
    let Function { header, values, .. } = function((2, 3), (1, 3), 7.0, Measured::Displacement);
    let header = FunctionHeader { spacing: Spacing::Uneven, ..header };
    let beside = Function::new(header, vec![9.999_999_999_99, 20.0, 30.000_000_000_01], values);
    let case = measured(&file(&[beside]), "file = \"a.uff\"\n").unwrap();
    assert_eq!(case.identify.unwrap().frequency_hz.len(), 3);
}
