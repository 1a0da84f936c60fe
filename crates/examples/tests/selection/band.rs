//! Candidates over a band, as an identification finds them, from models whose answer is known.

use frfit::c64;
use frfit::rational::RationalResponse;
use frfit::response::{FullModel, Response};
use frfit::roots::Bounds;
use frfit::select::Node;
use frfit_examples::Model;

/// How a band is measured and searched.
pub(crate) struct Setup {
    /// Sensors used, the first of which gives the roots.
    pub(crate) sensors: usize,
    /// Standard deviation of real and imaginary part each, relative to the response's modulus; 0 for none.
    pub(crate) noise: f64,
    /// Largest order of the rational response.
    pub(crate) order: usize,
    /// Bounds on E′ relative to the truth's, and on η.
    pub(crate) storage: [f64; 2],
    pub(crate) loss_factor: [f64; 2],
}

/// What is found over a band.
pub(crate) struct Band {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) truth: Vec<c64>,
    pub(crate) nodes: Vec<Vec<Node>>,
}

/// Where σ is not known, misfits and standard deviations are relative to the response.
const ASSUMED: f64 = 1.0;

pub(crate) fn band(model: &Model, frequency_hz: Vec<f64>, setup: &Setup) -> Band {
    let mut noise = Noise(1);
    let truth: Vec<c64> = frequency_hz.iter().map(|&f| model.truth.at(f).unwrap()).collect();
    let nodes = frequency_hz.iter().zip(&truth).map(|(&f, &t)| at(model, f, t, setup, &mut noise)).collect();
    Band { frequency_hz, truth, nodes }
}

fn at(model: &Model, frequency_hz: f64, truth: c64, setup: &Setup, noise: &mut Noise) -> Vec<Node> {
    let exact = &model.measured_at(frequency_hz).unwrap()[..setup.sensors];
    let measured: Vec<c64> = exact.iter().map(|u| u + setup.noise * u.norm() * noise.complex()).collect();
    let level = if setup.noise > 0.0 { setup.noise } else { ASSUMED };
    let sigma: Vec<f64> = exact.iter().map(|u| level * u.norm()).collect();
    let [low, high] = setup.storage;
    let bounds =
        Bounds { storage: Some([low * truth.re, high * truth.re]), loss_factor: Some(setup.loss_factor) };
    let system = model.nominal_at(frequency_hz).unwrap();
    let response = RationalResponse::new(&system, 0, setup.order).unwrap();
    let nominal = system.nominal(0);
    let mut nodes: Vec<Node> = Vec::new();
    for root in response.roots(0, measured[0]).unwrap() {
        let mut correction = root.correction;
        if bounds.broken_by(nominal + correction).is_some()
            || !solves(&system, correction, measured[0], root.residual)
        {
            continue;
        }
        if setup.noise > 0.0 && setup.sensors > 1 {
            correction = least_squares(&response, &measured, &sigma, correction);
            if bounds.broken_by(nominal + correction).is_some() {
                continue;
            }
        }
        let Ok(x) = (if setup.sensors > 1 {
            system.solve_at(&[correction]).map_err(|_| ())
        } else {
            Ok(measured.clone())
        }) else {
            continue;
        };
        let misfit = x.iter().zip(&measured).zip(&sigma).map(|((x, u), s)| ((x - u) / s).norm_sqr()).sum();
        let curvature: f64 =
            slopes(&response, correction).iter().zip(&sigma).map(|(d, s)| (d / s).norm_sqr()).sum();
        let std = 1.0 / curvature.sqrt();
        let factor = nominal + correction;
        if nodes.iter().any(|n: &Node| (n.factor - factor).norm() < 1e-9 * factor.norm()) {
            continue;
        }
        nodes.push(Node { factor, misfit, std });
    }
    nodes
}

fn solves(system: &FullModel<'_>, correction: c64, measured: c64, residual: f64) -> bool {
    residual <= 1e-9
        || system.solve_at(&[correction]).is_ok_and(|x| (x[0] - measured).norm() <= 1e-6 * measured.norm())
}

/// dx_m/dc at the sensors.
fn slopes(response: &RationalResponse, correction: c64) -> Vec<c64> {
    let step = c64::new(1e-5 * correction.norm(), 0.0);
    let [ahead, back] = [correction + step, correction - step].map(|c| response.respond(c).unwrap());
    ahead.iter().zip(&back).map(|(a, b)| (a - b) / (2.0 * step)).collect()
}

/// Gauss–Newton for Σ |u_m − x_m|²/σ_m² from a root.
fn least_squares(response: &RationalResponse, measured: &[c64], sigma: &[f64], start: c64) -> c64 {
    let misfit = |c: c64| -> f64 {
        let x = response.respond(c).unwrap();
        x.iter().zip(measured).zip(sigma).map(|((x, u), s)| ((x - u) / s).norm_sqr()).sum()
    };
    let mut c = start;
    let mut best = misfit(c);
    for _ in 0..10 {
        let x = response.respond(c).unwrap();
        let (mut top, mut bottom) = (c64::default(), 0.0);
        for (((x, u), s), d) in x.iter().zip(measured).zip(sigma).zip(slopes(response, c)) {
            top += d.conj() * (u - x) / (s * s);
            bottom += d.norm_sqr() / (s * s);
        }
        let mut step = top / bottom;
        while step.norm() > 1e-10 * start.norm() {
            let next = misfit(c + step);
            if next < best {
                c += step;
                best = next;
                break;
            }
            step *= 0.5;
        }
    }
    c
}

/// Normal deviates from a linear congruential generator (D. E. Knuth's MMIX constants) and Box–Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn complex(&mut self) -> c64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        c64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }
}
