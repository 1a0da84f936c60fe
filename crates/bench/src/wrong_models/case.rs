//! A case: a structure, how its model is wrong, what was measured, and where the search begins.

use super::Failure;
use super::dice::Dice;
use super::fault::{Change, Class, Unknowns};
use super::natural::{Mode, errors, median, modes, size};
use super::realised::{Realised, UNKNOWN};
use super::structure::{Kind, Structure};
use super::way::Way;
use cpu_time::ThreadTime;
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    CoarserMesh, Context, Frfs, Identification, Noise, Options, Problem, Unknown, Variation, identify,
};
use frfit::laws::LawKind;
use frfit::material::{Law, loss_factor};
use frfit::model::{DynamicStiffness, Experiment, Sensor};

/// A case, measured.
#[derive(Debug)]
pub struct Case {
    /// Its number.
    pub index: u64,
    /// How the model is wrong.
    pub class: Class,
    /// Of what.
    pub kind: Kind,
    /// The model, its unknown factor at the nominal value.
    pub model: DynamicStiffness,
    /// Load and sensors on the model.
    pub experiment: Experiment,
    /// The same on a coarser mesh, of two meshes.
    pub coarser: Option<CoarserMesh>,
    /// The true law of the unknown factor, of several the first.
    pub truth: Law,
    /// What is unknown: the names of the terms, and their true factors.
    pub unknowns: Vec<(String, Law)>,
    /// Nominal over true factor.
    pub ratio: f64,
    /// Frequencies of the lines.
    pub frequency_hz: Vec<f64>,
    /// Receptance with noise, `[frequency][sensor]`.
    pub measured: Vec<Vec<c64>>,
    /// Standard deviations of the noise, `[frequency][sensor]`.
    pub std: Vec<Vec<f64>>,
    /// Noise over response.
    pub noise: f64,
    /// Whether the standard deviations are given to the identification.
    pub noise_known: bool,
    /// Elastic modes of the model in the band.
    pub modes: usize,
    /// Median of |f/f₀ − 1| of these modes, f₀ of the truth; `None` where the truth has none of them.
    pub frequency_error: Option<f64>,
    /// The natural frequency of each of these modes that the truth has too, and f/f₀ − 1.
    pub frequency_errors: Vec<[f64; 2]>,
    /// Rows of the true model.
    pub truth_rows: usize,
}

/// Which meshes the user of a model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meshes {
    /// The one that is drawn.
    One,
    /// One with elements of half the size.
    Finer,
    /// That one, and the one that is drawn beside it.
    Two,
}

/// What a user has.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// His meshes.
    pub meshes: Meshes,
    /// By which factor his nominal value is off at most, to either side; `None` where it is 0.6 to 1.4 times the true one.
    pub nominal_within: Option<f64>,
    /// How many faults a case has.
    pub faults: Faults,
}

/// How many faults a case has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Faults {
    /// That of its class.
    One,
    /// That of its class, and smaller ones of all kinds beside it: of what is known beside the unknown, all mass, a mass at a sensor, and calibrations.
    All,
}

impl Setting {
    /// A single mesh, a nominal value that is nearly right, and one fault.
    pub const USUAL: Self = Self { meshes: Meshes::One, nominal_within: None, faults: Faults::One };
}

/// Nominal over true factor.
const NOMINAL_RATIO: [f64; 2] = [0.6, 1.4];

/// Elements of the model for one of the coarser mesh, along each side.
const FINER: usize = 2;

/// Rows of the true model at most.
const TRUTH_ROWS: usize = 8_000;

/// Median errors of natural frequencies that make a wrong model: below nothing is wrong, above anyone sees it.
const WRONG: [f64; 2] = [1e-3, 2e-2];

/// Modes in the band at least.
const FEWEST: usize = 3;

/// Modes of a model that are searched beyond those of the band: the six of a rigid body, and one above the band.
const BEYOND: usize = 7;

/// The truth may have modes that the model has not: those of bricks in the plane, and of a beam of bricks to the side and about its axis.
const OTHERS: usize = 14;

/// Attempts to make a model as wrong as [`WRONG`] asks.
const ATTEMPTS: usize = 10;

