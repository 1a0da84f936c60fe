//! `modes.csv`, `stabilisation.csv` and `correlation.csv`.

use super::ModesRun;
use crate::load::Case;
use frfit::model::Role;
use frfit_formats::csv::{Cell, write};

fn number(value: Option<f64>) -> Cell<'static> {
    value.map_or(Cell::Empty, Cell::Number)
}

/// One row a mode: pairs of model and measurement, then those without a partner, in the order of their frequencies.
pub(super) fn modes(case: &Case, run: &ModesRun) -> String {
    let stiffness: Vec<usize> =
        (0..case.model.terms().len()).filter(|&t| case.model.terms()[t].role == Role::Stiffness).collect();
    let energy: Vec<String> =
        stiffness.iter().map(|&t| format!("{}.energy_share", case.model.terms()[t].name)).collect();
    let mut columns = vec![
        "kind",
        "model_mode",
        "model_frequency_hz",
        "model_damping_ratio",
        "measured_mode",
        "measured_frequency_hz",
        "measured_frequency_std_hz",
        "measured_damping_ratio",
        "measured_damping_ratio_std",
        "frequency_difference",
        "mac",
        "is_crossing",
    ];
    columns.extend(energy.iter().map(String::as_str));
    let mut rows: Vec<(f64, Vec<Cell<'_>>)> = Vec::new();
    let measured = run.measured.as_ref().map_or(&[][..], |measured| &measured.modes.modes);
    let cells = |i: Option<usize>, j: Option<usize>, kind: &'static str| {
        let own = i.map(|i| &run.model.modes[i]);
        let other = j.map(|j| &measured[j]);
        let pair = i.and_then(|i| run.partner_of_model(i));
        let counted = |at: Option<usize>| at.map_or(Cell::Empty, |at| Cell::Count(at + 1));
        let mut cells = vec![
            Cell::Text(kind),
            counted(i),
            number(own.map(|own| own.frequency_hz())),
            number(own.map(|own| own.damping_ratio())),
            counted(j),
            number(other.map(|other| other.frequency_hz())),
            number(other.and_then(|other| other.frequency_std_hz)),
            number(other.map(|other| other.damping_ratio())),
            number(other.and_then(|other| other.damping_ratio_std)),
            number(pair.map(|pair| pair.frequency_difference)),
            number(pair.and_then(|pair| pair.assurance)),
            pair.map_or(Cell::Empty, |pair| Cell::Text(if pair.is_crossing { "yes" } else { "no" })),
        ];
        cells.extend(stiffness.iter().map(|&t| number(own.map(|own| own.energy_shares[t]))));
        let place = own.map(|own| own.frequency_hz()).or(other.map(|other| other.frequency_hz()));
        (place.unwrap_or(0.0), cells)
    };
    for i in run.shown() {
        let partner = run.partner_of_model(i).map(|pair| pair.measured);
        let kind = match partner {
            _ if run.model.modes[i].is_rigid_body() => "rigid body",
            Some(_) => "pair",
            None => "model",
        };
        rows.push(cells(Some(i), partner, kind));
    }
    let alone = (0..measured.len()).filter(|&j| run.partner_of_measured(j).is_none());
    rows.extend(alone.map(|j| cells(None, Some(j), "measured")));
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    write(&columns, rows.into_iter().map(|(_, cells)| cells)).expect("every row has the columns")
}

/// One row a pole at an order.
pub(super) fn stabilisation(run: &ModesRun) -> String {
    let diagram = run.measured.iter().flat_map(|measured| &measured.modes.diagram);
    let rows = diagram.map(|pole| {
        [
            Cell::Count(pole.order),
            Cell::Number(pole.frequency_hz()),
            Cell::Number(pole.damping_ratio()),
            Cell::Text(if pole.is_stable { "yes" } else { "no" }),
        ]
    });
    write(&["order", "frequency_hz", "damping_ratio", "is_stable"], rows).expect("every row has the columns")
}

/// CSAC and CSF, one row a frequency.
pub(super) fn correlation(run: &ModesRun) -> String {
    let rows = run.measured.iter().flat_map(|measured| {
        let each = measured.band.frequency_hz.iter().zip(measured.csac.iter().zip(&measured.csf));
        each.map(|(&f, (&csac, &csf))| [Cell::Number(f), number(csac), number(csf)])
    });
    write(&["frequency_hz", "csac", "csf"], rows).expect("every row has the columns")
}
