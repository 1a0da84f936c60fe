//! Combinations of parameters as a person names them.

use crate::load::Case;
use frfit::sensitivity::{Change, Inseparable, Resolved, Variable};

/// How near a ratio of coefficients must be to one to be called a sum, a ratio or a product: nearer than error bars of 30 % care for.
const NEAR: f64 = 0.05;

/// A standard deviation of a logarithm: `±0.21 %`, `±340 %`, `not at all` for none and where nothing but the sign of a number would be known.
pub(super) fn bar(std: Option<f64>) -> String {
    match std.map(|std| 100.0 * std) {
        Some(percent) if percent < 0.01 => format!("±{percent:.0e} %"),
        Some(percent) if percent < 10.0 => format!("±{percent:.2} %"),
        Some(percent) if percent < 1e5 => format!("±{percent:.0} %"),
        _ => "not at all".to_owned(),
    }
}

/// What of a group is seen and what is not.
pub(super) fn inseparable(
    case: &Case,
    variables: &[Variable],
    resolved: &Resolved,
    group: &Inseparable,
) -> String {
    let names: Vec<&str> = group.variables.iter().map(|&p| variables[p].name.as_str()).collect();
    let listed = names.join(", ");
    match (group.variables.as_slice(), group.unknown) {
        ([_], _) => match bar(group.std) {
            unseen if group.std.is_none() => format!("{listed}: {unseen}"),
            bar => format!("{listed}: only to {bar}"),
        },
        (&[a, b], 1) => format!("{listed}: {}", pair(case, variables, resolved, group, [a, b])),
        (all, unknown) if unknown >= all.len() => format!("{listed}: none of them is seen"),
        (_, 1) if group.direction.iter().all(|d| (d - 1.0).abs() < NEAR) => {
            format!("{listed}: a common factor of all of them is not seen ({})", bar(group.std))
        }
        (_, 1) => {
            format!("{listed}: {} is not seen ({})", monomial(&names, &group.direction), bar(group.std))
        }
        (all, unknown) => {
            let seen = all.len() - unknown;
            let word = if seen == 1 { "combination" } else { "combinations" };
            format!("{listed}: only {seen} {word} of the {} are seen", all.len())
        }
    }
}

fn pair(
    case: &Case,
    variables: &[Variable],
    resolved: &Resolved,
    group: &Inseparable,
    [a, b]: [usize; 2],
) -> String {
    let (da, db) = (group.direction[0], group.direction[1]);
    let of = |ca: f64, cb: f64| {
        let mut combination = vec![0.0; variables.len()];
        (combination[a], combination[b]) = (ca, cb);
        bar(resolved.std(&combination))
    };
    if let (Some(va), Some(vb)) = (addend(case, &variables[a]), addend(case, &variables[b]))
        && va.0 == vb.0
        && (va.1 * da / (vb.1 * db) + 1.0).abs() < NEAR
    {
        let sum = va.1 + vb.1;
        return format!("only their sum is seen ({}), not their difference", of(va.1 / sum, vb.1 / sum));
    }
    match da / db {
        ratio if (ratio - 1.0).abs() < NEAR => {
            format!("only their ratio is seen: {}; their product {}", of(1.0, -1.0), of(1.0, 1.0))
        }
        ratio if (ratio + 1.0).abs() < NEAR => {
            format!("only their product is seen: {}; their ratio {}", of(1.0, 1.0), of(1.0, -1.0))
        }
        _ => {
            // At right angles to what is not seen.
            let largest = if da.abs() > db.abs() { da } else { -db };
            let (ca, cb) = (-db / largest, da / largest);
            let names = [variables[a].name.as_str(), variables[b].name.as_str()];
            format!("only {} is seen: {}", monomial(&names, &[ca, cb]), of(ca, cb))
        }
    }
}

/// Role and value of what adds up with others of its role: the constant real factor of one matrix.
fn addend(case: &Case, variable: &Variable) -> Option<(frfit::model::Role, f64)> {
    let Change::Factor(members) = &variable.change else { return None };
    let [member] = members.as_slice() else { return None };
    let term = &case.model.terms()[member.term];
    match term.factor {
        frfit::material::Law::Constant(value) if value.re != 0.0 => Some((term.role, value.re)),
        _ => None,
    }
}

/// `a^1.00 · b^-0.50`, without what hardly matters.
pub(super) fn monomial(names: &[&str], exponents: &[f64]) -> String {
    let shown = names.iter().zip(exponents).filter(|(_, e)| e.abs() >= NEAR);
    let factor = |(name, e): (&&str, &f64)| match *e == 1.0 {
        true => format!("({name})"),
        false => format!("({name})^{e:.2}"),
    };
    shown.map(factor).collect::<Vec<_>>().join(" · ")
}