impl Case {
    /// Draws a case of a seed, and measures it by direct solves of the true model at every line.
    ///
    /// With two meshes the model has elements of half the size, and what would be the model is the coarser one beside it; the truth is the same,
    /// or as fine as the model where it was as coarse.
    ///
    /// # Errors
    /// Where a model cannot be made or solved: a fault of this benchmark.
    pub fn draw(seed: u64, index: u64, setting: Setting, unknowns: Unknowns) -> Result<Self, Failure> {
        let Setting { meshes, nominal_within, faults } = setting;
        let class = Class::of(index);
        let mut dice = Dice::new(seed, index);
        let kind = class.kind_of(index, unknowns).ok_or("nothing that is known can be wrong")?;
        let mut structure = Structure::draw(kind, class == Class::OtherElement, &mut dice);
        let mut modes = Range { first: dice.pick(&[0, 0, 1, 2]), count: dice.count(FEWEST, 12) };
        // Springs to the ground are felt by the lowest modes.
        let is_sprung = class == Class::Neighbour && kind == Kind::SprungBeam;
        if is_sprung || (class == Class::SupportSpring && !structure.is_clamped()) {
            modes = Range { first: 0, count: FEWEST + modes.count / 3 };
        }
        let mut change = Change::default();
        match class {
            Class::CoarseMesh => change = coarsen(&mut structure, &mut modes, &mut dice)?,
            Class::SupportSpring if structure.is_clamped() => {
                change.clamp = Some(give(&structure, modes, &mut dice)?);
            }
            Class::OtherElement => change = thicken(&mut structure, &mut modes, &mut dice)?,
            Class::Neighbour => change.known = dice.off_by(0.005, 0.03),
            Class::Mass => change.mass = dice.off_by(0.005, 0.03),
            _ => {}
        }
        let about = Self::band(&structure, modes, &mut dice)?;
        let truth = structure.draw_law(about.middle_hz, &mut dice);
        let ratio = match nominal_within {
            Some(factor) => dice.log_between(1.0 / factor, factor),
            None => dice.between(NOMINAL_RATIO[0], NOMINAL_RATIO[1]),
        };
        let [driven, sensors @ ..] = about.draw_positions(&mut dice);
        let sensors: Vec<[f64; 3]> = sensors.into_iter().flatten().collect();
        let driven = driven.ok_or("no node moves")?;
        match class {
            Class::PointMass => {
                change.masses.push((dice.pick(&sensors), dice.between(0.002, 0.01) * structure.mass()));
            }
            Class::SupportSpring if !structure.is_clamped() => {
                let omega = std::f64::consts::TAU * about.first_hz * dice.log_between(0.1, 0.3);
                let stiffness =
                    0.5 * structure.mass() * omega * omega * c64::new(1.0, dice.between(0.02, 0.3));
                change.suspension = (0..2).map(|_| (dice.pick(&about.stations), stiffness)).collect();
            }
            _ => {}
        }
        let mut others = (faults == Faults::All).then(|| Dice::new(!seed, index));
        if let Some(others) = &mut others {
            if unknowns == Unknowns::One {
                change.known *= others.off_by(0.002, 0.015);
            }
            change.mass *= others.off_by(0.002, 0.015);
            change.masses.push((others.pick(&sensors), others.between(0.001, 0.005) * structure.mass()));
        }
        let start = truth.scaled(ratio);
        // What else is unknown does not begin at the truth either.
        let (mut begun, mut unchanged) = (structure.clone(), Change::default());
        if unknowns == Unknowns::Several {
            begun.orthotropy.iter_mut().for_each(|over| *over *= dice.between(0.8, 1.25));
            unchanged.known = dice.between(0.7, 1.3);
        }
        let coarse = || Realised::new(&begun, &start, &unchanged);
        let nominal = match meshes {
            Meshes::One => coarse()?,
            Meshes::Finer | Meshes::Two => {
                change.plan = change.plan.max(FINER);
                let layers = if structure.kind == Kind::Sandwich { FINER } else { 1 };
                change.layers = change.layers.max(layers);
                Realised::new(&begun, &start, &Change { plan: FINER, layers, ..unchanged.clone() })?
            }
        };
        let real = Realised::new(&structure, &truth, &change)?;
        let in_band = errors(&about.modes, &about.of_truth(&real, modes)?);
        let experiment = |of: &Realised| {
            let row = |&station: &[f64; 3]| Ok(Sensor { row: of.row(station)?, sign: 1.0 });
            let sensors = sensors.iter().map(row).collect::<Result<Vec<_>, Failure>>()?;
            Ok::<_, Failure>(Experiment::driven_at(of.model.dim(), row(&driven)?, sensors))
        };
        let coarser = match meshes {
            Meshes::One | Meshes::Finer => None,
            Meshes::Two => {
                let coarse = coarse()?;
                let experiment = experiment(&coarse)?;
                let (element_ratio, order) = (FINER as f64, CoarserMesh::ORDER);
                Some(CoarserMesh { model: coarse.model, experiment, element_ratio, order })
            }
        };
        let frequency_hz = about.lines;
        let mut exact = solve(&real.model, &experiment(&real)?, &frequency_hz)?;
        let mut calibrate = |dice: &mut Dice, of_force: [f64; 2], of_sensors: [f64; 2]| {
            let of_force = dice.off_by(of_force[0], of_force[1]);
            let gain = |_: &[f64; 3]| of_force * dice.off_by(of_sensors[0], of_sensors[1]);
            let gains: Vec<f64> = sensors.iter().map(gain).collect();
            exact.iter_mut().flat_map(|row| row.iter_mut().zip(&gains)).for_each(|(u, gain)| *u *= gain);
        };
        if class == Class::Calibration {
            calibrate(&mut dice, [0.005, 0.03], [0.002, 0.02]);
        }
        if let Some(others) = &mut others {
            calibrate(others, [0.002, 0.015], [0.001, 0.01]);
        }
        let (noise, noise_known) = (dice.log_between(1e-3, 3e-2), dice.coin());
        let mut dice = dice.fork();
        let mut drawn = |u: &c64| u + noise * u.norm() * dice.circular();
        Ok(Self {
            index,
            class,
            kind,
            experiment: experiment(&nominal)?,
            model: nominal.model,
            coarser,
            truth,
            unknowns: real.unknowns(unknowns),
            ratio,
            measured: exact.iter().map(|row| row.iter().map(&mut drawn).collect()).collect(),
            std: exact.iter().map(|row| row.iter().map(|u| noise * u.norm()).collect()).collect(),
            frequency_hz,
            noise,
            noise_known,
            modes: modes.count,
            frequency_error: size(&in_band),
            frequency_errors: in_band,
            truth_rows: real.model.dim(),
        })
    }

