//! What came of cases: line by line, and as tables.

use super::plant::Planted;
use crate::table::Table;
use crate::wrong_models::case::Case;
use crate::wrong_models::fault::Class;
use frfit::diagnostics::{Diagnosis, Fault as Found};

/// What a diagnosis is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// All that was planted, and nothing else.
    Found,
    /// Of two faults one, and nothing else.
    Part,
    /// The right explanation among those between which the data do not decide.
    Undecided,
    /// Nothing.
    Nothing,
    /// Something that is not there.
    Wrong,
}

/// A case and what came of it.
#[derive(Debug)]
pub struct Tried {
    index: u64,
    class: Class,
    described: String,
    planted: Vec<Planted>,
    diagnosis: Diagnosis,
    verdict: Verdict,
    seconds: f64,
}

impl Tried {
    pub(super) fn new(
        index: u64,
        case: &Case,
        planted: Vec<Planted>,
        mut diagnosis: Diagnosis,
        seconds: f64,
    ) -> Self {
        diagnosis.findings.retain(|finding| !matches!(finding.fault, Found::Mesh { .. }));
        let described = format!(
            "{} {}, {} modes, {} sensors, noise {:.1e}, loss {:.1e}",
            case.class,
            case.kind,
            case.modes,
            case.experiment.sensors.len(),
            case.noise,
            case.middle_loss()
        );
        let dead = |one: &&Planted| matches!(one.fault, super::Fault::NoSignal);
        let dead: Vec<usize> = planted.iter().filter(dead).flat_map(|one| one.sensors.clone()).collect();
        let mut expected = planted.clone();
        for one in expected.iter_mut().filter(|one| one.fault != super::Fault::NoSignal) {
            one.sensors.retain(|m| !dead.contains(m));
        }
        // What is wrong with a channel without a signal cannot be seen.
        expected.retain(|one| !one.sensors.is_empty());
        // A conjugate of what is late is early: which of both came first cannot be known.
        if expected.iter().any(|one| one.fault == super::Fault::Conjugated) {
            let mirrored = |fault| match fault {
                super::Fault::Delay(seconds) => super::Fault::Delay(-seconds),
                other => other,
            };
            let other: Vec<Planted> =
                expected.iter().map(|one| Planted { fault: mirrored(one.fault), ..one.clone() }).collect();
            if verdict(&other, &diagnosis) == Verdict::Found {
                expected = other;
            }
        }
        let verdict = verdict(&expected, &diagnosis);
        Self { index, class: case.class, described, planted, diagnosis, verdict, seconds }
    }
}

fn verdict(planted: &[Planted], diagnosis: &Diagnosis) -> Verdict {
    let found: Vec<(&Found, &[usize])> =
        diagnosis.findings.iter().map(|finding| (&finding.fault, finding.sensors.as_slice())).collect();
    let is_planted = |(fault, sensors): &(&Found, &[usize])| planted.iter().any(|one| one.is(fault, sensors));
    if !found.iter().all(is_planted) {
        return Verdict::Wrong;
    }
    if found.len() == planted.len() {
        return Verdict::Found;
    }
    let is_all = |faults: &[(Found, Vec<usize>)]| {
        let named = |one: &Planted| {
            faults.iter().any(|(fault, sensors)| one.is(fault, sensors))
                || found.iter().any(|(fault, sensors)| one.is(fault, sensors))
        };
        planted.iter().all(named)
    };
    match diagnosis.others.iter().any(|other| is_all(&other.faults)) {
        true => Verdict::Undecided,
        false if found.is_empty() => Verdict::Nothing,
        false => Verdict::Part,
    }
}

/// What the columns mean.
pub const LEGEND: &str = "\
found: all that was planted and nothing else; part: one of two; undecided: named beside others between which the data do not decide;
nothing: no finding; wrong: a finding of what is not there. Of data without a fault no finding is the right answer.";

/// A line for each.
pub fn described(tried: &Tried) -> String {
    let planted: Vec<String> =
        tried.planted.iter().map(|one| format!("{:?} of {:?}", one.fault, one.sensors)).collect();
    let found: Vec<String> = tried
        .diagnosis
        .findings
        .iter()
        .map(|finding| {
            let evidence = finding.evidence.map_or(String::new(), |e| {
                format!(
                    " [{:.2} to {:.2}, {:.0} nats, margin {:.0}]",
                    e.before,
                    e.after,
                    e.nats,
                    e.margin.unwrap_or(f64::INFINITY)
                )
            });
            format!("{:?} of {:?}{evidence}", finding.fault, finding.sensors)
        })
        .collect();
    let others: Vec<String> = tried
        .diagnosis
        .others
        .iter()
        .map(|other| format!("{:?} ({:.2}, {:.1} behind)", other.faults, other.misfit, other.nats_behind))
        .collect();
    format!(
        "{:>4} {:?} {}\n     planted: {}\n     found:   {}\n     others:  {}\n     misfit {:.2}, {:.1} s",
        tried.index,
        tried.verdict,
        tried.described,
        planted.join("; "),
        found.join("; "),
        others.join("; "),
        tried.diagnosis.misfit.unwrap_or(f64::NAN),
        tried.seconds
    )
}

/// Tables: by number of faults and whether the model is right, then by kind of fault.
pub fn markdown(all: &[Tried]) -> String {
    let heading = ["", "cases", "found", "part", "undecided", "nothing", "wrong"];
    let mut table = Table::new(heading);
    let row = |name: String, of: &[&Tried]| {
        let count = |verdict| of.iter().filter(|one| one.verdict == verdict).count();
        let verdicts = [Verdict::Found, Verdict::Part, Verdict::Undecided, Verdict::Nothing, Verdict::Wrong];
        let counts = verdicts.map(|verdict| count(verdict).to_string());
        [vec![name, of.len().to_string()], counts.to_vec()].concat()
    };
    for faults in 0..3 {
        for (is_right, name) in [(true, "right"), (false, "wrong")] {
            let is_of = |one: &&Tried| one.planted.len() == faults && (one.class == Class::Right) == is_right;
            let of: Vec<&Tried> = all.iter().filter(is_of).collect();
            table.push(row(format!("{faults} faults, {name} model"), &of));
        }
    }
    let mut kinds: Vec<String> =
        all.iter().flat_map(|one| &one.planted).map(|one| one.fault.to_string()).collect();
    kinds.sort();
    kinds.dedup();
    for kind in kinds {
        let is_of = |one: &&Tried| one.planted.iter().any(|planted| planted.fault.to_string() == kind);
        let of: Vec<&Tried> = all.iter().filter(is_of).collect();
        table.push(row(format!("with {kind}"), &of));
    }
    let mut seconds: Vec<f64> = all.iter().map(|one| one.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let at = |part: f64| seconds.get((part * seconds.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    let longest = seconds.last().copied().unwrap_or(f64::NAN);
    format!("{table}\nCPU seconds: median {:.1}, nine of ten {:.1}, longest {longest:.1}", at(0.5), at(0.9))
}
