//! Fitted laws: for programs, for people, and for the next case file.

use crate::case::snippet;
use crate::units::{FactorUnit, UnitSystem};
use frfit::identify::SmoothCurve;
use frfit::laws::{Correlated, Estimate, LawFit, best};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What a law leaves unexplained of the moduli it was fitted to, relative to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// The largest.
    pub worst: f64,
    /// The median.
    pub median: f64,
}

impl Misfit {
    /// Of some relative misfits, at least one.
    pub fn of(mut relative: Vec<f64>) -> Option<Self> {
        relative.sort_by(f64::total_cmp);
        Some(Self { worst: *relative.last()?, median: relative[relative.len() / 2] })
    }
}

/// One fitted law of a factor.
pub fn law_json(fit: &LawFit, of: FactorUnit) -> Value {
    let number = |value: f64| if value.is_finite() { json!(value) } else { Value::Null };
    let parameters: Map<String, Value> = (fit.parameters.iter())
        .map(|Estimate { name, unit, value, std }| {
            (name.clone(), json!({"value": number(*value), "std": std, "unit": of.of_parameter(unit)}))
        })
        .collect();
    let widened: Option<Map<String, Value>> = fit.correlated.as_ref().map(|correlated| {
        fit.parameters.iter().zip(&correlated.widened).map(|(p, by)| (p.name.clone(), json!(by))).collect()
    });
    json!({
        "law": fit.kind.to_string(),
        "parameters": parameters,
        "correlation": fit.correlation,
        "chi_squared": fit.chi_squared,
        "residuals": fit.residuals,
        "degrees_of_freedom": fit.degrees_of_freedom(),
        "chi_squared_per_degree_of_freedom": fit.reduced_chi_squared(),
        "sigma_known": fit.sigma_known,
        "bic": number(fit.bic()),
        "aic": number(fit.aic()),
        "converged": fit.converged,
        "residuals_say": residuals_say(fit),
        "correlated_lines": fit.correlated.as_ref().map(|correlated| correlated.lines),
        "correlated_size": fit.correlated.as_ref().map(|correlated| correlated.size),
        "widened": widened,
        "starts": fit.starts,
        "starts_agreeing": fit.agreeing,
        "factor": snippet(&fit.law),
    })
}

/// How smooth a modulus turned out to be.
pub fn smooth_json(curve: &SmoothCurve) -> Value {
    json!({
        "parameters": curve.parameters, "width_octaves": curve.width_octaves,
        "converged": curve.converged, "outliers": curve.outliers,
    })
}

/// What the law leaves, in words.
fn residuals_say(fit: &LawFit) -> String {
    match &fit.correlated {
        Some(Correlated { lines, size, .. }) => format!(
            "residuals correlated over {lines:.0} lines, {size:.1e} of the modulus: the standard deviations are wider for it"
        ),
        None => "residuals not correlated".into(),
    }
}

/// The laws of a band: `law.json`, and `laws` in `summary.json`.
pub fn laws_json(laws: &[LawFit], of: FactorUnit, units: UnitSystem) -> Value {
    json!({
        "units": units.json(),
        "factor_unit": of.word(),
        "criterion": "bic",
        "best": best(laws).map(|fit| fit.kind.to_string()),
        "laws": laws.iter().map(|fit| law_json(fit, of)).collect::<Vec<_>>(),
    })
}

/// The laws, best first: what they leave, by how much each is behind the best, and their parameters. `misfits` are those of the fits.
pub fn laws_text(fits: &[LawFit], misfits: &[Option<Misfit>], of: FactorUnit) -> String {
    let mut text = String::new();
    let Some(chosen) = best(fits) else { return text };
    let mut order: Vec<usize> = (0..fits.len()).collect();
    order.sort_by(|&a, &b| {
        fits[b].converged.cmp(&fits[a].converged).then(fits[a].bic().total_cmp(&fits[b].bic()))
    });
    let quality = if chosen.sigma_known { "chi2/dof" } else { "scatter" };
    // Writing to a string does not fail.
    let _ = writeln!(
        text,
        "  {:<12}{:>10}  {quality:>9}  {:>8}  {:>8}  starts",
        "law", "BIC - best", "worst", "median"
    );
    for k in order {
        let fit = &fits[k];
        let left = match (fit.reduced_chi_squared(), fit.sigma_known) {
            (Some(chi), true) => short(chi, 3),
            (Some(chi), false) => format!("{:.2e}", chi.sqrt()),
            (None, _) => String::new(),
        };
        let [worst, median] = match misfits[k] {
            Some(Misfit { worst, median }) => [worst, median].map(|m| format!("{m:.1e}")),
            None => [String::new(), String::new()],
        };
        let note = if fit.converged { "" } else { ", not settled" };
        let (behind, law) = (fit.bic() - chosen.bic(), fit.kind.to_string());
        let _ = writeln!(
            text,
            "  {law:<12}{:>10}  {left:>9}  {worst:>8}  {median:>8}  {} of {} agree{note}",
            short(behind, 1),
            fit.agreeing,
            fit.starts
        );
    }
    if !chosen.converged {
        let _ = writeln!(
            text,
            "  the search for {} did not converge: other parameters fit the data about as well; take a law with fewer parameters, or varies = \"smooth\"",
            chosen.kind
        );
    }
    if chosen.sigma_known && chosen.reduced_chi_squared().is_some_and(|chi| chi > LARGE_CHI_SQUARED) {
        text += "  no law explains the data within their standard deviations: those hold noise only, and so do the parameters'\n";
    }
    let _ = writeln!(text, "  {}", chosen.kind);
    for parameter in &chosen.parameters {
        let _ = writeln!(text, "    {:<12}{}", parameter.name, with_std(parameter, of));
    }
    if chosen.correlated.is_some() {
        let _ = writeln!(text, "  {}", residuals_say(chosen));
    }
    let _ = writeln!(text, "  {}", snippet(&chosen.law));
    text
}

/// χ² per degree of freedom above this is no noise, however few data there are: five standard deviations a number.
const LARGE_CHI_SQUARED: f64 = 25.0;

/// So many digits behind the point, or a power of ten where there are many before it.
fn short(value: f64, digits: usize) -> String {
    if value < 1e6 { format!("{value:.digits$}") } else { format!("{value:.1e}") }
}

/// Value ± standard deviation and unit.
fn with_std(Estimate { value, std, unit, .. }: &Estimate, of: FactorUnit) -> String {
    let unit = of.of_parameter(unit);
    let std = std.map_or("not identifiable".into(), |std| format!("{std:.1e}"));
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{value:.6e} ± {std}{unit}")
}
