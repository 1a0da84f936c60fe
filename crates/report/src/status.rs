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

/// The style of `rect` and `.dot` with the name of a status as their class, in the light and in the dark theme.
pub(crate) fn style() -> String {
    let (mut light, mut dark, mut rules) = (String::new(), String::new(), String::new());
    for status in Status::ALL {
        let (name, shades) = (status.name(), status_color(status).shades());
        // Writing to a string does not fail.
        let _ = write!(light, " --{name}: {};", shades.light);
        let _ = write!(dark, " --{name}: {};", shades.dark);
        let _ = writeln!(
            rules,
            "rect.{name} {{ fill: var(--{name}); }} .dot.{name} {{ background: var(--{name}); }}"
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
}
