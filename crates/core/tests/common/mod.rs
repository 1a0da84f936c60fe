//! Small models for the tests of this crate.
#![allow(dead_code, reason = "each test file uses its own part")]

use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    ChannelUnknowns, Context, Dependence, Frfs, Identification, Method, ModelErrors, Noise, Options, Problem,
    Reduction, Selection, Unknown, Variation, identify,
};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Member, ModelAt, Parameter, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit::roots::Bounds;
use frfit::subspace::{Point, Subspace, TrainOptions, Trained};
use frfit_fem::brick::{Face, Layer};
use frfit_fem::{Assembled, Bar, Beam, Brick, Direction, Mass, Plate, Support};
use frfit_linalg::solve::Breakdown;
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Triplets, Values};
use std::sync::Arc;

pub(crate) fn c(re: f64, im: f64) -> c64 {
    c64::new(re, im)
}

pub(crate) fn term(name: &str, role: Role, matrix: SymmetricMatrix, factor: c64) -> Term {
    Term { name: name.to_owned(), role, matrix, factor: Law::Constant(factor) }
}

/// Clamped–free chain of n unit masses and unit springs: `stiffness` × K and `mass` × M.
pub(crate) fn chain(n: usize, stiffness: c64, mass: f64) -> DynamicStiffness {
    let (mut k, mut m) = (Triplets::new(n), Triplets::new(n));
    k.add(0, 0, 1.0);
    for i in 0..n {
        m.add(i, i, 1.0);
        if i + 1 < n {
            k.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    DynamicStiffness::new(vec![
        term("springs", Role::Stiffness, k.assemble(), stiffness),
        term("masses", Role::Mass, m.assemble(), c(mass, 0.0)),
    ])
    .unwrap()
}

/// Unit force on the last row, measured at the given rows.
pub(crate) fn tip_load(model: &DynamicStiffness, rows: &[usize]) -> Experiment {
    let sensor = |row| Sensor { row, sign: 1.0 };
    Experiment::driven_at(model.dim(), sensor(model.dim() - 1), rows.iter().copied().map(sensor).collect())
}

/// Full symmetric n × n matrix from the values of its lower triangle, repeated as needed.
pub(crate) fn full(n: usize, values: &[c64]) -> SymmetricMatrix {
    let pattern = Arc::new(Pattern::new(n, (0..n).flat_map(|i| (0..i).map(move |j| (i, j)))));
    let values = (0..pattern.stored()).map(|k| values[k % values.len()]).collect();
    SymmetricMatrix::new(pattern, Values::Complex(values))
}

/// All of one term's factor, to the given power.
pub(crate) fn unknown(term: usize, power: usize, nominal: c64) -> Parameter {
    Parameter { members: vec![Member { term, power }], nominal: Law::Constant(nominal), multiplies: false }
}

/// Taylor coefficients times r^k, k = 0 … `count` − 1, at sensor `m`: Cauchy's integral on the circle |c| = r, by direct
/// solves alone (J. N. Lyness, C. B. Moler, SIAM J. Numer. Anal. 4 (1967) 202–210).
pub(crate) fn taylor_on_circle(system: &FullModel<'_>, r: f64, count: usize, m: usize) -> Vec<c64> {
    // Aliasing falls like (r/R)^points; the callers take r well inside the radius R.
    let points = 128;
    let angle = |i: usize| std::f64::consts::TAU * (i % points) as f64 / points as f64;
    let values: Vec<c64> =
        (0..points).map(|i| system.solve_at(&[c64::from_polar(r, angle(i))]).unwrap()[m]).collect();
    (0..count)
        .map(|k| {
            let sum: c64 =
                values.iter().enumerate().map(|(i, x)| x * c64::from_polar(1.0, -angle(i * k))).sum();
            sum / points as f64
        })
        .collect()
}

/// A model, what drives it, what is unknown in it, and the box in which it is looked for.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) model: DynamicStiffness,
    pub(crate) experiment: Experiment,
    pub(crate) parameter: Parameter,
    /// First and last frequency.
    pub(crate) band_hz: [f64; 2],
    /// The factor over its nominal value, least and largest.
    pub(crate) box_ratio: [f64; 2],
}

impl Case {
    /// The model at a frequency, about the nominal value.
    pub(crate) fn at(&self, frequency_hz: f64) -> ModelAt<'_> {
        self.model.at(frequency_hz, std::slice::from_ref(&self.parameter)).unwrap()
    }

    /// The correction at which the factor is so many times its nominal value.
    pub(crate) fn correction(&self, frequency_hz: f64, ratio: f64) -> c64 {
        self.parameter.nominal.at(frequency_hz).unwrap() * (ratio - 1.0)
    }

    /// x at the sensors by one direct solve of the full model: the oracle.
    pub(crate) fn direct(&self, frequency_hz: f64, correction: c64) -> Result<Vec<c64>, Breakdown> {
        let factor = self.model.analysis().factor(&self.at(frequency_hz).assemble(&[correction]))?;
        let mut x = self.experiment.load.clone();
        factor.solve(&mut x)?;
        Ok(self.experiment.observe(&x))
    }

    /// Points on a grid over the box: `frequencies` × `ratios`.
    pub(crate) fn grid(&self, frequencies: usize, ratios: usize) -> Vec<Point<'_>> {
        let [low, high] = self.box_ratio;
        let ratio = move |k: usize| low * (high / low).powf(k as f64 / (ratios - 1) as f64);
        let at = linear_hz(self.band_hz[0], self.band_hz[1], frequencies).into_iter();
        at.flat_map(|f| {
            (0..ratios).map(move |k| Point { at: self.at(f), correction: self.correction(f, ratio(k)) })
        })
        .collect()
    }

    /// A subspace for the whole box, trained to this error.
    pub(crate) fn trained(&self, tolerance: f64) -> (Subspace<'_>, Trained) {
        let mut subspace = Subspace::new(&self.experiment, &self.at(self.band_hz[1])).unwrap();
        let options = TrainOptions::default().with_tolerance(tolerance);
        let trained = subspace.train(&self.grid(40, 5), &options, &sequential).unwrap();
        (subspace, trained)
    }

    /// Frequencies and ratios of the factor, anywhere in the box, in no order: a Kronecker sequence.
    pub(crate) fn scattered(&self, count: usize) -> Vec<(f64, f64)> {
        let ([f0, f1], [low, high]) = (self.band_hz, self.box_ratio);
        // Multiples of powers of the inverse of the plastic number fill the square evenly (M. Roberts, 2018).
        let (a, b) = (0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
        let point = |k: usize| {
            let [u, v] = [(k as f64 * a).fract(), (k as f64 * b).fract()];
            (f0 + (f1 - f0) * u, low * (high / low).powf(v))
        };
        (1..=count).map(point).collect()
    }
}

