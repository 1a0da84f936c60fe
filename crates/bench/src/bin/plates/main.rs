//! Five measured plates of spruce: their four constants beside the published moduli, and what the constants predict.
//!
//! `plates [NAME ...] [--thick] [--starts N]`: all plates, or some; with transverse shear, or without. `plates NAME --write FOLDER`: the case of a plate, for the command line.
//!
//!  For each: the three moduli from all impacts and frequencies, from nominal values of its own for each of N starts
//! (default 0), from impacts 1 to 3 and from 4 and 5, from the lower and from the upper part of the band; natural frequencies beside the measured ones, also those of
//! the part of the band that was left out.
//!
//! Needs the records in the folder `spruce` of the data that are not part of the project.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit_bench::cases::number;
use frfit_bench::data::{absent, data};
use frfit_bench::plates::Plate;
use frfit_bench::plates::case::{BOUNDS, NOMINAL, Setting};
use frfit_bench::plates::found::{Found, PredictedMode};
use frfit_bench::wrong_models::Failure;
use frfit_bench::wrong_models::dice::Dice;
use frfit_bench::wrong_models::natural::median;
use frfit_bench::{Table, machine};
use std::path::Path;

/// Starts are off by up to this factor to either side, within the bounds.
const START_WITHIN: f64 = 2.0;

/// Peaks above are not looked at where natural frequencies are compared.
const COMPARED_HZ: f64 = 600.0;

fn main() -> Result<(), Failure> {
    let (mut names, mut starts, mut folder, mut whole) = (Vec::new(), 0, None, Setting::default());
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--starts" => starts = number(&words.next().ok_or("--starts: expected a number")?)?,
            "--thick" => whole.thick = true,
            "--write" => folder = Some(words.next().ok_or("--write: expected a folder")?),
            _ => names.push(word),
        }
    }
    println!("Plates of spruce: constants, and what they predict\n{}\n", machine());
    let records = data().join("spruce");
    if !records.is_dir() {
        println!("{}", absent(&records));
        return Ok(());
    }
    let all = Plate::all()?;
    if let Some(name) = names.iter().find(|name| all.iter().all(|plate| plate.name != **name)) {
        let known: Vec<&str> = all.iter().map(|plate| plate.name.as_str()).collect();
        return Err(format!("no plate is named {name}; there are {}", known.join(", ")).into());
    }
    let is_asked = |plate: &&Plate| names.is_empty() || names.contains(&plate.name);
    let mut asked = all.iter().filter(is_asked);
    let Some(folder) = folder else { return asked.try_for_each(|plate| study(plate, &whole, starts)) };
    asked.try_for_each(|plate| {
        let folder = Path::new(&folder).join(&plate.name);
        std::fs::create_dir_all(&folder)?;
        println!("{}", plate.case(&whole, &folder)?.display());
        Ok(())
    })
}

