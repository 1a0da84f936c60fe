//! How a status looks: its colour in figures and on the page, and its words where no frequency has a value of its own.

use frfit::identify::{Status, Trust};
use frfit_figures::Color;
use std::fmt::Write;

/// The colour of a status in figures; the page has its [shades](Color::shades).
pub fn status_color(status: Status) -> Color {
    match status {
        Status::Ok => Color::Green,
        Status::Ambiguous => Color::Yellow,
        Status::Diverged => Color::Vermilion,
        Status::NoRoot => Color::Purple,
        Status::NotIdentifiable => Color::Grey,
        Status::Unexplained => Color::Orange,
        Status::Failed => Color::Blue,
        Status::OutOfBand => Color::Black,
        // A new status has the colour that is free until it gets one here.
        _ => Color::SkyBlue,
    }
}

/// The hatch of a status, by which it is known without its colour, as Plotly names it.
pub(crate) fn pattern(status: Status) -> &'static str {
    match status {
        Status::Ambiguous => "\\",
        Status::Unexplained => "/",
        Status::NotIdentifiable => ".",
        Status::NoRoot => "x",
        Status::Diverged => "-",
        Status::Failed => "+",
        Status::OutOfBand => "|",
        _ => "",
    }
}

/// The same hatch in a style sheet, in the colour of the status.
fn hatch(status: Status) -> String {
    let lines = |angle: i32| {
        format!(
            "repeating-linear-gradient({angle}deg, var(--{}) 0 1.5px, transparent 1.5px 6px)",
            status.name()
        )
    };
    let all = match pattern(status) {
        "" => return "none".into(),
        "." => {
            return format!(
                "radial-gradient(var(--{}) 1.6px, transparent 1.9px) 0 0 / 6px 6px",
                status.name()
            );
        }
        "\\" => vec![45],
        "/" => vec![-45],
        "x" => vec![45, -45],
        "-" => vec![0],
        "|" => vec![90],
        _ => vec![0, 90],
    };
    all.into_iter().map(lines).collect::<Vec<_>>().join(", ")
}

/// The style of `.tint` with the name of a status as its class, in the light and in the dark theme: its hatch on its colour, paled.
pub(crate) fn style() -> String {
    let (mut light, mut dark, mut rules) = (String::new(), String::new(), String::new());
    for status in Status::ALL {
        let (name, shades) = (status.name(), status_color(status).shades());
        // Writing to a string does not fail.
        let _ = write!(light, " --{name}: {};", shades.light);
        let _ = write!(dark, " --{name}: {};", shades.dark);
        let _ = writeln!(
            rules,
            ".tint.{name} {{ background: {}; background-color: color-mix(in srgb, var(--{name}) 32%, var(--card)); }}",
            hatch(status)
        );
    }
    format!(":root {{{light} }}\n:root[data-theme=\"dark\"] {{{dark} }}\n{rules}")
}

/// A status as a label; `own` is whether frequencies have values of their own.
pub(crate) fn label(status: Status, own: bool) -> &'static str {
    if status == Status::Ok && !own { "explained" } else { status.label() }
}

/// What a status means, and what its value is good for; `own` as in [`label`].
pub(crate) fn meaning(status: Status, own: bool) -> String {
    if status == Status::Ok && !own {
        return "the values that hold for the band explain all sensors there".into();
    }
    let value = match status.trust() {
        Trust::Ambiguous => "; the likeliest is shown, the others are among the candidates",
        Trust::EvidenceOnly => "; the value shown is evidence, not a result",
        Trust::Trusted | Trust::NoAnswer | Trust::NotAsked => "",
    };
    format!("{}{value}", status.meaning())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_a_colour_of_its_own() {
        let all = Status::ALL.map(status_color);
        assert!((1..all.len()).all(|i| !all[..i].contains(&all[i])), "{all:?}");
    }

    #[test]
    fn every_status_has_a_hatch_of_its_own_on_the_page_and_in_plots() {
        let all = Status::ALL.map(pattern);
        assert!((1..all.len()).all(|i| !all[..i].contains(&all[i])), "{all:?}");
        let style = style();
        for status in Status::ALL {
            let rule = format!(".tint.{} {{ background: {};", status.name(), hatch(status));
            assert!(style.contains(&rule), "{rule}\n{style}");
        }
    }
}
