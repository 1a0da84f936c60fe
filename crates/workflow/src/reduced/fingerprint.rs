//! What a reduced model belongs to, by checksums of numbers: whatever format they were read from.

use crate::output::hexadecimal;
use frfit::c64;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit_linalg::sparse::Values;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

/// Checksums of matrices, load and sensors.
#[derive(Debug, PartialEq)]
pub(super) struct Fingerprint {
    dofs: usize,
    /// Name and checksum of each.
    matrices: Vec<(String, String)>,
    load: String,
    /// Row (from 1) and sense of each.
    sensors: Vec<String>,
}

impl Fingerprint {
    pub(super) fn of(model: &DynamicStiffness, experiment: &Experiment) -> Self {
        // All matrices have one pattern.
        let (shared, mut pattern) = (model.analysis().pattern(), Sha256::new());
        for indices in [shared.col_ptr(), shared.row_idx()] {
            numbers(&mut pattern, indices.iter().map(|&k| (k as u64).to_le_bytes()));
        }
        let pattern = hexadecimal(&pattern.finalize());
        let matrices = model.terms().iter().map(|term| {
            let mut sum = Sha256::new();
            sum.update(&pattern);
            sum.update(match term.role {
                Role::Stiffness => "stiffness",
                Role::Viscous => "viscous",
                Role::Mass => "mass",
            });
            match term.matrix.values() {
                Values::Real(values) => numbers(&mut sum, values.iter().map(|v| v.to_le_bytes())),
                Values::Complex(values) => {
                    sum.update("complex");
                    numbers(&mut sum, values.iter().flat_map(parts));
                }
            }
            (term.name.clone(), hexadecimal(&sum.finalize()))
        });
        let mut load = Sha256::new();
        numbers(&mut load, experiment.load.iter().flat_map(parts));
        let sensor =
            |at: &frfit::model::Sensor| format!("{}{}", at.row + 1, if at.sign < 0.0 { '-' } else { '+' });
        Self {
            dofs: model.dim(),
            matrices: matrices.collect(),
            load: hexadecimal(&load.finalize()),
            sensors: experiment.sensors.iter().map(sensor).collect(),
        }
    }

    pub(super) fn json(&self) -> Value {
        let matrices: Vec<Value> =
            self.matrices.iter().map(|(name, sha256)| json!({"name": name, "sha256": sha256})).collect();
        json!({"dofs": self.dofs, "matrices": matrices, "load": self.load, "sensors": self.sensors})
    }

    /// In what another one differs, as [`Fingerprint::json`] has it.
    pub(super) fn differs_from(&self, other: &Value) -> Option<String> {
        if other["dofs"] != self.dofs {
            return Some(format!("{} degrees of freedom, where this model has {}", other["dofs"], self.dofs));
        }
        let matrices = other["matrices"].as_array().map_or(&[][..], Vec::as_slice);
        if matrices.len() != self.matrices.len() {
            return Some(format!(
                "{} matrices, where this model has {}",
                matrices.len(),
                self.matrices.len()
            ));
        }
        for ((name, sha256), kept) in self.matrices.iter().zip(matrices) {
            if kept["sha256"] != *sha256 {
                return Some(format!("another matrix in place of {name:?}"));
            }
        }
        if other["load"] != self.load {
            return Some("another load".into());
        }
        let sensors = other["sensors"].as_array().map_or(&[][..], Vec::as_slice);
        if !sensors.iter().eq(self.sensors.iter()) {
            let listed: Vec<&str> = sensors.iter().filter_map(Value::as_str).collect();
            let (rows, own) = (listed.join(", "), self.sensors.join(", "));
            return Some(format!("sensors at rows {rows}, where this case has {own}"));
        }
        None
    }
}

fn parts(value: &c64) -> [[u8; 8]; 2] {
    [value.re.to_le_bytes(), value.im.to_le_bytes()]
}

/// Numbers a page at a time: a call for each costs more than the checksum.
fn numbers(sum: &mut Sha256, numbers: impl Iterator<Item = [u8; 8]>) {
    const PAGE: usize = 4096;
    let mut page = Vec::with_capacity(PAGE);
    for number in numbers {
        page.extend(number);
        if page.len() == PAGE {
            sum.update(&page);
            page.clear();
        }
    }
    sum.update(&page);
}
