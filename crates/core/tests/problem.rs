//! What is wrong with a problem is said before it is solved, with its place.

use crate::common;
use crate::tier::of_tier;

use common::{bar, c, plate, term};
use frfit::c64;
use frfit::diagnostics::{Fault, NotJudged, diagnose};
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    ChannelUnknowns, Context, Dependence, Frfs, Method, Noise, Options, Problem, Selection, Status, Unknown,
    Variation, identify,
};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;

/// A problem in parts, to be broken one at a time.
struct Parts {
    model: DynamicStiffness,
    experiment: Experiment,
    unknowns: Vec<Unknown>,
    channels: Vec<ChannelUnknowns>,
    frequency_hz: Vec<f64>,
    receptance: Vec<Vec<c64>>,
    std: Vec<Vec<f64>>,
}

impl Parts {
    fn new() -> Self {
        let case = plate(6, 0.4, 1e-2);
        let unknown = Unknown::factor_of(&case.model, &["stiffness"]).unwrap();
        let frequency_hz = linear_hz(100.0, 1000.0, 4);
        let receptance: Vec<Vec<c64>> =
            frequency_hz.iter().map(|&f| case.direct(f, c(0.0, 0.0)).unwrap()).collect();
        let std = receptance.iter().map(|row| row.iter().map(|u| 1e-4 * u.norm()).collect()).collect();
        let (model, experiment) = (case.model, case.experiment);
        Self {
            model,
            experiment,
            unknowns: vec![unknown],
            channels: Vec::new(),
            frequency_hz,
            receptance,
            std,
        }
    }

    fn problem(&self) -> Result<Problem<'_>, String> {
        let (frequency_hz, receptance) = (&self.frequency_hz, &self.receptance);
        let frfs = Frfs { frequency_hz, receptance, noise: Noise::Known(&self.std) };
        Problem::new(&self.model, &self.experiment, &self.unknowns, &self.channels, frfs)
            .map_err(|error| error.to_string())
    }

    fn identify(&self, options: &Options) -> Result<Vec<Status>, String> {
        let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
        let found = identify(&self.problem()?, options, context).map_err(|error| error.to_string())?;
        Ok(found.lines.iter().map(|line| line.status).collect())
    }
}

#[test]
fn a_right_problem_is_solved() {
    assert_eq!(Parts::new().identify(&Options::default()), Ok(vec![Status::Ok; 4]));
}

