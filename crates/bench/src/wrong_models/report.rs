//! Results as Markdown, as CSV, and line by line.

use super::case::Case;
use super::fault::Class;
use super::natural::median;
use super::score::{Judged, Part, Summary};
use super::structure::Kind;
use super::way::Way;
use frfit::identify::{Explained, Identification, ModelErrorsFound, Status};

/// What is kept of a case.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Its number.
    pub index: u64,
    /// How its model is wrong.
    pub class: Class,
    /// Of what.
    pub kind: Kind,
    /// Rows of the model, and of the truth.
    pub rows: [usize; 2],
    /// Modes in the band.
    pub modes: usize,
    /// Lines.
    pub lines: usize,
    /// Sensors.
    pub sensors: usize,
    /// Noise over response.
    pub noise: f64,
    /// Whether that is known.
    pub noise_known: bool,
    /// True loss factor in the middle of the band.
    pub loss: f64,
    /// Nominal over true factor.
    pub ratio: f64,
    /// Median error of the natural frequencies; `None` where the truth has none of these modes.
    pub frequency_error: Option<f64>,
    /// Natural frequencies of the model, and by how much each is too high.
    pub frequency_errors: Vec<[f64; 2]>,
    /// What came of it, each way.
    pub runs: Vec<Run>,
}

/// One identification.
#[derive(Debug, Clone)]
pub struct Run {
    /// How the unknown was said to vary.
    pub way: Way,
    /// Lines with a value.
    pub judged: Vec<Judged>,
    /// Whether the band was explained; `None` where that is unknown.
    pub verdict: Option<Explained>,
    /// Level of the noise with which the error bars were made.
    pub level: Option<f64>,
    /// Errors of the model that were found.
    pub errors: Option<ModelErrorsFound>,
    /// CPU seconds.
    pub seconds: f64,
}

impl Run {
    /// Of an identification, and what of it is right.
    pub fn new(way: Way, found: &Identification, judged: Vec<Judged>, seconds: f64) -> Self {
        let verdict = found.fit.map(|fit| fit.verdict);
        Self { way, judged, verdict, level: found.noise.level, errors: found.model_errors.clone(), seconds }
    }

    fn ok(&self) -> impl Iterator<Item = &Judged> + Clone {
        self.judged.iter().filter(|line| line.status == Status::Ok)
    }
}

impl Tried {
    /// A case with what came of it.
    pub fn new(case: &Case, runs: Vec<Run>) -> Self {
        Self {
            index: case.index,
            class: case.class,
            kind: case.kind,
            rows: [case.model.dim(), case.truth_rows],
            modes: case.modes,
            lines: case.frequency_hz.len(),
            sensors: case.experiment.sensors.len(),
            noise: case.noise,
            noise_known: case.noise_known,
            loss: case.middle_loss(),
            ratio: case.ratio,
            frequency_error: case.frequency_error,
            frequency_errors: case.frequency_errors.clone(),
            runs,
        }
    }
}

/// What the columns of [`markdown`] mean.
pub const LEGEND: &str = "\
Δf: median error of the model's natural frequencies in the band. Values: lines with a value, of so many lines. Then of the values that are `ok`: \
those whose E′ and η are within 2σ of the truth, those where one is more than 4σ off, medians of σ and of the error over the truth. \
All: values of any status. Of several unknowns each constant is one value. Values without an error bar count for the errors alone. Times are CPU seconds, medians. \
Neighbouring lines of a smooth curve, and all lines of a law, have one error: of so few cases their coverage is a coarse number.";

