//! What came of cases: line by line, and as tables.

use super::case::{Case, Kind};
use crate::wrong_models::Failure;
use frfit::identify::{Identification, Line, Status};
use frfit::material::loss_factor;

/// A case and what came of it.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Its number.
    pub index: u64,
    /// Of what.
    pub kind: Kind,
    /// Rows of the model.
    pub rows: usize,
    /// Modes in the band.
    pub modes: usize,
    /// Sensors.
    pub sensors: usize,
    /// True loss factor in the middle of the band.
    pub loss: f64,
    /// Nominal over true factor.
    pub ratio: f64,
    /// Whether there are bounds.
    pub bounded: bool,
    /// Noise over response, and whether it is known.
    pub noise: (f64, bool),
    /// What each line is.
    pub lines: Vec<Judged>,
    /// CPU seconds.
    pub seconds: f64,
    /// Factorisations.
    pub factorisations: usize,
}

/// A line.
#[derive(Debug, Clone, Copy)]
pub struct Judged {
    /// Its status.
    pub status: Status,
    /// Whether its data say what the factor is.
    pub identifiable: bool,
    /// Whether it is `ok`, and more than [`WRONG`] error bars and [`WRONG_RELATIVE`] off.
    pub wrong: bool,
    /// Whether there is a value, and it is right.
    pub right: bool,
}

/// A factor known better than this, relative, is identifiable: of data with noise …
const IDENTIFIABLE: f64 = 0.05;

/// … where that is less than this part of the loss factor too …
const IDENTIFIABLE_LOSS: f64 = 0.1;

/// … and of exact data, by what roundoff leaves.
const IDENTIFIABLE_EXACT: f64 = 1e-4;

/// Error bars, and relative error, beyond which a value is wrong.
pub const WRONG: f64 = 5.0;
/// See [`WRONG`].
pub const WRONG_RELATIVE: f64 = 1e-5;

impl Tried {
    /// Of an identification.
    ///
    /// # Errors
    /// Where the true law has no value.
    pub fn new(case: &Case, found: &Identification, seconds: f64) -> Result<Self, Failure> {
        let judged = |(line, &at_best): (&Line, &f64)| -> Result<Judged, Failure> {
            let truth = case.truth.at(line.frequency_hz)?;
            let of_noise = || IDENTIFIABLE.min(IDENTIFIABLE_LOSS * loss_factor(truth));
            let least = if case.noise == 0.0 { IDENTIFIABLE_EXACT } else { of_noise() };
            let off = |value: frfit::c64| {
                let bars = line.uncertainty();
                let storage = bars.map_or(0.0, |bars| bars.storage_std);
                let loss = bars.and_then(|bars| bars.loss_factor_std).unwrap_or(0.0);
                let allowed = |bar: f64, size: f64| (WRONG * bar).max(WRONG_RELATIVE * size);
                (value.re - truth.re).abs() > allowed(storage, truth.re)
                    || (loss_factor(value) - loss_factor(truth)).abs() > allowed(loss, 1.0)
            };
            let wrong = line.factor().map(off);
            Ok(Judged {
                status: line.status,
                identifiable: at_best <= least,
                wrong: line.status == Status::Ok && wrong.unwrap_or(false),
                right: wrong == Some(false),
            })
        };
        Ok(Self {
            index: case.index,
            kind: case.kind,
            rows: case.model.dim(),
            modes: case.modes,
            sensors: case.experiment.sensors.len(),
            loss: case.middle_loss(),
            ratio: case.ratio,
            bounded: case.bounds.is_some(),
            noise: (case.noise, case.noise_known),
            lines: found.lines.iter().zip(&case.at_best).map(judged).collect::<Result<_, _>>()?,
            seconds,
            factorisations: found.search.work.factorisations,
        })
    }

    fn count(&self, of: impl Fn(&Judged) -> bool) -> usize {
        self.lines.iter().filter(|line| of(line)).count()
    }

    /// Lines whose data say what the factor is, and that are not `ok`.
    pub fn refused(&self) -> usize {
        self.count(|line| line.identifiable && line.status != Status::Ok)
    }

    /// Lines that are `ok` and wrong.
    pub fn wrong(&self) -> usize {
        self.count(|line| line.wrong)
    }
}

