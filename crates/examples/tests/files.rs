//! The files of every example: readable, the same each time, and of one story.

use crate::common;
use crate::tier::is_long;

use common::{Folder, number, quantity};
use frfit::c64;
use frfit::identify::{Dependence, Variation};
use frfit::material::{Law, Table};
use frfit::model::Role;
use frfit_examples::{
    Model, Rig, SeveralModel, added_mass, clamped_plate, density, generate, hammer_bar, joint_stiffness,
    list, orthotropic_plate, plate_thickness, rubber_bar, rubber_bar_end, sandwich, two_materials,
    two_meshes,
};
use frfit_formats::{Entries, FileKind, csv, detect, read_matrix, uff};
use std::collections::BTreeSet;
use std::sync::LazyLock;
use toml::Value;

/// The model of an example.
enum Known {
    One(Model),
    Several(SeveralModel),
    /// On its own mesh, and measured on another.
    Meshes(Box<[SeveralModel; 2]>),
}

impl Known {
    fn rig(&self) -> Rig<'_> {
        match self {
            Self::One(model) => model.rig(),
            Self::Several(model) => model.rig(),
            Self::Meshes(models) => models[0].rig(),
        }
    }

    /// What sensors measure, as far as noise leaves it, and what part of it noise is.
    fn measured(&self, frequency_hz: &[f64]) -> (Vec<Vec<c64>>, f64) {
        let exact = |model: &SeveralModel| (model.exact(frequency_hz).unwrap(), model.noise);
        match self {
            Self::One(model) => (frequency_hz.iter().map(|&f| model.measured_at(f).unwrap()).collect(), 0.0),
            Self::Several(model) => exact(model),
            Self::Meshes(models) => exact(&models[1]),
        }
    }
}

fn model(name: &str) -> Known {
    let one = |model: Result<Model, _>| Known::One(model.unwrap());
    let several = |model: Result<SeveralModel, _>| Known::Several(model.unwrap());
    match name {
        "rubber-bar" => one(rubber_bar(100)),
        "rubber-bar-end" => one(rubber_bar_end(100)),
        "clamped-plate" => one(clamped_plate(20)),
        "density" => one(density(40)),
        "hammer-bar" => one(hammer_bar(400)),
        "sandwich" => one(sandwich(30, 1, 1)),
        "plate-thickness" => several(plate_thickness(10)),
        "two-materials" => several(two_materials(30, 1, 1)),
        "joint-stiffness" => several(joint_stiffness(20)),
        "added-mass" => several(added_mass(40)),
        "orthotropic-plate" => several(orthotropic_plate([8, 4])),
        "two-meshes" => Known::Meshes(Box::new([12, 36].map(|elements| two_meshes(elements).unwrap()))),
        other => panic!("a model for {other}"),
    }
}

/// Every example with its model, generated once for all tests.
static ALL: LazyLock<Vec<(&str, Folder, Known)>> = LazyLock::new(|| {
    list().iter().map(|example| (example.name, Folder::new(example.name), model(example.name))).collect()
});

fn each(check: impl Fn(&str, &Folder, &Known)) {
    ALL.iter().for_each(|(name, folder, model)| check(name, folder, model));
}

fn each_of_one(check: impl Fn(&str, &Folder, &Model)) {
    each(|name, folder, model| {
        if let Known::One(model) = model {
            check(name, folder, model);
        }
    });
}

fn each_of_several(check: impl Fn(&str, &Folder, &SeveralModel)) {
    each(|name, folder, model| {
        if let Known::Several(model) = model {
            check(name, folder, model);
        }
    });
}

/// In one test, since nextest runs every test in a process of its own, which would make all examples anew.
#[test]
fn every_example_is_readable_the_same_each_time_and_of_one_story() {
    the_same_bytes_each_time();
    the_case_names_exactly_the_files_that_there_are();
    one_example_has_harwell_boeing_and_one_a_table();
    matrices_read_back_to_the_same_bits();
    cases_say_what_the_models_are();
    cases_of_one_unknown_say_which();
    cases_of_several_unknowns_say_which();
    cases_drive_and_measure_where_the_models_do();
    a_coarser_mesh_is_of_the_same_plate();
    uff_records_say_where_what_and_in_which_unit();
    measurements_are_direct_solves_at_the_true_parameters();
    noise_is_as_large_as_the_files_say();
    truths_of_several_unknowns_have_the_columns_of_the_results();
    truths_are_the_true_laws();
    readmes_say_how_to_run();
}

fn the_same_bytes_each_time() {
    each(|name, folder, _| {
        // Three take most of the time, and are written as the others are.
        if is_long() || !["two-meshes", "clamped-plate", "orthotropic-plate"].contains(&name) {
            assert!(folder.0 == generate(name).unwrap(), "{name}");
        }
    });
}