/// One row for each class and way.
pub fn markdown(tried: &[Tried]) -> String {
    let heading = [
        "class",
        "cases",
        "Δf %",
        "way",
        "values",
        "of lines",
        "no bar",
        "ok %",
        "E′ in 2σ %",
        "η in 2σ %",
        "> 4σ %",
        "σ E′ %",
        "σ η %",
        "error E′ %",
        "error η %",
        "all: E′ in 2σ %",
        "all: η in 2σ %",
        "all: > 4σ %",
        "s",
    ];
    let mut rows = vec![heading.map(String::from).to_vec()];
    for class in Class::ALL {
        let cases: Vec<&Tried> = tried.iter().filter(|case| case.class == class).collect();
        for way in Way::ALL {
            let of_way = |case: &&'_ Tried| {
                case.runs.iter().find(|run| run.way == way).map(|run| (run.clone(), case.lines))
            };
            let runs: Vec<(Run, usize)> = cases.iter().filter_map(of_way).collect();
            if runs.is_empty() {
                continue;
            }
            let all = Summary::of(runs.iter().flat_map(|(run, _)| &run.judged));
            let ok = Summary::of(runs.iter().flat_map(|(run, _)| run.ok()));
            let lines: usize = runs.iter().map(|(_, lines)| lines).sum();
            let off = median(cases.iter().filter_map(|case| case.frequency_error).collect());
            let mut row = vec![class.to_string(), runs.len().to_string(), percent(off), way.to_string()];
            row.extend([all.count, lines, all.without_bar].map(|count| count.to_string()));
            row.push(share((all.count > 0).then(|| ok.count as f64 / all.count as f64)));
            row.extend([share(ok.covered[0]), share(ok.covered[1]), share(ok.far)]);
            row.extend(ok.bar.into_iter().chain(ok.error).map(percent));
            row.extend([share(all.covered[0]), share(all.covered[1]), share(all.far)]);
            let seconds = median(runs.iter().map(|(run, _)| run.seconds).collect());
            row.push(seconds.map_or_else(none, |seconds| format!("{seconds:.2}")));
            rows.push(row);
        }
    }
    table(&rows)
}

fn none() -> String {
    "–".to_owned()
}

/// A share in percent.
fn share(part: Option<f64>) -> String {
    part.map_or_else(none, |part| format!("{:.1}", 100.0 * part))
}

/// A small number in percent.
fn percent(value: Option<f64>) -> String {
    value.map_or_else(none, |value| match 100.0 * value {
        value if value == 0.0 || value.abs() < 1e-6 => "0".to_owned(),
        value if value.abs() < 0.1 => format!("{value:.1e}"),
        value => format!("{value:.2}"),
    })
}

/// Rows as a table of Markdown, the first of them its heading, in columns of one width.
fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let length = |row: &Vec<String>, k: usize| row.get(k).map_or(0, |cell| cell.chars().count());
    let width = |k: usize| rows.iter().map(|row| length(row, k)).max().unwrap_or(0).max(3);
    let mut text = String::new();
    for (i, row) in rows.iter().enumerate() {
        let cells = row.iter().enumerate().map(|(k, cell)| match k {
            0 => format!("{cell:<0$}", width(k)),
            _ => format!("{cell:>0$}", width(k)),
        });
        text += &format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
        if i == 0 {
            let rule = |k: usize| if k == 0 { "-".repeat(width(k)) } else { "-".repeat(width(k) - 1) + ":" };
            text += &format!("| {} |\n", (0..columns).map(rule).collect::<Vec<_>>().join(" | "));
        }
    }
    text
}

/// One line for each case and way, under a heading.
pub fn csv(tried: &[Tried]) -> String {
    let heading = [
        "case,class,structure,rows,truth_rows,modes,lines,sensors,noise,noise_known,loss_factor,nominal_over_truth",
        "frequency_error,way,values,without_bar,ok,verdict,noise_level",
        "ok_storage_covered,ok_loss_covered,ok_far,ok_storage_bar,ok_loss_bar,ok_storage_error,ok_loss_error",
        "storage_covered,loss_covered,far,storage_bar,loss_bar,storage_error,loss_error,cpu_s",
    ];
    let mut text = heading.join(",") + "\n";
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4e}"));
    let summary = |of: Summary| {
        let numbers = of.covered.into_iter().chain([of.far]).chain(of.bar).chain(of.error);
        numbers.map(number).collect::<Vec<_>>()
    };
    for case in tried {
        for run in &case.runs {
            let mut cells = vec![case.index.to_string(), case.class.to_string(), case.kind.to_string()];
            cells.extend(case.rows.map(|rows| rows.to_string()));
            cells.extend([case.modes, case.lines, case.sensors].map(|count| count.to_string()));
            cells.extend([number(Some(case.noise)), case.noise_known.to_string()]);
            cells.extend([Some(case.loss), Some(case.ratio), case.frequency_error].map(number));
            let all = Summary::of(run.judged.iter());
            cells.push(run.way.to_string());
            cells.extend([all.count, all.without_bar, run.ok().count()].map(|count| count.to_string()));
            cells.push(run.verdict.map_or("untold", Explained::name).to_owned());
            cells.push(number(run.level));
            cells.extend(summary(Summary::of(run.ok())));
            cells.extend(summary(all));
            cells.push(format!("{:.3}", run.seconds));
            text += &(cells.join(",") + "\n");
        }
    }
    text
}