/// A case in a line of text.
pub fn described(tried: &Tried) -> String {
    let Tried { index, kind, rows, modes, sensors, loss, ratio, seconds, factorisations, .. } = tried;
    let noise = match tried.noise {
        (0.0, _) => "exact".to_owned(),
        (noise, known) => {
            format!("noise {:.2} % ({})", 100.0 * noise, if known { "known" } else { "unknown" })
        }
    };
    let bounds = if tried.bounded { "bounds" } else { "no bounds" };
    let mut statuses: Vec<(Status, usize)> = Vec::new();
    for line in &tried.lines {
        match statuses.iter_mut().find(|(status, _)| *status == line.status) {
            Some((_, count)) => *count += 1,
            None => statuses.push((line.status, 1)),
        }
    }
    let statuses: Vec<String> =
        statuses.iter().map(|(status, count)| format!("{count} {}", status.name())).collect();
    format!(
        "case {index}: {kind}, {rows} rows, {modes} modes, {sensors} sensors, {noise}, η {loss:.2e}, nominal {ratio:.2}, {bounds}: \
         {} lines, {} identifiable, {} refused, {} wrong; {}; {seconds:.1} s, {factorisations} factorisations",
        tried.lines.len(),
        tried.count(|line| line.identifiable),
        tried.refused(),
        tried.wrong(),
        statuses.join(", "),
    )
}

/// What the columns of [`markdown`] mean.
pub const LEGEND: &str = "\
Identifiable: lines whose data say what the factor is, at the truth and by the full model, to 5 % and its loss factor to a tenth with noise, and to 10⁻⁴ without. Refused: those of them \
that are not `ok`; in brackets those with the right value all the same. Wrong: `ok`, and more than five error bars and 10⁻⁵ off. Times are CPU seconds.";

/// One row for each kind of data, and one for each kind of model.
pub fn markdown(tried: &[Tried]) -> String {
    let heading = "| | cases | lines | identifiable | ok % | refused % (right) | wrong % | time, median (s) | time, largest (s) | factorisations, largest |";
    let mut rows = vec![heading.to_owned(), "|---|---|---|---|---|---|---|---|---|---|".to_owned()];
    let mut row = |name: &str, of: &dyn Fn(&Tried) -> bool| {
        let group: Vec<&Tried> = tried.iter().filter(|one| of(one)).collect();
        if group.is_empty() {
            return;
        }
        let sum = |of: &dyn Fn(&Tried) -> usize| group.iter().map(|one| of(one)).sum::<usize>();
        let lines = sum(&|one| one.lines.len());
        let identifiable = sum(&|one| one.count(|line| line.identifiable));
        let percent = |count: usize, of: usize| 100.0 * count as f64 / of.max(1) as f64;
        let right =
            sum(&|one| one.count(|line| line.identifiable && line.status != Status::Ok && line.right));
        let ok = sum(&|one| one.count(|line| line.status == Status::Ok));
        let mut seconds: Vec<f64> = group.iter().map(|one| one.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let most = group.iter().map(|one| one.factorisations).max().unwrap_or(0);
        rows.push(format!(
            "| {name} | {} | {lines} | {identifiable} | {:.1} | {:.2} ({:.2}) | {:.3} | {:.2} | {:.1} | {most} |",
            group.len(),
            percent(ok, lines),
            percent(sum(&Tried::refused), identifiable),
            percent(right, identifiable),
            percent(sum(&Tried::wrong), ok),
            seconds.get(seconds.len() / 2).copied().unwrap_or(0.0),
            seconds.last().copied().unwrap_or(0.0),
        ));
    };
    let is_exact = |one: &Tried| one.noise.0 == 0.0;
    row("exact, one sensor", &|one| is_exact(one) && one.sensors == 1);
    row("exact, several", &|one| is_exact(one) && one.sensors > 1);
    row("noise, one sensor", &|one| !is_exact(one) && one.sensors == 1);
    row("noise, several", &|one| !is_exact(one) && one.sensors > 1);
    for kind in Kind::MADE.into_iter().chain([Kind::Published]) {
        row(&kind.to_string(), &|one| one.kind == kind);
    }
    row("all", &|_| true);
    rows.join("\n")
}