    /// Identifies it on this thread: what came out, and CPU seconds.
    ///
    /// # Errors
    /// [`frfit::identify::ProblemError`]: a fault of this benchmark.
    pub fn identify(&self, way: Way, options: &Options) -> Result<(Identification, f64), Failure> {
        let kind = match self.truth {
            Law::Constant(_) => LawKind::Constant,
            _ => LawKind::FractionalZener,
        };
        let varies = match way {
            Way::PerFrequency => Variation::PerFrequency,
            Way::Smooth => Variation::Smooth,
            Way::Law => Variation::law(kind),
            Way::Several if self.kind == Kind::Sandwich => Variation::PerFrequency,
            Way::SeveralSmooth if self.kind == Kind::Sandwich => Variation::Smooth,
            Way::Several | Way::SeveralSmooth => Variation::law(LawKind::Constant),
        };
        let unknown = |(name, _): &(String, Law)| {
            let varies = if name == UNKNOWN { varies.clone() } else { Variation::law(LawKind::Constant) };
            Ok(Unknown { varies, ..Unknown::factor_of(&self.model, &[name])? })
        };
        let unknowns = self.unknowns.iter().map(unknown).collect::<Result<Vec<_>, Failure>>()?;
        let noise = if self.noise_known { Noise::Known(&self.std) } else { Noise::Unknown };
        let frfs = Frfs { frequency_hz: &self.frequency_hz, receptance: &self.measured, noise };
        let mut problem = Problem::new(&self.model, &self.experiment, &unknowns, &[], frfs)?;
        if let Some(coarser) = &self.coarser {
            problem = problem.with_coarser_mesh(coarser)?;
        }
        let start = ThreadTime::now();
        let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
        let found = identify(&problem, options, context)?;
        Ok((found, start.elapsed().as_secs_f64()))
    }

    /// The true loss factor in the middle of the band.
    pub fn middle_loss(&self) -> f64 {
        let middle = self.frequency_hz[self.frequency_hz.len() / 2];
        self.truth.at(middle).map_or(f64::NAN, loss_factor)
    }