/// What a case is, in a few words.
pub fn described(case: &Tried) -> String {
    let Tried {
        index, class, kind, rows: [rows, truth_rows], modes, lines, sensors, noise, loss, ratio, ..
    } = case;
    let knowledge = if case.noise_known { "known" } else { "unknown" };
    format!(
        "case {index}: {class}, {kind}, {rows} rows (truth {truth_rows}), {modes} modes, {lines} lines, {sensors} sensors, \
         noise {:.2} % ({knowledge}), η {loss:.2e} in the middle, nominal {ratio:.3} of the truth, Δf {} %",
        100.0 * noise,
        percent(case.frequency_error)
    )
}

/// Natural frequencies at the found and at the true modulus that differ by more than this part are two modes.
const SAME_MODE: f64 = 0.1;

/// The errors of the model that were found, beside what they are.
pub fn errors(case: &Tried, run: &Run) -> String {
    let Some(found) = &run.errors else { return String::from("no errors of the model") };
    let mut rows = vec![["Hz", "δ % true", "δ %", "σ %"].map(String::from).to_vec()];
    for mode in &found.modes {
        let away = |[hz, _]: &[f64; 2]| (hz / mode.frequency_hz - 1.0).abs();
        let near = case.frequency_errors.iter().filter(|known| away(known) <= SAME_MODE);
        let nearest = near.min_by(|a, b| away(a).total_cmp(&away(b)));
        // The model has ω_i(1 + δ) where it is right.
        let truth =
            nearest.map_or_else(none, |[_, error]| format!("{:.3}", 100.0 * (1.0 / (1.0 + error) - 1.0)));
        let own = [mode.error, mode.std].map(|value| format!("{:.3}", 100.0 * value));
        rows.push([format!("{:.2}", mode.frequency_hz), truth].into_iter().chain(own).collect());
    }
    let factors = found.factors.iter().map(|factor| {
        format!(
            "term {} {:?}: {:.3} ± {:.3} %\n",
            factor.term,
            factor.part,
            100.0 * factor.error,
            100.0 * factor.std
        )
    });
    let masses = found.masses.iter().enumerate();
    let masses = masses.map(|(m, one)| format!("mass at sensor {m}: {:.4e} ± {:.1e}\n", one.mass, one.std));
    let calibrations = found.calibrations.iter().enumerate().map(|(m, one)| {
        let what = if m == 0 { "force".to_owned() } else { format!("sensor {}", m - 1) };
        format!("calibration of {what}: {:.3} ± {:.3} %\n", 100.0 * one.error, 100.0 * one.std)
    });
    format!(
        "errors of the model, by {:.1} nats: s {:.3} %, s_a {:.2} %\n\n{}\n{}",
        found.evidence,
        100.0 * found.frequency_std,
        100.0 * found.shape_std,
        table(&rows),
        factors.chain(masses).chain(calibrations).collect::<String>()
    )
}

/// All lines of an identification that have a value, as a table.
pub fn lines(run: &Run) -> String {
    let heading = ["Hz", "status", "E′ true", "E′", "σ", "off by σ", "η true", "η", "σ", "off by σ"];
    let mut rows = vec![heading.map(String::from).to_vec()];
    for line in &run.judged {
        let part = |part: &Part| {
            let bar = part.bar.map_or_else(none, |bar| format!("{bar:.1e}"));
            let off = part.deviations().map_or_else(none, |off| format!("{off:.1}"));
            [format!("{:.5e}", part.truth), format!("{:.5e}", part.found), bar, off]
        };
        let cells = [format!("{:.3}", line.frequency_hz), line.status.name().to_owned()];
        rows.push(cells.into_iter().chain(line.parts.iter().flat_map(part)).collect());
    }
    let verdict = run.verdict.map_or("unknown whether it is explained", Explained::name);
    let level = run.level.map_or_else(none, |level| format!("{level:.3e}"));
    format!("{}: {verdict}, level of the noise {level}, {:.2} s\n\n{}", run.way, run.seconds, table(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_markdown() {
        let rows = [["a", "bc"], ["η", "1.25"]].map(|row| row.map(String::from).to_vec());
        assert_eq!(table(&rows), "| a   |   bc |\n| --- | ---: |\n| η   | 1.25 |\n");
    }
}
