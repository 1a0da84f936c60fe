//! The files of every example: readable, the same each time, and of one story.

mod common;

use common::{Folder, number, quantity};
use frfit::material::{Law, Table};
use frfit::model::Role;
use frfit_examples::{
    Model, clamped_plate, density, generate, hammer_bar, list, rubber_bar, rubber_bar_end, sandwich,
};
use frfit_formats::{Entries, FileKind, csv, detect, read_matrix, uff};
use std::collections::BTreeSet;
use std::sync::LazyLock;
use toml::Value;

fn model(name: &str) -> Model {
    let model = match name {
        "rubber-bar" => rubber_bar(100),
        "rubber-bar-end" => rubber_bar_end(100),
        "clamped-plate" => clamped_plate(20),
        "density" => density(40),
        "hammer-bar" => hammer_bar(400),
        "sandwich" => sandwich(30, 1, 1),
        other => panic!("a model for {other}"),
    };
    model.unwrap()
}

/// Every example with its model, generated once for all tests.
static ALL: LazyLock<Vec<(&str, Folder, Model)>> = LazyLock::new(|| {
    list().iter().map(|example| (example.name, Folder::new(example.name), model(example.name))).collect()
});

fn each(check: impl Fn(&str, &Folder, &Model)) {
    ALL.iter().for_each(|(name, folder, model)| check(name, folder, model));
}

#[test]
fn the_same_bytes_each_time() {
    each(|name, folder, _| assert!(folder.0 == generate(name).unwrap(), "{name}"));
}

#[test]
fn an_unknown_example_is_refused_with_the_names_there_are() {
    assert_eq!(
        generate("rubberbar").unwrap_err().to_string(),
        "expected the name of an example (rubber-bar, rubber-bar-end, clamped-plate, density, hammer-bar, \
         sandwich), found \"rubberbar\""
    );
}

/// All strings under keys `file`.
fn named_files(value: &Value, files: &mut BTreeSet<String>) {
    match value {
        Value::Table(table) => {
            files.extend(table.get("file").and_then(Value::as_str).map(str::to_owned));
            table.values().for_each(|value| named_files(value, files));
        }
        Value::Array(values) => values.iter().for_each(|value| named_files(value, files)),
        _ => {}
    }
}

#[test]
fn the_case_names_exactly_the_files_that_there_are() {
    each(|name, folder, _| {
        let mut named = BTreeSet::from(["README.md", "case.toml", "truth.csv"].map(str::to_owned));
        named_files(&Value::Table(folder.case()), &mut named);
        let example = list().iter().find(|example| example.name == name).unwrap();
        if let Some(records) = example.records() {
            // The measurement is made of these first.
            assert!(named.remove("frf.uff"), "{name}");
            named.insert(records.to_owned());
        }
        let there: BTreeSet<String> = folder.0.iter().map(|file| file.path.clone()).collect();
        assert_eq!(named, there, "{name}");
        assert_eq!(there.len(), folder.0.len(), "{name}");
    });
}

#[test]
fn one_example_has_harwell_boeing_and_one_a_table() {
    let kind = |name, path| {
        let (_, folder, _) = ALL.iter().find(|(other, ..)| *other == name).unwrap();
        detect(folder.bytes(path))
    };
    assert_eq!(kind("clamped-plate", "K.rsa"), Some(FileKind::HarwellBoeing));
    assert_eq!(kind("clamped-plate", "M.mtx"), Some(FileKind::MatrixMarket));
    assert_eq!(kind("density", "frf.csv"), Some(FileKind::Csv));
}

#[test]
fn matrices_read_back_to_the_same_bits() {
    each(|name, folder, model| {
        let case = folder.case();
        for (term, entry) in model.stiffness.terms().iter().zip(case["matrix"].as_array().unwrap()) {
            let read = read_matrix(folder.bytes(entry["file"].as_str().unwrap())).unwrap();
            let Entries::Real(values) = &read.entries else { panic!("{name}: not real") };
            let stored = term.matrix.real_values().unwrap().iter().filter(|value| **value != 0.0).count();
            assert_eq!((read.nrows, values.len()), (model.dofs.len(), stored), "{name}");
            for ((&row, &col), &value) in read.rows.iter().zip(&read.cols).zip(values) {
                assert_eq!(term.matrix.get(row, col).re, value, "{name}");
            }
        }
    });
}

