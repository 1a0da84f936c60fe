//! A law as a case file has it.

use frfit::laws::{LawKind, Parameter, ParameterKind};
use frfit::material::Law;

/// The law as a case file has it: `factor = { … }`.
pub fn snippet(law: &Law) -> String {
    let keys = law_keys(law);
    // No fit ends in a table.
    if keys.is_empty() { String::new() } else { format!("factor = {{ {} }}", keys.join(", ")) }
}

/// The keys of the law in `factor = { … }`, each as `key = value` with all digits; none of a table, which has a file.
pub fn law_keys(law: &Law) -> Vec<String> {
    let Some((kind, p)) = LawKind::of(law) else { return Vec::new() };
    let written = |(parameter, value): (Parameter, &f64)| match parameter.kind {
        ParameterKind::Exponent => format!("{} = {value}", parameter.name),
        _ => format!("{} = {value:e}", parameter.name),
    };
    let mut keys = Vec::new();
    if kind != LawKind::Constant {
        keys.push(format!("law = {:?}", kind.word()));
    }
    if let LawKind::Maxwell { .. } = kind {
        let branches: Vec<String> =
            p[1..].chunks_exact(2).map(|branch| format!("[{:e}, {:e}]", branch[0], branch[1])).collect();
        keys.extend([format!("e0 = {:e}", p[0]), format!("branches = [{}]", branches.join(", "))]);
    } else {
        keys.extend(kind.parameters().into_iter().zip(&p).map(written));
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use frfit::material::Branch;

    #[test]
    fn snippets_read_back_to_the_last_bit() {
        let laws = [
            Law::Fractional { e0: 814_000.1, e1: 7.31e4 / 3.0, alpha: 0.528 },
            Law::FractionalZener { e0: 1.0 / 3.0, e_infinity: 2e9, tau_s: 8.23e-9, alpha: 1.0 / 7.0 },
            Law::Maxwell {
                e0: 1e6,
                branches: vec![
                    Branch { modulus: 2e6 / 3.0, tau_s: 1e-4 },
                    Branch { modulus: 5.0, tau_s: 0.1 },
                ],
            },
        ];
        for law in laws {
            let case = format!(
                "[[matrix]]\nname = \"K\"\nrole = \"stiffness\"\nfile = \"K.mtx\"\n{}\n[load]\nrow = 1\n[[measurement]]\nrow = 1\n",
                snippet(&law)
            );
            let case = crate::case::parse(std::path::Path::new("case.toml"), case.as_bytes()).unwrap();
            assert_eq!(case.matrices[0].factor.value, crate::case::FactorEntry::Law(law));
        }
    }
}
