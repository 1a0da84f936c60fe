//! Combinations of parameters as a person names them.

use frfit::material::Law;
use frfit::model::{DynamicStiffness, Role};
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
    model: &DynamicStiffness,
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
        (&[a, b], 1) => format!("{listed}: {}", pair(model, variables, resolved, group, [a, b])),
        (all, unknown) if unknown >= all.len() => format!("{listed}: none of them is seen"),
        (_, 1) if group.direction.iter().all(|d| (d - 1.0).abs() < NEAR) => {
            format!("{listed}: a common factor of all of them is not seen ({})", bar(group.std))
        }
        (_, 1) => {
            format!("{listed}: {} is not seen ({})", monomial(&names, &group.direction), bar(group.std))
        }
        (all, unknown) => {
            let seen = all.len() - unknown;
            let words = if seen == 1 { "combination of them is" } else { "combinations of them are" };
            format!("{listed}: only {seen} {words} seen")
        }
    }
}

fn pair(
    model: &DynamicStiffness,
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
    if let (Some(va), Some(vb)) = (addend(model, &variables[a]), addend(model, &variables[b]))
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

/// Role and value of what adds up with others of its role: the constant factor of one matrix.
fn addend(model: &DynamicStiffness, variable: &Variable) -> Option<(Role, f64)> {
    let Change::Factor(terms) = &variable.change else { return None };
    let [term] = terms.as_slice() else { return None };
    let term = &model.terms()[*term];
    match term.factor {
        Law::Constant(value) if value.re != 0.0 => Some((term.role, value.re)),
        _ => None,
    }
}

/// `(a) · (b)^-0.50`, without what hardly matters.
pub(super) fn monomial(names: &[&str], exponents: &[f64]) -> String {
    let shown = names.iter().zip(exponents).filter(|(_, e)| e.abs() >= NEAR);
    let factor = |(name, e): (&&str, &f64)| match *e == 1.0 {
        true => format!("({name})"),
        false => format!("({name})^{e:.2}"),
    };
    shown.map(factor).collect::<Vec<_>>().join(" · ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use frfit::c64;
    use frfit::model::Term;
    use frfit::sensitivity;
    use frfit_linalg::sparse::Triplets;

    /// What is said of a Jacobian with these rows, of a stiffness of 200, another of 100, and a mass.
    fn said(rows: &[[f64; 3]]) -> Vec<String> {
        let mut one = Triplets::new(1);
        one.add(0, 0, 1.0);
        let matrix = one.assemble();
        let term = |(name, role, factor): (&str, Role, f64)| Term {
            name: name.to_owned(),
            role,
            matrix: matrix.clone(),
            factor: Law::Constant(c64::new(factor, 0.0)),
        };
        let terms = [("a", Role::Stiffness, 200.0), ("b", Role::Stiffness, 100.0), ("m", Role::Mass, 3.0)];
        let model = DynamicStiffness::new(terms.map(term).to_vec()).unwrap();
        let variables = Variable::of_model(&model, &[1.0]).unwrap();
        let columns: Vec<f64> = (0..3).flat_map(|p| rows.iter().map(move |row| row[p])).collect();
        let resolved = Resolved::new(&columns, 3, 0.0).unwrap();
        let groups = sensitivity::inseparable(&resolved);
        groups.iter().map(|group| inseparable(&model, &variables, &resolved, group)).collect()
    }

    #[test]
    fn pairs_have_the_word_for_what_is_seen() {
        // The sum of 200 and 100 weighs their logarithms two to one: known to 1/√(100² + 50²) over 3/2 of that length.
        let sum = said(&[[100.0, 50.0, 0.0], [0.0, 0.0, 100.0]]);
        assert_eq!(sum, ["a, b: only their sum is seen (±0.67 %), not their difference"]);
        let ratio = said(&[[100.0, 0.0, -100.0], [0.0, 100.0, 0.0], [1.0, 0.0, 1.0]]);
        assert_eq!(ratio, ["a, m: only their ratio is seen: ±1.00 %; their product ±100 %"]);
        let product = said(&[[0.0, 100.0, 100.0], [100.0, 0.0, 0.0]]);
        assert_eq!(product, ["b, m: only their product is seen: ±1.00 %; their ratio not at all"]);
        let power = said(&[[100.0, 0.0, -50.0], [0.0, 100.0, 0.0]]);
        assert_eq!(power, ["a, m: only (a) · (m)^-0.50 is seen: ±1.00 %"]);
    }

    #[test]
    fn single_ones_and_many() {
        assert!(said(&[[100.0, 0.0, 0.0], [0.0, 100.0, 0.0], [0.0, 0.0, 100.0]]).is_empty());
        let alone = said(&[[100.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
        assert_eq!(alone, ["b: only to ±50 %", "m: not at all"]);
        let common = said(&[[100.0, -100.0, 0.0], [0.0, 100.0, -100.0]]);
        assert_eq!(common, ["a, b, m: a common factor of all of them is not seen (not at all)"]);
        let two_of_three = said(&[[60.0, 100.0, 80.0]]);
        assert_eq!(two_of_three, ["a, b, m: only 1 combination of them is seen"]);
    }
}