    /// Lowest and highest frequency of the band, and where its geometric middle is: the law has its storage modulus there.
    fn band(structure: &Structure, wanted: Range, dice: &mut Dice) -> Result<About, Failure> {
        let at_storage = Law::complex_modulus(structure.storage, 0.0);
        let model = Realised::new(structure, &at_storage, &Change::default())?;
        let stations = model.stations();
        let modes = modes(&model, &stations, 1.0, wanted.first + wanted.count + BEYOND)?;
        let hz = |k: usize| modes.get(k).map(|mode| mode.hz).ok_or("too few modes");
        let last = wanted.first + wanted.count - 1;
        let below = match wanted.first {
            0 => dice.between(0.5, 0.9) * hz(0)?,
            first => dice.between(hz(first - 1)?, hz(first)?),
        };
        let above = dice.between(hz(last)?, hz(last + 1)?);
        let lines = linear_hz(below, above, dice.count(150, 300));
        let first_hz = hz(0)?;
        let modes = modes[wanted.first..=last].to_vec();
        Ok(About { stations, modes, first_hz, middle_hz: (below * above).sqrt(), lines })
    }
}

/// Which elastic modes are in the band.
#[derive(Debug, Clone, Copy)]
struct Range {
    first: usize,
    count: usize,
}

/// The model without its losses.
struct About {
    stations: Vec<[f64; 3]>,
    modes: Vec<Mode>,
    first_hz: f64,
    middle_hz: f64,
    lines: Vec<f64>,
}

/// Sensors at most.
const SENSORS: usize = 5;

impl About {
    /// A load, and 1 to 5 sensors at different places.
    fn draw_positions(&self, dice: &mut Dice) -> [Option<[f64; 3]>; 1 + SENSORS] {
        let mut drawn = [None; 1 + SENSORS];
        drawn[0] = Some(dice.pick(&self.stations));
        let mut left: Vec<usize> = (0..self.stations.len()).collect();
        for sensor in drawn[1..].iter_mut().take(dice.count(1, SENSORS).min(left.len())) {
            *sensor = Some(self.stations[left.swap_remove(dice.below(left.len()))]);
        }
        drawn
    }

    /// Modes of the truth at this model's storage modulus.
    fn of_truth(&self, truth: &Realised, wanted: Range) -> Result<Vec<Mode>, Failure> {
        modes(truth, &self.stations, self.middle_hz, wanted.first + wanted.count + BEYOND + OTHERS)
    }
}

/// Errors of the natural frequencies in the band of a structure's model, something being different in truth; none where the mesh has not so many modes.
fn all_errors(structure: &Structure, change: &Change, wanted: Range) -> Result<Vec<[f64; 2]>, Failure> {
    let at_storage = Law::complex_modulus(structure.storage, 0.0);
    let model = Realised::new(structure, &at_storage, &Change::default())?;
    let truth = Realised::new(structure, &at_storage, change)?;
    let stations = model.stations();
    let count = wanted.first + wanted.count + BEYOND;
    let own = modes(&model, &stations, 1.0, count)?;
    let of_truth = modes(&truth, &stations, 1.0, count + OTHERS)?;
    let Some(own) = own.get(wanted.first..wanted.first + wanted.count) else {
        return Ok(Vec::new());
    };
    Ok(errors(own, &of_truth))
}

/// Their median size.
fn wrong_by(structure: &Structure, change: &Change, wanted: Range) -> Result<Option<f64>, Failure> {
    Ok(size(&all_errors(structure, change, wanted)?))
}

/// Elements along x of the finest mesh of each kind of structure that is tried, and of the coarsest: up to 1500 rows.
const FINEST: [usize; 5] = [20, 30, 40, 30, 12];
const COARSEST: [usize; 5] = [6, 6, 6, 6, 3];

/// Takes the finest of ever coarser meshes that is as wrong as was drawn, and a truth of two to four times as many elements. Where the finest of
/// them is too wrong, there are fewer modes in the band.
fn coarsen(structure: &mut Structure, wanted: &mut Range, dice: &mut Dice) -> Result<Change, Failure> {
    let aim = dice.log_between(1.5 * WRONG[0], 0.75 * WRONG[1]);
    let finer = dice.count(2, 4);
    let layers = dice.count(1, 2);
    let mut taken = None;
    let mut elements = FINEST[structure.kind as usize];
    while elements >= COARSEST[structure.kind as usize] {
        let mut coarse = structure.clone();
        coarse.set_mesh(elements);
        let mut change = Change { plan: finer, layers, ..Change::default() };
        while rows(&coarse, &change) > TRUTH_ROWS {
            (change.plan, change.layers) =
                if change.layers > 1 { (change.plan, 1) } else { (change.plan - 1, 1) };
        }
        let Some(error) = wrong_by(&coarse, &change, *wanted)? else { break };
        if error > WRONG[1] {
            if taken.is_some() {
                break;
            } else if wanted.count > FEWEST {
                wanted.count -= 1;
                continue;
            }
        }
        taken = Some((coarse, change));
        if error >= aim {
            break;
        }
        elements = ((elements as f64 * 0.88) as usize).min(elements - 1);
    }
    let (coarse, change) = taken.ok_or("no mesh has so many modes")?;
    *structure = coarse;
    Ok(change)
}