/// An assembled structure of one material, its stiffness unknown.
pub(crate) fn structure(
    name: &'static str,
    assembled: &Assembled,
    [modulus, density]: [c64; 2],
    experiment: Experiment,
    band_hz: [f64; 2],
) -> Case {
    let model = DynamicStiffness::new(vec![
        term("stiffness", Role::Stiffness, assembled.stiffness[0].clone(), modulus),
        term("mass", Role::Mass, assembled.mass[0].clone(), density),
    ])
    .unwrap();
    let parameter = Parameter::factor_of(&model, &["stiffness"]).unwrap();
    Case { name, model, experiment, parameter, band_hz, box_ratio: [0.5, 2.0] }
}

fn nearest(assembled: &Assembled, position: [f64; 3], direction: Direction) -> Sensor {
    let node = assembled.nearest(position).unwrap();
    Sensor { row: assembled.row(node, direction).unwrap(), sign: 1.0 }
}

/// A steel plate of 0.32 m × `side` × 10 mm, n × n elements, clamped all around, driven and measured off its lines of symmetry.
pub(crate) fn plate(n: usize, side: f64, loss_factor: f64) -> Case {
    let plate =
        Plate { sides: [0.32, side], elements: [n; 2], edges: [Support::Clamped; 4], ..Plate::default() };
    let plate = plate.assemble().unwrap();
    let at = |x: f64, y: f64| nearest(&plate, [x * 0.32, y * side, 0.0], Direction::Z);
    let experiment =
        Experiment::driven_at(plate.dofs.len(), at(0.35, 0.3), vec![at(0.6, 0.45), at(0.2, 0.7)]);
    structure("plate", &plate, [c(2e11, 2e11 * loss_factor), c(7800.0, 0.0)], experiment, [20.0, 4000.0])
}