#[test]
fn faults_are_refused_with_their_place() {
    type Break = fn(&mut Parts);
    let cases: [(Break, &str); 28] = [
        (
            |p| p.model = p.model.clone().with_decay_per_s(-6.0),
            "decay_per_s of the model: expected a finite number of 1/s that is not negative: that of a window e^(-decay t), found -6",
        ),
        (|p| p.model = p.model.clone().with_decay_per_s(f64::NAN), "decay_per_s of the model: expected "),
        (|p| p.experiment.load.truncate(5), "load: expected "),
        (
            |p| p.experiment.load.fill(c(0.0, 0.0)),
            "load: expected at least one entry that is not zero, found none",
        ),
        (|p| p.experiment.load[3] = c(f64::NAN, 0.0), "load at row 3: expected a finite number, found NaN"),
        (|p| p.experiment.sensors.clear(), "sensors: expected at least one, found 0"),
        (
            |p| p.experiment.sensors[1] = Sensor { row: 10_000, sign: 1.0 },
            "row of sensor 1: expected a row of the model, found 10000",
        ),
        (|p| p.frequency_hz.clear(), "frequencies: expected at least one, found 0"),
        (
            |p| p.frequency_hz[1] = -1.0,
            "frequency 1: expected a finite number of Hz that is not negative, found -1",
        ),
        (|p| p.frequency_hz[2] = 400.0, "frequency 2: expected ascending frequencies, found 400 after 400"),
        (|p| drop(p.receptance.pop()), "FRF: expected 4 rows, one for each frequency, found 3"),
        (|p| p.receptance[2].truncate(1), "FRF at 700 Hz: expected 2 values, one for each sensor, found 1"),
        (
            |p| p.receptance[1][0] = c(f64::INFINITY, 0.0),
            "FRF of sensor 0 at 400 Hz: expected a finite number, found inf",
        ),
        (|p| drop(p.std.pop()), "standard deviation: expected 4 rows, one for each frequency, found 3"),
        (
            |p| p.std[0][1] = -1.0,
            "standard deviation of sensor 1 at 100 Hz: expected a number that is not negative, found -1",
        ),
        (|p| p.unknowns.clear(), "unknowns: expected at least one, found 0"),
        (
            |p| p.unknowns[0].dependence = Dependence::Factor(vec![]),
            "unknown \"stiffness\": expected at least one matrix that it enters, found none",
        ),
        (
            |p| p.unknowns[0].dependence = Dependence::Factor(vec![7]),
            "unknown \"stiffness\": expected matrices of the model, found matrix 7",
        ),
        (
            |p| p.unknowns[0].dependence = Dependence::Powers(vec![(0, 0)]),
            "unknown \"stiffness\": expected powers from -12 to 12 that are not zero, found 0",
        ),
        (
            |p| p.unknowns.push(p.unknowns[0].clone()),
            "unknown \"stiffness\": expected a name of its own, found another unknown of this name",
        ),
        (
            |p| p.unknowns.push(Unknown { name: "again".into(), ..p.unknowns[0].clone() }),
            "unknown \"again\": expected a factor of its own, found \"stiffness\", which is the factor of \"stiffness\" too",
        ),
        (
            |p| p.unknowns[0].bounds = Bounds { storage: Some([2.0, 1.0]), loss_factor: None },
            "unknown \"stiffness\": expected bounds.storage as [low, high] with low <= high, found [2, 1]",
        ),
        (
            |p| p.unknowns[0].varies = Variation::Law(vec![]),
            "unknown \"stiffness\": expected at least one law, found none",
        ),
        (
            |p| (p.unknowns[0].varies, p.unknowns[0].real) = (Variation::law(LawKind::Constant), true),
            "unknown \"stiffness\": expected a complex law, found a real unknown",
        ),
        (
            |p| p.unknowns[0].nominal = Law::Constant(c(f64::NAN, 0.0)),
            "unknown \"stiffness\": expected a finite nominal value, found NaN+0i at 100 Hz",
        ),
        (
            |p| p.channels = vec![ChannelUnknowns { scale: true, delay: false }],
            "channels: expected 2, one for each sensor, or none, found 1",
        ),
        (
            |p| p.channels = vec![ChannelUnknowns { scale: true, delay: false }; 2],
            "a channel of unknown scale or delay: a free value at each frequency explains every scale",
        ),
        (
            |p| {
                p.channels = vec![ChannelUnknowns::default(), ChannelUnknowns { scale: true, delay: false }];
                p.unknowns[0].varies = Variation::Smooth;
            },
            "a channel of unknown scale or delay: expected a law or a value at each frequency, found a smooth factor",
        ),
    ];
    for (broken, expected) in cases {
        let mut parts = Parts::new();
        broken(&mut parts);
        let error = parts.problem().map(|_| ()).unwrap_err();
        assert!(error.starts_with(expected), "{error}\nfor {expected}");
    }
}

#[test]
fn options_that_do_not_belong_to_a_problem_are_refused() {
    let mut parts = Parts::new();
    let wrong = Options::default().with_order(0);
    assert_eq!(parts.identify(&wrong).unwrap_err(), "order: expected 1 to 200, found 0");
    parts.unknowns[0].varies = Variation::law(LawKind::Constant);
    for options in [Options::paper(), Options::default().with_selection(Selection::Smallest)] {
        let error = parts.identify(&options).unwrap_err();
        assert!(error.starts_with("method and selection: expected \"rational\" and \"joint\""), "{error}");
    }
    parts.unknowns[0].varies = Variation::PerFrequency;
    let paper = Options::default().with_method(Method::Series).with_selection(Selection::Smallest);
    assert_eq!(parts.identify(&paper).unwrap().len(), 4);
}