/// About so many rows a finer mesh has.
fn rows(structure: &Structure, change: &Change) -> usize {
    let [along, across] = structure.mesh.map(|elements| elements * change.plan + 1);
    match structure.kind {
        Kind::Sandwich => 3 * along * across * (3 * change.layers + 1),
        Kind::Plate if change.bricks => 9 * along * across,
        Kind::Plate => 3 * along * across,
        Kind::OrthotropicPlate => 4 * along * across,
        Kind::Beam | Kind::SprungBeam if change.bricks => 27 * along,
        Kind::Beam | Kind::SprungBeam => 2 * along,
    }
}

/// How stiff a clamp is that is as wrong as asked.
fn give(structure: &Structure, wanted: Range, dice: &mut Dice) -> Result<f64, Failure> {
    let mut stiff = dice.log_between(100.0, 3000.0);
    for _ in 0..ATTEMPTS {
        let change = Change { clamp: Some(stiff), ..Change::default() };
        match wrong_by(structure, &change, wanted)? {
            Some(error) if error < WRONG[0] => stiff /= 2.0,
            Some(error) if error <= WRONG[1] => break,
            _ => stiff *= 2.0,
        }
    }
    Ok(stiff)
}

/// Bricks in place of a plate or a beam, as different as asked: first so many of them, then another thickness and fewer modes. Thick structures have shear,
/// which the model has not; thin bricks are too stiff.
fn thicken(structure: &mut Structure, wanted: &mut Range, dice: &mut Dice) -> Result<Change, Failure> {
    let mut change = Change { plan: dice.count(2, 3), bricks: true, ..Change::default() };
    while rows(structure, &change) > TRUTH_ROWS {
        change.plan -= 1;
    }
    for _ in 0..ATTEMPTS {
        let errors = all_errors(structure, &change, *wanted)?;
        let finer = Change { plan: change.plan + 1, ..change.clone() };
        let by = match size(&errors) {
            Some(error) if error < WRONG[0] => THICKER,
            Some(error) if error <= WRONG[1] => break,
            _ if rows(structure, &finer) <= TRUTH_ROWS && finer.plan <= MAX_PLAN_REFINEMENT => {
                change = finer;
                continue;
            }
            _ => {
                wanted.count = FEWEST.max(wanted.count - 1);
                let is_shear =
                    median(errors.iter().map(|[_, error]| *error).collect()).is_some_and(|error| error > 0.0);
                if is_shear { 1.0 / THICKER } else { THICKER }
            }
        };
        structure.layers.iter_mut().for_each(|layer| *layer *= by);
    }
    Ok(change)
}

/// A step of the thickness.
const THICKER: f64 = 1.2;

/// Elements in plan for one of the model, at most.
const MAX_PLAN_REFINEMENT: usize = 4;

