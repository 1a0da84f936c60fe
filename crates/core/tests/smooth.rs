//! Smooth moduli.
mod common;
mod noise;

use common::{Case, bar, plate, sandwich};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{Band, Hooks, Noise as Known, Options, SmoothOutcome, Stage, Status, identify_smooth};
use frfit::material::loss_factor;
use frfit::roots::Bounds;
use noise::Noise;

#[test]
fn explore() {
    for (case, band_hz, n) in [(plate(6, 0.4, 1e-3), [100.0, 2500.0], 40), (plate(6, 0.4, 1e-2), [100.0, 2500.0], 16), (bar(66), [60.0, 900.0], 16), (sandwich(6, 1), [40.0, 1000.0], 16)] {
        let frequency_hz = linear_hz(band_hz[0], band_hz[1], n);
        let clean: Vec<Vec<c64>> = frequency_hz.iter().map(|&f| case.direct(f, case.correction(f, 0.8)).unwrap()).collect();
        if case.name != "sandwich" { continue; }
        for share in [5e-2] {
            for known in [true, false] {
                let mut noise = Noise::new(3);
                let (mut ok, mut hit, mut all, mut rms, mut free_ok, mut free_rms, mut par) = (0, [0, 0], 0, [0.0f64; 2], 0, [0.0f64; 2], 0.0);
                let seeds = 120;
                let mut work = (0, 0);
                let start = std::time::Instant::now();
                let mut statuses = std::collections::BTreeMap::new();
                for _ in 0..seeds {
                    let std: Vec<Vec<f64>> = clean.iter().map(|u| u.iter().map(|u| share * u.norm()).collect()).collect();
                    let u: Vec<Vec<c64>> = clean.iter().zip(&std).map(|(u, s)| u.iter().zip(s).map(|(u, s)| u + s / 2f64.sqrt() * noise.complex()).collect()).collect();
                    let [low, high] = band_hz.map(|f| case.parameter.nominal.at(f).unwrap().re);
                    let bounds = Bounds { storage: Some([low / 3.0, high * 3.0]), loss_factor: Some([0.0, 2.0]) };
                    let band = Band { model: &case.model, experiment: &case.experiment, parameter: &case.parameter, frequency_hz: &frequency_hz, measured: &u, noise: if known { Known::Known(&std) } else { Known::Relative(&std) } };
                    let got: SmoothOutcome = identify_smooth(&band, &Options { bounds, ..Options::default() }, Hooks { for_each: &sequential, progress: &|_: Stage, _, _| {} }).unwrap();
                    work.0 = work.0.max(got.free.work.factorisations); work.1 = work.1.max(got.band.work.factorisations);
                    if let Some(c) = &got.curve { par += c.parameters; }
                    for (o, f) in got.band.outcomes.iter().zip(&got.free.outcomes) {
                        let truth = 0.8 * case.parameter.nominal.at(o.frequency_hz).unwrap();
                        all += 1;
                        *statuses.entry(o.status.name()).or_insert(0) += 1;
                        if f.status == Status::Ok { free_ok += 1; let x = f.factor().unwrap(); free_rms[0] += (x.re / truth.re - 1.0).powi(2); free_rms[1] += (loss_factor(x) / loss_factor(truth) - 1.0).powi(2); }
                        if o.status == Status::Ok {
                            ok += 1; let x = o.factor().unwrap(); let b = o.uncertainty.unwrap();
                            rms[0] += (x.re / truth.re - 1.0).powi(2); rms[1] += (loss_factor(x) / loss_factor(truth) - 1.0).powi(2);
                            hit[0] += usize::from((x.re - truth.re).abs() <= 2.0 * b.storage_std);
                            hit[1] += usize::from((loss_factor(x) - loss_factor(truth)).abs() <= 2.0 * b.loss_factor_std.unwrap());
                        }
                    }
                }
                let f = |v: f64, n: i32| (v / f64::from(n)).sqrt();
                println!("{} {share} known {known}: ok {ok}/{all} cover {:.3} {:.3} rms {:.1e} {:.1e}; free ok {free_ok} rms {:.1e} {:.1e}; par {:.1} work {work:?} {statuses:?} {:.1}s", case.name,
                    hit[0] as f64 / f64::from(ok), hit[1] as f64 / f64::from(ok), f(rms[0], ok), f(rms[1], ok), f(free_rms[0], free_ok), f(free_rms[1], free_ok), par / f64::from(seeds), start.elapsed().as_secs_f64());
            }
        }
    }
}