#[test]
fn more_unknown_than_measured_is_refused() {
    let mut parts = Parts::new();
    parts.experiment.sensors.truncate(1);
    parts.receptance.iter_mut().for_each(|row| row.truncate(1));
    parts.std.iter_mut().for_each(|row| row.truncate(1));
    let mass = Unknown::factor_of(&parts.model, &[parts.model.terms()[1].name.as_str()]).unwrap();
    parts.unknowns.push(mass);
    let expected = "expected at least 16 measured real numbers for as many unknown ones, found 8";
    assert_eq!(parts.problem().map(|_| ()).unwrap_err(), expected);
}

/// The data of several unknowns are judged as those of one: a sign, a unit and a conjugate are found beside a density and a
/// length that are a little off.
#[test]
fn several_unknowns_are_diagnosed() {
    let case = bar(40);
    let terms = case.model.terms();
    let modulus = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
    let model = DynamicStiffness::new(vec![
        frfit::model::Term { factor: modulus.clone(), ..terms[0].clone() },
        term("mass", Role::Mass, terms[1].matrix.clone(), c(910.0, 0.0)),
    ])
    .unwrap();
    let unknowns = [
        Unknown::factor_of(&model, &[model.terms()[0].name.as_str()]).unwrap(),
        Unknown { varies: Variation::Constant, real: true, ..Unknown::factor_of(&model, &["mass"]).unwrap() },
        Unknown {
            name: "length".into(),
            dependence: Dependence::Powers(vec![(0, -1), (1, 1)]),
            nominal: Law::Constant(c(1.0, 0.0)),
            varies: Variation::Constant,
            real: true,
            bounds: Bounds::default(),
        },
    ];
    let truth = DynamicStiffness::new(vec![
        frfit::model::Term { factor: modulus.scaled(1.15), ..model.terms()[0].clone() },
        frfit::model::Term { factor: Law::Constant(c(930.0, 0.0)), ..model.terms()[1].clone() },
    ])
    .unwrap();
    let frequency_hz = linear_hz(100.0, 1000.0, of_tier(36, 60));
    let exact: Vec<Vec<c64>> = frequency_hz
        .iter()
        .map(|&f| {
            let factor = truth.analysis().factor(&truth.at(f, &[]).unwrap().assemble(&[])).unwrap();
            let mut x = case.experiment.load.clone();
            factor.solve(&mut x).unwrap();
            case.experiment.observe(&x)
        })
        .collect();
    let sensors = case.experiment.sensors.len();
    type Change = fn(c64) -> c64;
    type Is = fn(&Fault) -> bool;
    let faults: [(Change, Option<Is>); 4] = [
        (|u| u, None),
        (|u| -u, Some(|fault| matches!(fault, Fault::Sign))),
        (|u| 9.80665 * u, Some(|fault| matches!(fault, Fault::Factor { .. }))),
        (|u| u.conj(), Some(|fault| matches!(fault, Fault::Conjugated))),
    ];
    for (fault, expected) in faults {
        let receptance: Vec<Vec<c64>> =
            exact.iter().map(|row| row.iter().map(|&u| fault(u)).collect()).collect();
        let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise: Noise::Unknown };
        let problem = Problem::new(&model, &case.experiment, &unknowns, &[], frfs).unwrap();
        let quantities = vec![Quantity::Receptance; sensors];
        let found = diagnose(&problem, &quantities, &Options::default(), &sequential).unwrap();
        assert_eq!(found.not_judged, None::<NotJudged>);
        match (found.findings.as_slice(), expected) {
            ([], None) => {}
            ([finding], Some(is)) => assert!(is(&finding.fault), "{found:?}"),
            _ => panic!("{found:?}"),
        }
        let error = diagnose(&problem, &[], &Options::default(), &sequential).unwrap_err().to_string();
        assert_eq!(error, format!("quantities: expected {sensors}, one for each sensor, found 0"));
    }
}