/// A cantilever beam of steel, bending; its lumped mass has nothing in the rotations.
pub(crate) fn beam(elements: usize, loss_factor: f64, mass: Mass) -> Case {
    let beam = Beam {
        length: 1.0,
        area: 1e-4,
        inertia: 1e-4 * 1e-4 / 12.0,
        elements,
        ends: [Support::Clamped, Support::Free],
        mass,
        shear: None,
    };
    let beam = beam.assemble().unwrap();
    let at = |x: f64| nearest(&beam, [x, 0.0, 0.0], Direction::Z);
    let experiment = Experiment::driven_at(beam.dofs.len(), at(1.0), vec![at(0.6), at(0.3)]);
    structure("beam", &beam, [c(2e11, 2e11 * loss_factor), c(7800.0, 0.0)], experiment, [10.0, 1000.0])
}

/// A free–free bar of rubber, driven at one end and measured at the other and in the middle.
pub(crate) fn bar(elements: usize) -> Case {
    let bar = Bar { length: 0.3048, area: 5e-4, elements, ..Bar::default() }.assemble().unwrap();
    let at = |x: f64| nearest(&bar, [x, 0.0, 0.0], Direction::X);
    let experiment = Experiment::driven_at(bar.dofs.len(), at(0.0), vec![at(0.3048), at(0.15)]);
    let mut case = structure("bar", &bar, [c(1.0, 0.0), c(910.0, 0.0)], experiment, [20.0, 2000.0]);
    case.parameter.nominal = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
    case
}

/// A cantilever of two aluminium skins on a core of rubber, its core unknown: 3 nx (ny + 1) 4 rows.
pub(crate) fn sandwich(nx: usize, ny: usize) -> Case {
    sandwich_at(nx, ny, [0.3, 0.0], &[[1.0, 1.0], [0.5, 0.0]])
}

/// The same, driven and measured at the nodes nearest to these parts of its length and width.
pub(crate) fn sandwich_at(nx: usize, ny: usize, load: [f64; 2], sensors: &[[f64; 2]]) -> Case {
    let skin = Layer { thickness: 0.0015, material: 0, ..Layer::default() };
    let core = Layer { thickness: 0.002, elements: 1, poisson: 0.45, material: 1 };
    let (length, width) = (0.24, 0.03);
    let layers = vec![skin, core, skin];
    let beam =
        Brick { length, width, elements: [nx, ny], layers, clamped: vec![Face::XMin], ..Brick::default() };
    let beam = beam.assemble().unwrap();
    let at = |[x, y]: [f64; 2]| nearest(&beam, [x * length, y * width, 0.005], Direction::Z);
    let sensors = sensors.iter().map(|&place| at(place)).collect();
    let experiment = Experiment::driven_at(beam.dofs.len(), at(load), sensors);
    let core = Law::Fractional { e0: 1.5 * 8.14e5, e1: 1.5 * 7.31e4, alpha: 0.528 };
    let model = DynamicStiffness::new(vec![
        term("skins", Role::Stiffness, beam.stiffness[0].clone(), c(7e10, 7e7)),
        Term { name: "core".into(), role: Role::Stiffness, matrix: beam.stiffness[1].clone(), factor: core },
        term("skins-mass", Role::Mass, beam.mass[0].clone(), c(2700.0, 0.0)),
        term("core-mass", Role::Mass, beam.mass[1].clone(), c(910.0, 0.0)),
    ])
    .unwrap();
    let parameter = Parameter::factor_of(&model, &["core"]).unwrap();
    let name = "sandwich";
    Case { name, model, experiment, parameter, band_hz: [20.0, 1000.0], box_ratio: [0.5, 2.0] }
}

/// A chain of unit masses on unit springs, clamped at its beginning: one factor for the springs of each half, driven at its end and measured at three places.
pub(crate) fn two_part_chain(masses: usize) -> Case {
    let springs = |range: std::ops::Range<usize>| {
        let mut k = Triplets::new(masses);
        for i in range {
            match i.checked_sub(1) {
                None => k.add(0, 0, 1.0),
                Some(before) => k.add_element(&[Some(before), Some(i)], &[1.0, -1.0, -1.0, 1.0]),
            }
        }
        k.assemble()
    };
    let mut m = Triplets::new(masses);
    (0..masses).for_each(|i| m.add(i, i, 1.0));
    let model = DynamicStiffness::new(vec![
        term("first", Role::Stiffness, springs(0..masses / 2), c(1.0, 0.03)),
        term("second", Role::Stiffness, springs(masses / 2..masses), c(1.0, 0.03)),
        term("masses", Role::Mass, m.assemble(), c(1.0, 0.0)),
    ])
    .unwrap();
    let sensor = |row| Sensor { row, sign: 1.0 };
    let sensors = vec![sensor(masses - 1), sensor(masses / 2), sensor(masses / 4)];
    let experiment = Experiment::driven_at(masses, sensor(masses - 1), sensors);
    let parameter = Parameter::factor_of(&model, &["first"]).unwrap();
    Case { name: "two-part chain", model, experiment, parameter, band_hz: [0.1, 0.18], box_ratio: [0.5, 2.0] }
}