#[test]
fn an_unknown_example_is_refused_with_the_names_there_are() {
    assert_eq!(
        generate("rubberbar").unwrap_err().to_string(),
        "expected the name of an example (rubber-bar, rubber-bar-end, clamped-plate, density, hammer-bar, \
         sandwich, plate-thickness, two-materials, joint-stiffness, added-mass, two-meshes, \
         orthotropic-plate), found \"rubberbar\""
    );
}

fn has_records(name: &str) -> bool {
    list().iter().any(|example| example.name == name && example.records().is_some())
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

fn the_case_names_exactly_the_files_that_there_are() {
    each(|name, folder, _| {
        let mut named = BTreeSet::from(["README.md", "case.toml", "truth.csv"].map(str::to_owned));
        named_files(&Value::Table(folder.case()), &mut named);
        if let Some(coarser) = folder.case().get("coarser_mesh").and_then(Value::as_str) {
            named.insert(coarser.to_owned());
            named_files(&Value::Table(folder.toml(coarser)), &mut named);
        }
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

fn one_example_has_harwell_boeing_and_one_a_table() {
    let kind = |name, path| {
        let (_, folder, _) = ALL.iter().find(|(other, ..)| *other == name).unwrap();
        detect(folder.bytes(path))
    };
    assert_eq!(kind("clamped-plate", "K.rsa"), Some(FileKind::HarwellBoeing));
    assert_eq!(kind("clamped-plate", "M.mtx"), Some(FileKind::MatrixMarket));
    assert_eq!(kind("density", "frf.csv"), Some(FileKind::Csv));
}

fn matrices_read_back_to_the_same_bits() {
    each(|name, folder, model| {
        let (case, rig) = (folder.case(), model.rig());
        for (term, entry) in rig.stiffness.terms().iter().zip(case["matrix"].as_array().unwrap()) {
            let read = read_matrix(folder.bytes(entry["file"].as_str().unwrap())).unwrap();
            let Entries::Real(values) = &read.entries else { panic!("{name}: not real") };
            let stored = term.matrix.real_values().unwrap().iter().filter(|value| **value != 0.0).count();
            assert_eq!((read.nrows, values.len()), (rig.dofs.len(), stored), "{name}");
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
            (Some(storage), _) => Law::complex_modulus(storage, get("loss_factor").unwrap_or(0.0)),
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

fn cases_say_what_the_models_are() {
    each(|name, folder, model| {
        let (case, rig) = (folder.case(), model.rig());
        let matrices = case["matrix"].as_array().unwrap();
        assert_eq!(matrices.len(), rig.stiffness.terms().len(), "{name}");
        for (term, entry) in rig.stiffness.terms().iter().zip(matrices) {
            assert_eq!(entry["name"].as_str(), Some(term.name.as_str()), "{name}");
            let role = match term.role {
                Role::Stiffness => "stiffness",
                Role::Viscous => "viscous",
                Role::Mass => "mass",
            };
            assert_eq!(entry["role"].as_str(), Some(role), "{name}");
            assert!(same_law(&law(&entry["factor"]), &term.factor), "{name}: {}", term.name);
        }
        let first = folder.identify()[0].clone();
        let band: Vec<f64> = first["band_hz"].as_array().unwrap().iter().map(number).collect();
        assert_eq!(band, rig.band_hz, "{name}");
    });
}

fn cases_of_one_unknown_say_which() {
    each_of_one(|name, folder, model| {
        let [identify] = &folder.identify()[..] else { panic!("{name}: one [identify]") };
        let unknown = &model.stiffness.terms()[model.parameter.members[0].term];
        assert_eq!(identify["matrix"].as_str(), Some(unknown.name.as_str()), "{name}");
        assert_eq!(model.parameter.nominal, unknown.factor, "{name}");
        assert!(same_law(&law(&identify["reference"]), &model.truth), "{name}");
        folder.options().validate().unwrap();
    });
}

fn cases_of_several_unknowns_say_which() {
    each_of_several(|name, folder, model| {
        let tables = folder.identify();
        assert_eq!((tables.len(), model.truth.len()), (model.unknowns.len(), model.unknowns.len()), "{name}");
        let term = |index: &usize| model.stiffness.terms()[*index].name.as_str();
        for ((table, one), truth) in tables.iter().zip(&model.unknowns).zip(&model.truth) {
            match &one.dependence {
                Dependence::Factor(terms) => {
                    assert_eq!(table["matrix"].as_str(), Some(term(&terms[0])), "{name}");
                    assert_eq!(
                        (table["matrix"].as_str(), terms.len()),
                        (Some(one.name.as_str()), 1),
                        "{name}"
                    );
                    assert_eq!(one.nominal, model.stiffness.terms()[terms[0]].factor, "{name}");
                }
                Dependence::Powers(powers) => {
                    assert_eq!(table["name"].as_str(), Some(one.name.as_str()), "{name}");
                    let written = table["powers"].as_table().unwrap();
                    assert_eq!(written.len(), powers.len(), "{name}");
                    for (index, power) in powers {
                        assert_eq!(written[term(index)].as_integer(), Some(i64::from(*power)), "{name}");
                    }
                    assert!(same_law(&law(&table["nominal"]), &one.nominal), "{name}");
                }
            }
            let varies = table.get("varies").and_then(Value::as_str);
            let is_constant = varies == Some("constant") || matches!(one.dependence, Dependence::Powers(_));
            assert_eq!(is_constant, one.varies == Variation::Constant, "{name}: {}", one.name);
            let real = table.get("real").and_then(Value::as_bool).unwrap_or(table.contains_key("powers"));
            assert_eq!(real, one.real, "{name}: {}", one.name);
            let pair = |value: &Value| value.as_array().map(|pair| [0, 1].map(|k| number(&pair[k])));
            let bounds = &table["bounds"];
            let (storage, loss_factor) = match bounds.as_table() {
                Some(bounds) => (pair(&bounds["storage"]), pair(&bounds["loss_factor"])),
                None => (pair(bounds), None),
            };
            assert_eq!((storage, loss_factor), (one.bounds.storage, one.bounds.loss_factor), "{name}");
            assert!(same_law(&law(&table["reference"]), truth), "{name}: {}", one.name);
        }
    });
}

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
        let rig = model.rig();
        let load = &rig.experiment.load;
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
        assert_eq!(measurements.len(), rig.experiment.sensors.len(), "{name}");
        for (k, (entry, sensor)) in measurements.iter().zip(&rig.experiment.sensors).enumerate() {
            if let Some(row) = row(entry) {
                assert_eq!(row, sensor.row, "{name}");
            }
            if let Some(record) = entry.get("record") {
                assert_eq!(record.as_integer(), Some(k as i64 + 1), "{name}");
            }
        }
        if case.contains_key("dofs") {
            let names = csv::read_dof_names(folder.bytes("dofs.csv")).unwrap();
            let named: Vec<_> = (1..).zip(rig.dofs).filter_map(|(row, name)| Some((row, (*name)?))).collect();
            assert_eq!(names.len(), named.len(), "{name}");
            for (name, (row, dof)) in names.iter().zip(named) {
                assert_eq!((format!("{}+{}", name.node, name.direction), name.row), (dof.to_string(), row));
            }
        }
    });
}

/// The coarser mesh is driven and measured at the same points.
fn a_coarser_mesh_is_of_the_same_plate() {
    let (_, folder, _) = ALL.iter().find(|(name, ..)| *name == "two-meshes").unwrap();
    let [coarse, fine] = [6, 12].map(|elements| two_meshes(elements).unwrap());
    let case = folder.toml("coarse.toml");
    let measured = case["measurement"].as_array().unwrap().iter();
    let named = measured.chain([&case["load"]]).map(|entry| entry["dof"].as_str().unwrap().to_owned());
    let rig = coarse.rig();
    let of_mesh = (0..3).map(|sensor| rig.measured_dof(sensor)).chain(rig.driven_at());
    assert_eq!(named.collect::<Vec<_>>(), of_mesh.map(|dof| dof.to_string()).collect::<Vec<_>>());
    // Nodes are counted along the length first: the same parts of the sides.
    let place = |model: &SeveralModel, elements: u64, sensor: usize| {
        let node = model.rig().measured_dof(sensor).node - 1;
        [node % (elements + 1), node / (elements + 1)].map(|k| k as f64 / elements as f64)
    };
    (0..3).for_each(|sensor| assert_eq!(place(&coarse, 6, sensor), place(&fine, 12, sensor)));
    for (term, entry) in rig.stiffness.terms().iter().zip(case["matrix"].as_array().unwrap()) {
        assert!(same_law(&law(&entry["factor"]), &term.factor), "{}", term.name);
        let read = read_matrix(folder.bytes(entry["file"].as_str().unwrap())).unwrap();
        assert_eq!(read.nrows, rig.dofs.len(), "{}", term.name);
    }
}

fn uff_records_say_where_what_and_in_which_unit() {
    each(|name, folder, model| {
        if !folder.0.iter().any(|file| file.path == "frf.uff") {
            return;
        }
        let file = uff::File::new(folder.bytes("frf.uff")).unwrap();
        let uff::Record::Units(units) = file.record(0).unwrap() else { panic!("{name}: no units") };
        assert_eq!((units.length, units.force), (1.0, 1.0), "{name}");
        let functions: Vec<_> = file.functions().collect();
        let rig = model.rig();
        assert_eq!(functions.len(), rig.experiment.sensors.len(), "{name}");
        for (sensor, index) in functions.into_iter().enumerate() {
            let header = file.function(index).unwrap().header;
            assert_eq!(header.function_type, uff::FunctionType::FrequencyResponse, "{name}");
            assert_eq!(header.response.label(), rig.measured_dof(sensor).to_string(), "{name}");
            match rig.driven_at() {
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

fn measurements_are_direct_solves_at_the_true_parameters() {
    each(|name, folder, model| {
        // Those have tests of their own.
        if has_records(name) {
            return;
        }
        let (frequency_hz, measured) = folder.measured();
        assert_eq!(frequency_hz, model.rig().frequency_hz(), "{name}");
        let last = frequency_hz.len() - 1;
        let some = [0, last / 2, last];
        let (exact, noise) = model.measured(&some.map(|k| frequency_hz[k]));
        for (k, exact) in some.into_iter().zip(exact) {
            for (there, here) in measured[k].iter().zip(exact) {
                // UFF text has 13 digits of each part; noise of more than five standard deviations has a probability of e⁻²⁵.
                let within = 1e-12_f64.max(5.0 * noise);
                assert!((there - here).norm() <= within * here.norm(), "{name} at {} Hz", frequency_hz[k]);
            }
        }
    });
}

fn noise_is_as_large_as_the_files_say() {
    each_of_several(|name, folder, model| {
        if has_records(name) {
            return;
        }
        let (frequency_hz, measured) = folder.measured();
        let exact = model.exact(&frequency_hz).unwrap();
        let case = folder.case();
        for (m, entry) in case["measurement"].as_array().unwrap().iter().enumerate() {
            let path = entry["file"].as_str().unwrap();
            if model.noise == 0.0 {
                assert!(path.ends_with(".uff"), "{name}");
                continue;
            }
            let quantity: frfit::quantity::Quantity = entry["quantity"].as_str().unwrap().parse().unwrap();
            let std = csv::read_frf(folder.bytes(path)).unwrap().std.unwrap();
            let off = (0..frequency_hz.len()).map(|k| {
                let std = quantity.to_receptance(frequency_hz[k], c64::new(std[k], 0.0)).norm();
                // The case says 1 % or 2 %, of the response that was measured without it.
                assert!((std / (model.noise * exact[k][m].norm()) - 1.0).abs() < 1e-12, "{name}");
                ((measured[k][m] - exact[k][m]).norm() / std).powi(2)
            });
            let mean = off.sum::<f64>() / frequency_hz.len() as f64;
            // Exponentially distributed numbers of mean one: four standard deviations of the mean.
            let four = 4.0 / (frequency_hz.len() as f64).sqrt();
            assert!((mean - 1.0).abs() < four, "{name}, sensor {m}: {mean}");
        }
    });
}

fn truths_of_several_unknowns_have_the_columns_of_the_results() {
    each_of_several(|name, folder, model| {
        let table = csv::Table::read(folder.bytes("truth.csv")).unwrap();
        assert_eq!(table.rows(), model.rig().frequency_hz().len(), "{name}");
        let column = |name: &str| table.column(name).unwrap();
        for row in 0..table.rows() {
            let number = |name: &str| table.number(row, column(name)).unwrap();
            let f = number("frequency_hz");
            for (one, truth) in model.unknowns.iter().zip(&model.truth) {
                let truth = truth.at(f).unwrap();
                let written = match one.real {
                    true => c64::new(number(&format!("{}.value", one.name)), 0.0),
                    false => {
                        let storage = number(&format!("{}.storage", one.name));
                        c64::new(storage, storage * number(&format!("{}.loss_factor", one.name)))
                    }
                };
                // E″ is written as η = E″/E′: one rounding there and one back.
                assert!((written - truth).norm() <= 4.0 * f64::EPSILON * truth.norm(), "{name} at {f} Hz");
            }
        }
    });
}

fn truths_are_the_true_laws() {
    each_of_one(|name, folder, model| {
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

fn readmes_say_how_to_run() {
    each(|name, folder, _| {
        let text = std::str::from_utf8(folder.bytes("README.md")).unwrap();
        assert!(text.starts_with(&format!("# {name}\n")), "{name}");
        assert!(text.contains("\n    frfit identify case.toml --out results\n"), "{name}");
    });
}
