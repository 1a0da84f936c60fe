//! Tables: the load, the names of rows, the truth.

use crate::{Error, Model, SeveralModel};
use frfit::c64;
use frfit::dof::DofName;
use frfit::material::loss_factor;
use frfit::model::Role;
use frfit_formats::csv::{self, Cell};

/// Columns row (from 1), re, im: the rows that are loaded.
pub(crate) fn force(load: &[c64]) -> Result<String, Error> {
    let numbers: Vec<String> = (1..=load.len()).map(|row| row.to_string()).collect();
    let loaded = numbers.iter().zip(load).filter(|(_, force)| force.norm() > 0.0);
    let rows = loaded.map(|(row, force)| [Cell::Text(row), force.re.into(), force.im.into()]);
    Ok(csv::write(&["row", "re", "im"], rows)?)
}

/// Columns row (from 1), node, direction: the rows that have a name.
pub(crate) fn dofs(names: &[Option<DofName>]) -> Result<String, Error> {
    let named = (1_u64..).zip(names).filter_map(|(row, name)| Some((row, (*name)?)));
    let texts: Vec<_> =
        named.map(|(row, name)| ([row, name.node].map(|n| n.to_string()), name.axis)).collect();
    let rows = texts.iter().map(|([row, node], axis)| [row, node, axis.name()].map(Cell::Text));
    Ok(csv::write(&["row", "node", "direction"], rows)?)
}

/// The true factor over frequency: storage and loss_factor of a stiffness, factor_re and factor_im of anything else.
pub(crate) fn truth(model: &Model, frequency_hz: &[f64]) -> Result<String, Error> {
    let mut terms = model.parameter.members.iter().map(|member| &model.stiffness.terms()[member.term]);
    let is_modulus = terms.all(|term| term.role == Role::Stiffness);
    let mut rows = Vec::with_capacity(frequency_hz.len());
    for &f in frequency_hz {
        let factor = model.truth.at(f)?;
        let second = if is_modulus { loss_factor(factor) } else { factor.im };
        rows.push([f, factor.re, second].map(Cell::from));
    }
    let columns = if is_modulus { ["storage", "loss_factor"] } else { ["factor_re", "factor_im"] };
    Ok(csv::write(&["frequency_hz", columns[0], columns[1]], rows)?)
}

/// The true unknowns over frequency, in columns with the names that `identified.csv` has: `<name>.storage` and `<name>.loss_factor`, `<name>.value` of a
/// real one. What is constant is the same in every row.
pub(crate) fn several_truth(model: &SeveralModel, frequency_hz: &[f64]) -> Result<String, Error> {
    let mut columns = vec!["frequency_hz".to_owned()];
    for one in &model.unknowns {
        let parts: &[&str] = if one.real { &["value"] } else { &["storage", "loss_factor"] };
        columns.extend(parts.iter().map(|part| format!("{}.{part}", one.name)));
    }
    let mut rows = Vec::with_capacity(frequency_hz.len());
    for &f in frequency_hz {
        let mut row = vec![f];
        for (one, truth) in model.unknowns.iter().zip(&model.truth) {
            let value = truth.at(f)?;
            row.push(value.re);
            row.extend((!one.real).then(|| loss_factor(value)));
        }
        rows.push(row.into_iter().map(Cell::from).collect::<Vec<_>>());
    }
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    Ok(csv::write(&columns, rows)?)
}