/// The plate's thickness, relative: cubed in bending, once in the mass (B-8).
pub(crate) fn thickness() -> Case {
    let case = plate(8, 0.32, 1e-2);
    let mut terms: Vec<Term> = case.model.terms().to_vec();
    let scaled = |values: &[f64], by: f64| Values::Real(values.iter().map(|v| v * by).collect());
    for (term, by) in terms.iter_mut().zip([2e11, 7800.0]) {
        let values = scaled(term.matrix.real_values().unwrap(), by);
        term.matrix = SymmetricMatrix::new(term.matrix.pattern().clone(), values);
    }
    for term in &mut terms {
        term.factor = Law::Constant(c(1.0, 0.0));
    }
    let parameter = Parameter {
        members: vec![Member { term: 0, power: 3 }, Member { term: 1, power: 1 }],
        nominal: Law::Constant(c(1.0, 0.003)),
        multiplies: true,
    };
    let model = DynamicStiffness::new(terms).unwrap();
    Case { name: "thickness", model, parameter, box_ratio: [0.7, 1.4], ..case }
}

/// How a single unknown is identified, and what is known of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Setup {
    pub(crate) bounds: Bounds,
    pub(crate) real: bool,
    pub(crate) options: Options,
}

macro_rules! passed_on {
    ($($with:ident: $type:ty),* $(,)?) => {
        $(
            pub(crate) fn $with(self, value: $type) -> Self {
                Self { options: self.options.$with(value), ..self }
            }
        )*
    };
}

impl Setup {
    pub(crate) fn within(bounds: Bounds) -> Self {
        Self { bounds, ..Self::default() }
    }

    pub(crate) fn paper(bounds: Bounds) -> Self {
        Self { options: Options::paper(), ..Self::within(bounds) }
    }

    passed_on! {
        with_method: Method,
        with_order: usize,
        with_selection: Selection,
        with_reduction: Reduction,
        with_whole_box: bool,
        with_reject_outliers: bool,
        with_model_errors: ModelErrors,
        with_everywhere: bool,
    }
}

/// A single unknown, measured over a band.
#[derive(Clone, Copy)]
pub(crate) struct Band<'a> {
    pub(crate) model: &'a DynamicStiffness,
    pub(crate) experiment: &'a Experiment,
    pub(crate) parameter: &'a Parameter,
    pub(crate) frequency_hz: &'a [f64],
    pub(crate) measured: &'a [Vec<c64>],
    pub(crate) noise: Noise<'a>,
}

impl Band<'_> {
    /// The parameter as an unknown.
    pub(crate) fn unknown(&self, varies: Variation, setup: &Setup) -> Unknown {
        Unknown { varies, real: setup.real, bounds: setup.bounds, ..Unknown::of_parameter(self.parameter) }
    }

    pub(crate) fn frfs(&self) -> Frfs<'_> {
        Frfs { frequency_hz: self.frequency_hz, receptance: self.measured, noise: self.noise }
    }

    /// Identifies the parameter as it varies.
    pub(crate) fn identify(
        &self,
        varies: Variation,
        channels: &[ChannelUnknowns],
        setup: &Setup,
        context: Context<'_>,
    ) -> Identification {
        let unknowns = [self.unknown(varies, setup)];
        let problem = Problem::new(self.model, self.experiment, &unknowns, channels, self.frfs()).unwrap();
        identify(&problem, &setup.options, context).unwrap()
    }
}

/// A real unknown that holds for the band.
pub(crate) fn constant(name: &str, dependence: Dependence, nominal: f64, bounds: [f64; 2]) -> Unknown {
    Unknown {
        name: name.into(),
        dependence,
        nominal: Law::Constant(c(nominal, 0.0)),
        varies: Variation::Constant,
        real: true,
        bounds: Bounds { storage: Some(bounds), loss_factor: None },
    }
}