fn law(factor: &Value) -> Law {
    if let Some(table) = factor.as_table() {
        if table.contains_key("table") {
            let folder = ALL.iter().find(|(name, ..)| *name == "hammer-bar").unwrap();
            let truth = csv::read_modulus(folder.1.bytes("truth.csv")).unwrap();
            return Law::Table(Table::new(truth.frequency_hz, truth.modulus).unwrap());
        }
        let get = |key| table.get(key).map(number);
        return match (get("storage"), get("e0")) {
            (Some(storage), _) => Law::complex_modulus(storage, get("loss_factor").unwrap()),
            (_, Some(e0)) => Law::Fractional { e0, e1: get("e1").unwrap(), alpha: get("alpha").unwrap() },
            _ => panic!("{factor:?}"),
        };
    }
    Law::complex_modulus(number(factor), 0.0)
}

/// Up to the rounding of (1 + δ) × a constant.
fn same_law(a: &Law, b: &Law) -> bool {
    [20.0, 700.0].iter().all(|&f| {
        let (a, b) = (a.at(f).unwrap(), b.at(f).unwrap());
        (a - b).norm() <= 1e-15 * a.norm()
    })
}

#[test]
fn cases_say_what_the_models_are() {
    each(|name, folder, model| {
        let case = folder.case();
        let matrices = case["matrix"].as_array().unwrap();
        assert_eq!(matrices.len(), model.stiffness.terms().len(), "{name}");
        for (term, entry) in model.stiffness.terms().iter().zip(matrices) {
            assert_eq!(entry["name"].as_str(), Some(term.name.as_str()), "{name}");
            let role = match term.role {
                Role::Stiffness => "stiffness",
                Role::Viscous => "viscous",
                Role::Mass => "mass",
            };
            assert_eq!(entry["role"].as_str(), Some(role), "{name}");
            assert!(same_law(&law(&entry["factor"]), &term.factor), "{name}: {}", term.name);
        }
        let identify = &case["identify"];
        let unknown = &model.stiffness.terms()[model.parameter.members[0].term];
        assert_eq!(identify["matrix"].as_str(), Some(unknown.name.as_str()), "{name}");
        assert_eq!(model.parameter.nominal, unknown.factor, "{name}");
        assert!(same_law(&law(&identify["truth"]), &model.truth), "{name}");
        let band: Vec<f64> = identify["band_hz"].as_array().unwrap().iter().map(number).collect();
        assert_eq!(band, model.band_hz, "{name}");
        folder.options().validate().unwrap();
    });
}

#[test]
fn cases_drive_and_measure_where_the_models_do() {
    each(|name, folder, model| {
        let case = folder.case();
        // Row (from 0) of a table's `dof` or `row`.
        let row = |place: &Value| match (place.get("dof"), place.get("row")) {
            (Some(dof), None) => {
                let names = csv::read_dof_names(folder.bytes("dofs.csv")).unwrap();
                let is_it =
                    |it: &&csv::DofName| format!("{}+{}", it.node, it.direction) == dof.as_str().unwrap();
                Some(names.iter().find(is_it).unwrap().row - 1)
            }
            (None, Some(row)) => Some(row.as_integer().unwrap() as usize - 1),
            _ => None,
        };
        let load = &model.experiment.load;
        match row(&case["load"]) {
            Some(row) => {
                assert_eq!((load[row].re, load.iter().map(|f| f.norm()).sum()), (1.0, 1.0), "{name}")
            }
            None => {
                let force = csv::read_vector(folder.bytes("force.csv")).unwrap();
                assert_eq!(force.len(), load.len(), "{name}");
                assert!(force.iter().all(|&(row, value)| load[row - 1] == value), "{name}");
            }
        }
        let measurements = case["measurement"].as_array().unwrap();
        assert_eq!(measurements.len(), model.experiment.sensors.len(), "{name}");
        for (k, (entry, sensor)) in measurements.iter().zip(&model.experiment.sensors).enumerate() {
            if let Some(row) = row(entry) {
                assert_eq!(row, sensor.row, "{name}");
            }
            if let Some(record) = entry.get("record") {
                assert_eq!(record.as_integer(), Some(k as i64 + 1), "{name}");
            }
        }
        if case.contains_key("dofs") {
            let names = csv::read_dof_names(folder.bytes("dofs.csv")).unwrap();
            assert_eq!(names.len(), model.dofs.len(), "{name}");
            for (name, dof) in names.iter().zip(&model.dofs) {
                assert_eq!(format!("{}+{}", name.node, name.direction), dof.to_string());
            }
        }
    });
}

