//! Planted faults are named, each alone; clean data with a wrong nominal get none.

mod common;
mod noise;

use common::{Case, bar, plate, sandwich};
use frfit::c64;
use frfit::doctor::{Diagnosis, Fault, Finding, KnownFactor, NotJudged, diagnose};
use frfit::for_each::sequential;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::identify::{Band, Noise as Known, Options};
use frfit::material::Law;
use frfit::model::{Experiment, Sensor};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use noise::Noise;

/// A test on a structure: what is written in its files, and what the case says of it.
struct Test {
    case: Case,
    frequency_hz: Vec<f64>,
    /// Values as they are written, `[frequency][sensor]`.
    written: Vec<Vec<c64>>,
    quantities: Vec<Quantity>,
    bounds: Bounds,
}

impl Test {
    /// Accelerances measured with noise of this size, with the nominal so many times the truth.
    fn new(mut case: Case, count: usize, noise: f64, seed: u64, nominal: f64) -> Self {
        let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], count);
        let mut random = Noise::new(seed);
        let written = frequency_hz
            .iter()
            .map(|&f| {
                let x = case.direct(f, c64::default()).unwrap();
                let disturbed = |x: &c64| {
                    let noisy = x * (1.0 + noise / 2f64.sqrt() * random.complex());
                    Quantity::Accelerance.from_receptance(f, noisy)
                };
                x.iter().map(disturbed).collect()
            })
            .collect();
        case.parameter.nominal = case.parameter.nominal.scaled(nominal);
        let quantities = vec![Quantity::Accelerance; case.experiment.sensors.len()];
        let size = case.parameter.nominal.at(case.band_hz[1]).unwrap().re;
        let bounds = Bounds { storage: Some([size / 100.0, size * 100.0]), loss_factor: Some([0.0, 3.0]) };
        Self { case, frequency_hz, written, quantities, bounds }
    }

    /// Changes every value of some sensors.
    fn change(mut self, sensors: &[usize], by: impl Fn(f64, c64) -> c64) -> Self {
        for (&f, values) in self.frequency_hz.iter().zip(&mut self.written) {
            sensors.iter().for_each(|&m| values[m] = by(f, values[m]));
        }
        self
    }

    fn diagnose(&self) -> Diagnosis {
        let receptance = |(&f, values): (&f64, &Vec<c64>)| {
            values.iter().zip(&self.quantities).map(|(&v, q)| q.to_receptance(f, v)).collect()
        };
        let measured: Vec<Vec<c64>> = self.frequency_hz.iter().zip(&self.written).map(receptance).collect();
        let band = Band {
            model: &self.case.model,
            experiment: &self.case.experiment,
            parameter: &self.case.parameter,
            frequency_hz: &self.frequency_hz,
            measured: &measured,
            noise: Known::Unknown,
        };
        let options = Options { bounds: self.bounds, ..Options::default() };
        diagnose(&band, &self.quantities, &options, &sequential).unwrap()
    }
}

/// The one finding.
fn alone(name: &str, diagnosis: &Diagnosis) -> Finding {
    let [finding] = diagnosis.findings.as_slice() else { panic!("{name}: {diagnosis:#?}") };
    finding.clone()
}

/// Small structures with their names: a bar of rubber, a plate of little damping, a sandwich.
fn structures() -> Vec<(&'static str, fn() -> Case)> {
    vec![("bar", || bar(60)), ("plate", || plate(8, 0.4, 5e-3)), ("sandwich", || sandwich(12, 1))]
}

#[test]
#[ignore]
fn look() {
    for (name, make) in structures() {
        for nominal in [0.7, 1.3] {
            let t = std::time::Instant::now();
            let d = Test::new(make(), 150, 0.02, 1, nominal).diagnose();
            println!("clean {name} {nominal} {:?} {:?}: {:?} {:?}", d.findings, d.misfit, d.work, t.elapsed());
        }
        let faults: Vec<(&str, Box<dyn Fn(f64, c64) -> c64>)> = vec![
            ("conj", Box::new(|_, v| v.conj())),
            ("sign", Box::new(|_, v| -v)),
            ("rec", Box::new(|f, v| Quantity::Accelerance.to_receptance(f, v))),
            ("mob", Box::new(|f, v| v / c64::new(0.0, omega_rad_s(f)))),
            ("g", Box::new(|_, v| v / 9.80665)),
            ("1e3", Box::new(|_, v| v * 1e3)),
            ("1.5", Box::new(|_, v| v * 1.5)),
            ("delay", Box::new(|f, v| v * c64::from_polar(1.0, -omega_rad_s(f) * 3e-4))),
        ];
        for (fault, by) in &faults {
            for scope in [vec![0, 1], vec![1]] {
                let t = std::time::Instant::now();
                let d = Test::new(make(), 150, 0.02, 1, 0.75).change(&scope, by).diagnose();
                println!("{fault} {name} {scope:?} {:?} {:?}: {:?} {:?}", d.findings, d.misfit, d.work, t.elapsed());
            }
        }
        for (what, load) in [("response", false), ("load", true)] {
            let t = std::time::Instant::now();
            let mut test = Test::new(make(), 150, 0.02, 1, 0.75);
            let n = test.case.model.dim();
            let was = if load {
                let row = test.case.experiment.load.iter().position(|f| f.norm() > 0.0).unwrap();
                let other = (row + n / 3) % n;
                test.case.experiment.load.swap(row, other);
                row
            } else {
                let s = &mut test.case.experiment.sensors[0];
                let was = s.row;
                s.row = (s.row + n / 3) % n;
                was
            };
            let d = test.diagnose();
            println!("{what} {name} true row {was} {:?} {:?}: {:?} {:?}", d.findings, d.misfit, d.work, t.elapsed());
        }
    }
}
