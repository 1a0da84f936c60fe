//! An example as its files say it, read back.
#![allow(dead_code, reason = "each test file uses its own part")]

use frfit::c64;
use frfit::identify::{Line, Method, Options, Selection, Unknown, identify_at};
use frfit::model::Parameter;
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use frfit_examples::{File, Model, generate};
use frfit_formats::{csv, uff};
use toml::{Table, Value};

pub(crate) struct Folder(pub(crate) Vec<File>);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        Self(generate(name).unwrap())
    }

    pub(crate) fn bytes(&self, path: &str) -> &[u8] {
        let file = self.0.iter().find(|file| file.path == path);
        &file.unwrap_or_else(|| panic!("no {path}")).bytes
    }

    pub(crate) fn case(&self) -> Table {
        self.toml("case.toml")
    }

    pub(crate) fn toml(&self, path: &str) -> Table {
        std::str::from_utf8(self.bytes(path)).unwrap().parse().unwrap()
    }

    /// The tables `[[identify]]`, or the one `[identify]`.
    pub(crate) fn identify(&self) -> Vec<Table> {
        match &self.case()["identify"] {
            Value::Array(tables) => tables.iter().map(|table| table.as_table().unwrap().clone()).collect(),
            one => vec![one.as_table().unwrap().clone()],
        }
    }

    /// The case's options, of one unknown.
    pub(crate) fn options(&self) -> Options {
        let identify = &self.identify()[0];
        let method =
            identify.get("method").map_or(Method::default(), |word| word.as_str().unwrap().parse().unwrap());
        let order = identify.get("order").map_or(30, |order| order.as_integer().unwrap() as usize);
        let selection = identify
            .get("selection")
            .map_or(Selection::default(), |word| word.as_str().unwrap().parse().unwrap());
        Options::default().with_method(method).with_order(order).with_selection(selection)
    }

    /// A parameter as the case's only unknown, with its bounds.
    pub(crate) fn unknown(&self, parameter: &Parameter) -> Unknown {
        let identify = &self.identify()[0];
        let bound = |name| {
            let pair = identify["bounds"].get(name)?.as_array().unwrap();
            Some([0, 1].map(|k| pair[k].as_float().unwrap()))
        };
        Unknown {
            bounds: Bounds { storage: bound("storage"), loss_factor: bound("loss_factor") },
            real: identify.get("real").is_some_and(|real| real.as_bool().unwrap()),
            ..Unknown::of_parameter(parameter)
        }
    }

    /// Frequencies and receptances, [frequency][sensor], as the file holds them with its digits.
    pub(crate) fn measured(&self) -> (Vec<f64>, Vec<Vec<c64>>) {
        if !self.0.iter().any(|file| file.path == "frf.uff") {
            let case = self.case();
            let sensor = |entry: &Value| {
                let quantity: Quantity = entry["quantity"].as_str().unwrap().parse().unwrap();
                let table = csv::read_frf(self.bytes(entry["file"].as_str().unwrap())).unwrap();
                let receptance = |(f, u): (&f64, &c64)| quantity.to_receptance(*f, *u);
                let values: Vec<c64> =
                    table.frequency_hz.iter().zip(&table.response).map(receptance).collect();
                (table.frequency_hz, values)
            };
            let sensors: Vec<_> = case["measurement"].as_array().unwrap().iter().map(sensor).collect();
            let frequency_hz = sensors[0].0.clone();
            let at = |k| sensors.iter().map(|(_, values): &(_, Vec<c64>)| values[k]).collect();
            return (frequency_hz.clone(), (0..frequency_hz.len()).map(at).collect());
        }
        let file = uff::File::new(self.bytes("frf.uff")).unwrap();
        let functions: Vec<_> = file.functions().map(|index| file.function(index).unwrap()).collect();
        let frequency_hz = functions[0].abscissa.clone();
        let measured = (0..frequency_hz.len()).map(|k| {
            let receptance = |function: &uff::Function| {
                let uff::Values::Complex(values) = &function.values else { panic!("real FRF") };
                quantity(&function.header).to_receptance(frequency_hz[k], values[k])
            };
            functions.iter().map(receptance).collect()
        });
        (frequency_hz.clone(), measured.collect())
    }
}

pub(crate) fn quantity(header: &uff::FunctionHeader) -> Quantity {
    match header.ordinate.quantity {
        uff::Quantity::Displacement => Quantity::Receptance,
        uff::Quantity::Velocity => Quantity::Mobility,
        uff::Quantity::Acceleration => Quantity::Accelerance,
        other => panic!("{other:?}"),
    }
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_float().unwrap_or_else(|| value.as_integer().unwrap() as f64)
}

/// What came out at one frequency, and what should have.
pub(crate) struct Answer {
    pub(crate) frequency_hz: f64,
    pub(crate) found: Line,
    /// |E − truth| / |truth|; infinite where there is no answer.
    pub(crate) deviation: f64,
    /// ρ at the true correction: whether the series converges there.
    pub(crate) radius_at_truth: f64,
}

/// Identifies every `step`-th frequency in the paper's way, with the bounds of the case.
pub(crate) fn answers(folder: &Folder, model: &Model, step: usize) -> Vec<Answer> {
    let (frequency_hz, measured) = folder.measured();
    let unknown = folder.unknown(&model.parameter);
    let at = |(&f, measured): (&f64, &Vec<c64>)| {
        let truth = model.truth.at(f).unwrap();
        let found = identify_at(&model.nominal_at(f).unwrap(), measured, &unknown, &Options::paper());
        Answer {
            frequency_hz: f,
            deviation: found.factor().map_or(f64::INFINITY, |factor| (factor - truth).norm() / truth.norm()),
            radius_at_truth: found.radius.unwrap().at(truth - found.nominal()),
            found,
        }
    };
    frequency_hz.iter().zip(&measured).step_by(step).map(at).collect()
}
