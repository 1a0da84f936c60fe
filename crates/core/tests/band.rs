//! A band at once against direct solves of the full model.

mod common;

use common::{Case, bar, plate, sandwich};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{Band, BandOutcome, Hooks, Identified, Noise, Options, Stage, identify_band};
use frfit::material::Law;
use frfit::roots::Bounds;

fn quiet(_: Stage, _: usize, _: usize) {}

fn scaled(law: &Law, by: f64) -> Law {
    match law {
        Law::Constant(value) => Law::Constant(value * by),
        Law::Fractional { e0, e1, alpha } => Law::Fractional { e0: e0 * by, e1: e1 * by, alpha: *alpha },
        Law::Table(_) => unreachable!("no test has one"),
    }
}

/// What would be measured if the factor were the case's nominal one: direct solves.
fn measured(case: &Case, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    frequency_hz.iter().map(|&f| case.direct(f, c64::default()).unwrap()).collect()
}

fn identify(case: &Case, frequency_hz: &[f64], measured: &[Vec<c64>], options: &Options) -> BandOutcome {
    let band = Band {
        model: &case.model,
        experiment: &case.experiment,
        parameter: &case.parameter,
        frequency_hz,
        measured,
        noise: Noise::Unknown,
    };
    identify_band(&band, options, Hooks { for_each: &sequential, progress: &quiet }).unwrap()
}

/// Distance of the nearest admitted root from the truth, relative to it.
fn nearest(outcome: &Identified, truth: c64) -> f64 {
    let admitted = outcome.roots.iter().filter(|root| root.refusal.is_none());
    admitted
        .map(|root| (outcome.nominal + root.correction - truth).norm() / truth.norm())
        .fold(f64::INFINITY, f64::min)
}

fn explore_truth(mut case: Case, offs: &[f64], n: usize) {
    let truth = case.parameter.nominal.clone();
    let fs = linear_hz(case.band_hz[0], case.band_hz[1], n);
    let u = measured(&case, &fs);
    for &off in offs {
        case.parameter.nominal = scaled(&truth, off);
        let t = std::time::Instant::now();
        let e = truth.at(case.band_hz[1]).unwrap().re;
        let bounds = Bounds { storage: Some([0.1*e, 10.0 * e]), loss_factor: Some([0.0, 1.0]) };
        let options = Options { bounds, ..Options::default() };
        let out = identify(&case, &fs, &u, &options);
        let mut d: Vec<(f64, f64)> = out.outcomes.iter().map(|o| (nearest(o, truth.at(o.frequency_hz).unwrap()), o.frequency_hz)).collect();
        d.sort_by(|a, b| b.0.total_cmp(&a.0));
        let found = d.iter().filter(|d| d.0 < 1e-6).count();
        let st = |s| out.outcomes.iter().filter(|o| o.status == s).count();
        println!("{} off {off}: {found}/{n} worst {:?} size {:?} {:?} statuses {:?} cert max {:?} {:?}", case.name, &d[..4], out.subspace_size, out.work,
            frfit::identify::Status::ALL.map(st), out.outcomes.iter().filter_map(|o| o.certificate).fold(0.0, f64::max), t.elapsed());
    }
}

#[test]
fn explore() {
    let offs = [1.25, 0.75, 1.5, 0.5, 3.0, 1.0 / 3.0];
    explore_truth(plate(10, 0.32, 1e-3), &offs, 120);
    explore_truth(plate(10, 0.4, 1e-5), &offs, 120);
    explore_truth(bar(100), &offs, 120);
    explore_truth(sandwich(12, 1), &offs, 120);
}

#[test]
fn explore_counts() {
    let plate = plate(20, 0.32, 1e-3);
    for n in [100, 400] {
    let t = std::time::Instant::now();
    let fs = linear_hz(20.0, 4000.0, n);
    let u = fs.iter().map(|&f| plate.direct(f, plate.correction(f, 0.8)).unwrap()).collect::<Vec<_>>();
    println!("direct {:?}", t.elapsed());
    let t = std::time::Instant::now();
    let bounds = Bounds { storage: Some([1e11, 3e11]), loss_factor: Some([0.0, 1.0]) };
    let options = Options { bounds, ..Options::default() };
    let out = identify(&plate, &fs, &u, &options);
    println!("{:?} {:?} {:?}", out.work, out.subspace_size, t.elapsed());
    }
    let s = sandwich(30, 2);
    for n in [250, 1000] {
    let t = std::time::Instant::now();
    let fs = linear_hz(20.0, 1000.0, n);
    let u = fs.iter().map(|&f| s.direct(f, s.correction(f, 0.8)).unwrap()).collect::<Vec<_>>();
    println!("direct {:?}", t.elapsed());
    let t = std::time::Instant::now();
    let bounds = Bounds { storage: Some([2e5, 2e8]), loss_factor: Some([0.0, 2.0]) };
    let options = Options { bounds, ..Options::default() };
    let out = identify(&s, &fs, &u, &options);
    println!("{:?} {:?} {:?}", out.work, out.subspace_size, t.elapsed());
    }
}