/// All about a plate.
fn study(plate: &Plate, whole: &Setting, starts: u64) -> Result<(), Failure> {
    let [low_hz, high_hz] = whole.band_hz;
    let middle_hz = 0.5 * (low_hz + high_hz);
    let [lower, upper] = [[low_hz, middle_hz], [middle_hz, high_hz]].map(|band_hz| Setting {
        band_hz,
        max_lines: whole.max_lines / 2,
        ..whole.clone()
    });
    let [first, last] = [vec![1, 2, 3], vec![4, 5]].map(|impacts| Setting { impacts, ..whole.clone() });
    let mut table = Table::new([
        &format!("plate {}, GPa", plate.name),
        "E_L",
        "E_R",
        "G_LR",
        "farthest, joint std",
        "errors of modes",
        "verdict",
        "ok",
        "s",
    ]);
    let published = plate.published.map(modulus);
    table.push(std::iter::once("published".to_owned()).chain(published));
    let row = |name: &str, found: &Found, beside: &[(f64, f64); 3]| {
        let of_moduli = found.moduli().map(modulus);
        let mut cells = vec![name.to_owned()];
        cells.extend(of_moduli);
        cells.push(format!("{:.2}", farthest(&found.moduli(), beside)));
        cells.push(format!("{:.2} %", 100.0 * found.frequency_std));
        cells.push(found.verdict.map_or("-", |verdict| verdict.name()).to_owned());
        cells.push(format!("{} of 4", found.ok));
        cells.push(format!("{:.0}", found.seconds));
        cells
    };
    let of_whole = plate.identify(whole)?;
    table.push(row("all, beside published", &of_whole, &plate.published));
    let whole_moduli = of_whole.moduli();
    let of_first = plate.identify(&first)?;
    table.push(row("impacts 1 to 3, beside all", &of_first, &whole_moduli));
    let of_last = plate.identify(&last)?;
    table.push(row("impacts 4 and 5, beside 1 to 3", &of_last, &of_first.moduli()));
    let of_lower = plate.identify(&lower)?;
    table.push(row(&format!("{low_hz} to {middle_hz} Hz, beside all"), &of_lower, &whole_moduli));
    let of_upper = plate.identify(&upper)?;
    table.push(row(&format!("{middle_hz} to {high_hz} Hz, beside lower"), &of_upper, &of_lower.moduli()));
    println!("{table}");
    let covered =
        |share: Option<f64>| share.map_or("-".to_owned(), |share| format!("{:.1} %", 100.0 * share));
    println!(
        "responses of impacts 4 and 5 within 95 % of what 1 to 3 predict: {}",
        covered(of_first.covers(&of_last))
    );
    println!(
        "responses of impacts 1 to 3 within 95 % of what 4 and 5 predict: {}",
        covered(of_last.covers(&of_first))
    );
    let predicted = plate.predicted(&of_whole, whole)?;
    let of_published = plate.of_published(&of_whole, whole)?;
    for (with, modes_with) in [("these constants", &predicted), ("the published moduli", &of_published)] {
        let is_compared = |mode: &&PredictedMode| mode.measured_hz < COMPARED_HZ;
        let compared: Vec<f64> =
            modes_with.iter().filter(is_compared).map(|mode| mode.difference().abs()).collect();
        println!(
            "{} natural frequencies below {COMPARED_HZ} Hz, median difference with {with} {:.2} %",
            compared.len(),
            100.0 * median(compared).unwrap_or(f64::NAN)
        );
        println!("{}", modes(modes_with));
    }
    let is_above = |mode: &PredictedMode| mode.measured_hz > middle_hz;
    for (name, found, wants_above) in [("lower", &of_lower, true), ("upper", &of_upper, false)] {
        let mut left_out = plate.predicted(found, whole)?;
        left_out.retain(|mode| is_above(mode) == wants_above);
        let within = left_out.iter().filter(|mode| mode.difference().abs() <= 2.0 * mode.std).count();
        println!(
            "of {} natural frequencies beyond the {name} part, {within} are within 2σ of what it predicts",
            left_out.len()
        );
        println!("{}", modes(&left_out));
    }
    let mut table = Table::new(["start, of nominal", "E_L", "E_R", "G_LR", "farthest from all, std", "s"]);
    for start in 0..starts {
        let mut dice = Dice::new(1, start);
        let factors: [f64; 4] = std::array::from_fn(|_| START_WITHIN.powf(dice.between(-1.0, 1.0)));
        let nominal = std::array::from_fn(|k| {
            [(NOMINAL[k] * factors[k]).clamp(BOUNDS[k][0], BOUNDS[k][1]), whole.nominal[k][1]]
        });
        let found = plate.identify(&Setting { nominal, ..whole.clone() })?;
        let mut cells = vec![factors.map(|factor| format!("{factor:.2}")).join(" ")];
        cells.extend(found.moduli().map(modulus));
        let off =
            found.moduli().into_iter().zip(&whole_moduli).map(|(one, all)| (one.0 - all.0).abs() / all.1);
        cells.push(format!("{:.3}", off.fold(0.0, f64::max)));
        cells.push(format!("{:.0}", found.seconds));
        table.push(cells);
    }
    if starts > 0 {
        println!("{table}");
    }
    Ok(())
}

/// The largest difference of moduli over their joint standard deviation.
fn farthest(found: &[(f64, f64); 3], beside: &[(f64, f64); 3]) -> f64 {
    let joint = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() / a.1.hypot(b.1);
    found.iter().zip(beside).map(joint).fold(0.0, f64::max)
}

fn modulus((value, std): (f64, f64)) -> String {
    format!("{:.3} ± {:.1} %", 1e-9 * value, 100.0 * std / value)
}

fn modes(predicted: &[PredictedMode]) -> String {
    let one = |mode: &PredictedMode| {
        format!("{:.1} Hz {:+.2} ± {:.2} %", mode.measured_hz, 100.0 * mode.difference(), 100.0 * mode.std)
    };
    predicted.iter().map(one).collect::<Vec<_>>().join("; ")
}
