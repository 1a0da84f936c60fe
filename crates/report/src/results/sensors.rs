//! `response.csv`: nominal, measured and updated response, as accelerance.

use super::columns::Columns;
use frfit::c64;
use frfit::modal::assurance;
use frfit::quantity::Quantity;
use frfit_formats::FormatError;

/// Accelerance at a sensor in m/(s²·N), by frequency.
#[derive(Debug)]
pub(crate) struct Sensor {
    pub(crate) label: String,
    /// What was measured.
    pub(crate) quantity: Quantity,
    pub(crate) nominal: Vec<Option<c64>>,
    pub(crate) measured: Vec<Option<c64>>,
    pub(crate) updated: Vec<Option<c64>>,
    /// Standard deviation √E|δH|² of the measured values.
    pub(crate) measured_std: Vec<Option<f64>>,
}

impl Sensor {
    /// The rows of the table are frequency by frequency, one for each label.
    pub(crate) fn read(
        table: &Columns,
        labels: &[String],
        frequency_hz: &[f64],
    ) -> Result<Vec<Self>, FormatError> {
        let count = labels.len();
        if count == 0 {
            return Err(FormatError::whole("at least one sensor, in summary.json too", "none"));
        }
        if table.rows() != count * frequency_hz.len() {
            let expected = format!(
                "{} rows, for {count} sensors and {} frequencies",
                count * frequency_hz.len(),
                frequency_hz.len()
            );
            return Err(FormatError::whole(expected, table.rows().to_string()));
        }
        let f = table.all_numbers("frequency_hz")?;
        let columns = ["frequency_hz", "sensor", "quantity"].map(|name| table.column(name));
        let [f_at, label_at, quantity_at] = columns;
        let (f_at, label_at, quantity_at) = (f_at?, label_at?, quantity_at?);
        let complex = |what: &str| -> Result<Vec<Option<c64>>, FormatError> {
            let (re, im) = (table.numbers(&format!("{what}_re"))?, table.numbers(&format!("{what}_im"))?);
            Ok(re.into_iter().zip(im).map(|(re, im)| Some(c64::new(re?, im?))).collect())
        };
        let (nominal, measured, updated) = (complex("nominal")?, complex("measured")?, complex("updated")?);
        let std = table.numbers("measured_std")?;
        let known = Quantity::ALL.map(|quantity| (quantity.name(), quantity));
        let mut sensors = Vec::with_capacity(count);
        for (m, label) in labels.iter().enumerate() {
            let mut sensor = Self {
                label: label.clone(),
                quantity: Quantity::Receptance,
                nominal: Vec::new(),
                measured: Vec::new(),
                updated: Vec::new(),
                measured_std: Vec::new(),
            };
            for (i, &expected) in frequency_hz.iter().enumerate() {
                let row = i * count + m;
                if f[row] != expected {
                    let expected = format!("{expected:?}, as in identified.csv");
                    return Err(table.error(row, f_at, expected, format!("{:?}", f[row])));
                }
                if table.text(row, label_at) != label {
                    let found = format!("{:?}", table.text(row, label_at));
                    return Err(table.error(row, label_at, format!("{label:?}, as in summary.json"), found));
                }
                sensor.quantity = table.word(row, quantity_at, &known)?;
                let accelerance = |value: Option<c64>| {
                    Quantity::Accelerance
                        .from_receptance(expected, sensor.quantity.to_receptance(expected, value?))
                        .into()
                };
                let finite = |value: Option<c64>| value.filter(|value| value.is_finite());
                sensor.nominal.push(finite(accelerance(nominal[row])));
                sensor.measured.push(finite(accelerance(measured[row])));
                sensor.updated.push(finite(accelerance(updated[row])));
                let std = accelerance(std[row].map(c64::from)).map(|std: c64| std.norm());
                sensor.measured_std.push(std.filter(|std| std.is_finite()));
            }
            sensors.push(sensor);
        }
        Ok(sensors)
    }

    /// The share of a response that a computed one reproduces, whatever its scale: |Σ u* x|² / (Σ|u|² Σ|x|²), 1 where they are proportional.
    pub(crate) fn frac(&self, computed: &[Option<c64>]) -> Option<f64> {
        let pairs = self.measured.iter().zip(computed).filter_map(|(u, x)| Some(((*u)?, (*x)?)));
        let (measured, own): (Vec<c64>, Vec<c64>) = pairs.unzip();
        assurance(&measured, &own).filter(|frac| frac.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn frac_is_one_for_what_is_proportional_and_never_more(
            values in proptest::collection::vec((-1e3..1e3_f64, -1e3..1e3_f64), 2..40),
            others in proptest::collection::vec((-1e3..1e3_f64, -1e3..1e3_f64), 40),
            scale in (0.1..10.0_f64, -10.0..10.0_f64),
        ) {
            let complex = |values: &[(f64, f64)]| values.iter().map(|&(re, im)| Some(c64::new(re, im))).collect::<Vec<_>>();
            let measured = complex(&values);
            let sensor = Sensor {
                label: String::new(), quantity: Quantity::Accelerance, nominal: Vec::new(), updated: Vec::new(),
                measured: measured.clone(), measured_std: Vec::new(),
            };
            let scaled: Vec<_> = measured.iter().map(|u| u.map(|u| u * c64::new(scale.0, scale.1))).collect();
            prop_assume!(values.iter().any(|(re, im)| re.hypot(*im) > 1e-3));
            prop_assert!((sensor.frac(&scaled).unwrap() - 1.0).abs() < 1e-12);
            let other = sensor.frac(&complex(&others[..values.len()]));
            prop_assert!(other.is_none_or(|frac| (0.0..=1.0 + 1e-12).contains(&frac)));
            prop_assert_eq!(sensor.frac(&vec![None; values.len()]), None);
        }
    }
}