#[test]
fn uff_records_say_where_what_and_in_which_unit() {
    each(|name, folder, model| {
        if !folder.0.iter().any(|file| file.path == "frf.uff") {
            return;
        }
        let file = uff::File::new(folder.bytes("frf.uff")).unwrap();
        let uff::Record::Units(units) = file.record(0).unwrap() else { panic!("{name}: no units") };
        assert_eq!((units.length, units.force), (1.0, 1.0), "{name}");
        let functions: Vec<_> = file.functions().collect();
        assert_eq!(functions.len(), model.experiment.sensors.len(), "{name}");
        for (sensor, index) in functions.into_iter().enumerate() {
            let header = file.function(index).unwrap().header;
            assert_eq!(header.function_type, uff::FunctionType::FrequencyResponse, "{name}");
            assert_eq!(header.response.label(), model.measured_dof(sensor).to_string(), "{name}");
            match model.driven_at() {
                Some(dof) => assert_eq!((header.reference.label(), header.load_case), (dof.to_string(), 0)),
                None => assert_eq!((header.reference.node, header.load_case), (0, 1), "{name}"),
            }
            let unit = match quantity(&header) {
                frfit::quantity::Quantity::Receptance => "m",
                frfit::quantity::Quantity::Mobility => "m/s",
                frfit::quantity::Quantity::Accelerance => "m/s^2",
            };
            assert_eq!(
                (header.ordinate.unit.as_str(), header.denominator.unit.as_str()),
                (unit, "N"),
                "{name}"
            );
            assert_eq!(header.denominator.quantity, uff::Quantity::ExcitationForce, "{name}");
            assert_eq!(header.abscissa.unit, "Hz", "{name}");
        }
    });
}

#[test]
fn measurements_are_direct_solves_at_the_true_parameter() {
    each(|name, folder, model| {
        if name == "hammer-bar" {
            return;
        }
        let (frequency_hz, measured) = folder.measured();
        assert_eq!(frequency_hz, model.frequency_hz(), "{name}");
        let last = frequency_hz.len() - 1;
        for k in [0, last / 2, last] {
            for (there, here) in measured[k].iter().zip(model.measured_at(frequency_hz[k]).unwrap()) {
                // UFF text has 13 digits of each part.
                assert!((there - here).norm() <= 1e-12 * here.norm(), "{name} at {} Hz", frequency_hz[k]);
            }
        }
    });
}

#[test]
fn truths_are_the_true_laws() {
    each(|name, folder, model| {
        let bytes = folder.bytes("truth.csv");
        let table = csv::Table::read(bytes).unwrap();
        if name == "density" {
            let columns = ["frequency_hz", "factor_re", "factor_im"].map(|c| table.column(c).unwrap());
            for row in 0..table.rows() {
                assert_eq!(columns[1..].iter().map(|&c| table.number(row, c).unwrap()).sum::<f64>(), 2700.0);
            }
            return;
        }
        let modulus = csv::read_modulus(bytes).unwrap();
        if name == "hammer-bar" {
            // All lines of the records' transform.
            assert_eq!((modulus.frequency_hz[0], modulus.frequency_hz.len()), (2.0, 799));
        } else {
            assert_eq!(modulus.frequency_hz, model.frequency_hz(), "{name}");
        }
        for (&f, &value) in modulus.frequency_hz.iter().zip(&modulus.modulus) {
            let truth = model.truth.at(f).unwrap();
            // E″ is written as η = E″/E′: one rounding there and one back.
            assert!((value - truth).norm() <= 4.0 * f64::EPSILON * truth.norm(), "{name} at {f} Hz");
        }
    });
}

#[test]
fn readmes_say_how_to_run() {
    each(|name, folder, _| {
        let text = std::str::from_utf8(folder.bytes("README.md")).unwrap();
        assert!(text.starts_with(&format!("# {name}\n")), "{name}");
        assert!(text.contains("\n    frfit identify case.toml --out results\n"), "{name}");
    });
}
