//! What is on the structure besides the model: accelerometers, a hammer's tip, a suspension.

use super::dofs::Dofs;
use crate::case::{AttachedEntry, Spot};
use crate::error::InputError;
use crate::units::{Amount, UnitSystem};
use frfit::c64;
use frfit::dof::Axis;
use frfit::material::Law;
use frfit::model::{Role, Term};
use frfit_linalg::sparse::Triplets;

/// One term of the model for each number of an entry: a matrix of its own, with entries on the diagonal only.
///
/// A point mass m at a node adds −ω²m in each of its translations, a spring k and a damper d to ground add k and iωd at one degree of freedom; the sense
/// of that degree of freedom does not matter.
///
/// # Limits
/// No rotary inertia, nor that of a mass which sits off its node.
pub(super) fn terms(
    entries: &[AttachedEntry],
    units: UnitSystem,
    dim: usize,
    dofs: &Dofs,
) -> Result<Vec<Term>, InputError> {
    let mut terms = Vec::new();
    for (k, entry) in entries.iter().enumerate() {
        let (sensor, label) = dofs.find(&entry.spot)?;
        let mut add = |word: &str, role, rows: &[usize], value: f64| {
            let mut triplets = Triplets::new(dim);
            rows.iter().for_each(|&row| triplets.add(row, row, value));
            let name = format!("attached {} ({word} at {label})", k + 1);
            terms.push(Term {
                name,
                role,
                matrix: triplets.assemble(),
                factor: Law::Constant(c64::new(1.0, 0.0)),
            });
        };
        if let Some(mass) = entry.mass {
            add("mass", Role::Mass, &moving(entry, sensor.row, dofs)?, mass.entry(units, Role::Mass));
        }
        let single = [
            ("stiffness", Role::Stiffness, entry.stiffness, "N/m, of a rotation N m/rad"),
            ("damping", Role::Viscous, entry.damping, "N s/m, of a rotation N m s/rad"),
        ];
        for (word, role, amount, expected) in single {
            let Some(amount) = amount else { continue };
            // A row without a name can be either.
            let turns = dofs.is_rotation(sensor.row);
            if let (Amount::Si { rotational, .. }, Some(turns)) = (amount, turns)
                && rotational != turns
            {
                let found = format!("the unit of {}", if turns { "a translation" } else { "a rotation" });
                let place = entry.place.below(word);
                return Err(InputError::at(&place, format!("a unit as that of {expected}"), found));
            }
            add(word, role, &[sensor.row], amount.entry(units, role));
        }
    }
    Ok(terms)
}

/// The rows in which a mass moves.
fn moving(entry: &AttachedEntry, row: usize, dofs: &Dofs) -> Result<Vec<usize>, InputError> {
    let Spot::Dof(name) = &entry.spot else { return Ok(vec![row]) };
    let axes = dofs.axes(name)?;
    let translations = [Axis::X, Axis::Y, Axis::Z];
    let Some(directions) = &entry.directions else {
        let rows: Vec<usize> =
            axes.iter().filter(|(axis, _)| translations.contains(axis)).map(|&(_, row)| row).collect();
        return match rows.is_empty() {
            true => {
                let expected = "a node with a translation, for a mass";
                Err(InputError::at(&name.place, expected, format!("{} with rotations only", name.value.node)))
            }
            false => Ok(rows),
        };
    };
    let row_of =
        |direction: &crate::case::Located<Axis>| match axes.iter().find(|(axis, _)| *axis == direction.value)
        {
            Some(&(_, row)) => Ok(row),
            None => {
                let has = axes.iter().map(|(axis, _)| axis.name()).collect::<Vec<_>>().join(", ");
                let expected = format!("a direction that [dofs] names at node {} ({has})", name.value.node);
                Err(InputError::at(&direction.place, expected, direction.value.name()))
            }
        };
    directions.iter().map(row_of).collect()
}