/// Receptances by a direct solve at each line.
pub(crate) fn solve(
    model: &DynamicStiffness,
    experiment: &Experiment,
    frequency_hz: &[f64],
) -> Result<Vec<Vec<c64>>, Failure> {
    let at = |&f: &f64| {
        let factor = model.analysis().factor(&model.at(f, &[])?.assemble(&[]))?;
        let mut x = experiment.load.clone();
        factor.solve(&mut x)?;
        Ok(experiment.observe(&x))
    };
    frequency_hz.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wrong_models::score::{Part, judged};
    use frfit::identify::{Explained, Line, Status};

    /// The first case of a class on beams alone: those take the least time.
    fn small(class: usize) -> Case {
        let classes = Class::ALL.len() as u64;
        let mut indices = (0..).map(|k| k * classes + class as u64);
        let is_beam = |index: &u64| {
            matches!(Class::of(*index).kind_of(*index, Unknowns::One), Some(Kind::Beam | Kind::SprungBeam))
        };
        let index = indices.find(is_beam).unwrap();
        Case::draw(1, index, Setting::USUAL, Unknowns::One).unwrap()
    }

    /// A support that gives a little (natural frequencies 0.02 % off): a smooth modulus and a right model explain the band, a constant modulus and a right model do not.
    /// The errors are searched with the law then, and its error bars hold them.
    #[test]
    fn errors_that_a_smooth_modulus_hides_are_found_with_the_law() {
        let case = Case::draw(801, 37, Setting::USUAL, Unknowns::One).unwrap();
        let (smooth, _) = case.identify(Way::Smooth, &Options::default()).unwrap();
        assert!(smooth.model_errors.is_none() && smooth.fit.unwrap().verdict == Explained::Yes);
        let (found, _) = case.identify(Way::Law, &Options::default()).unwrap();
        assert!(found.model_errors.is_some() && found.fit.unwrap().verdict == Explained::Yes);
        let Law::Constant(truth) = case.truth else { panic!("{:?}", case.truth) };
        for line in &found.lines {
            let one = &line.values[0];
            assert_eq!(line.status, Status::Ok);
            let off = one.storage().unwrap() / truth.re - 1.0;
            let bar = one.uncertainty.unwrap().storage_std / truth.re;
            assert!(off.abs() < 2.0 * bar && bar < 0.04, "{off} {bar}");
        }
    }

    /// A beam with a loss factor of one, measured on bricks: its elements lack shear, and natural frequencies are 3 % too high at the end of the band. A smooth modulus takes
    /// the trend of the mesh, with a loss factor that is up to 13 % off. What shifts natural frequencies may change the damping by as much: the error bar holds it.
    #[test]
    fn the_loss_factor_holds_a_trend_of_the_mesh() {
        let case = Case::draw(805, 230, Setting::USUAL, Unknowns::One).unwrap();
        let (found, _) = case.identify(Way::Smooth, &Options::default()).unwrap();
        let Law::Constant(truth) = case.truth else { panic!("{:?}", case.truth) };
        let truth = loss_factor(truth);
        let ok: Vec<_> = found.lines.iter().filter(|line| line.status == Status::Ok).collect();
        assert!(ok.len() > 170);
        let deviations = |line: &&Line| -> f64 {
            let one = &line.values[0];
            let off = one.loss_factor().unwrap() / truth - 1.0;
            let bar = one.uncertainty.unwrap().loss_factor_std.unwrap() / truth;
            assert!(bar < 0.15, "{}: {off} {bar}", line.frequency_hz);
            off.abs() / bar
        };
        let off: Vec<f64> = ok.iter().map(deviations).collect();
        let within = off.iter().filter(|off| **off < 2.0).count();
        assert!(10 * within >= 9 * off.len() && off.iter().all(|off| *off < 2.5), "{off:?}");
    }

    /// A lightly damped sprung beam that was measured on bricks, with one sensor: its modulus was 26 to 34 % too large, and all natural frequencies of the model 10 % lower than
    /// those of the structure. Both together are hardly seen, and either alone is improbable.
    #[test]
    fn what_all_modes_have_in_common_is_the_modulus() {
        let case = Case::draw(1605, 46, Setting::USUAL, Unknowns::One).unwrap();
        let (found, _) = case.identify(Way::Smooth, &Options::default()).unwrap();
        let ok: Vec<_> = judged(&case, &found).unwrap();
        let ok: Vec<_> = ok.iter().filter(|line| line.status == Status::Ok).collect();
        assert!(ok.len() > 160);
        let storage =
            |of: &dyn Fn(&Part) -> f64| ok.iter().map(|line| of(&line.parts[0])).fold(0.0, f64::max);
        let farthest = storage(&|part| part.deviations().unwrap());
        let widest = storage(&|part| part.bar.unwrap() / part.truth);
        assert!(farthest < 2.5 && widest < 0.06, "{farthest} {widest}");
    }

    #[test]
    fn a_case_is_the_same_each_time() {
        let (once, again) = (small(0), small(0));
        assert_eq!((once.measured, once.truth), (again.measured, again.truth));
    }

    #[test]
    fn a_right_model_is_right_and_the_others_are_not() {
        for (class, name) in Class::ALL.iter().enumerate() {
            let case = small(class);
            assert_eq!((case.class, case.modes < 13), (*name, true));
            let error = case.frequency_error.unwrap();
            match name {
                // Eigenvalues of one problem, computed twice: their residual squared, and roundoff.
                Class::Right | Class::Calibration => assert!(error < 1e-9, "{error}"),
                _ => assert!((1e-6..0.05).contains(&error), "{name} {error}"),
            }
        }
    }
}
