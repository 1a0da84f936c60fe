//! Where an axis is marked, and with what words.

use crate::Scale;
use crate::scale::Map;

/// A labelled tick.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

/// The ticks of an axis; true values are labels × 10^`exponent`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ticks {
    pub(crate) major: Vec<Tick>,
    pub(crate) minor: Vec<f64>,
    pub(crate) exponent: i32,
}

/// The finest ticks whose labels do not touch; `extent` is the room a label takes along the axis.
pub(crate) fn ticks(map: &Map, extent: &impl Fn(&str) -> f64) -> Ticks {
    match map.scale {
        Scale::Linear => linear(map, i32::MIN, extent),
        Scale::Whole => linear(map, 0, extent),
        Scale::Log => logarithmic(map, extent),
    }
}

/// A tick with its name at each value, or at every second, third … where names would touch.
pub(crate) fn names(map: &Map, values: &[f64], names: &[String], extent: &impl Fn(&str) -> f64) -> Ticks {
    let tick = |(&value, label): (&f64, &String)| Tick { value, label: label.clone() };
    let mut all: Vec<Tick> =
        values.iter().zip(names).map(tick).filter(|tick| map.place(tick.value).is_some()).collect();
    all.sort_by(|a, b| a.value.total_cmp(&b.value));
    let every = |k: usize| Ticks { major: all.iter().step_by(k).cloned().collect(), ..Ticks::default() };
    (1..all.len()).map(every).find(|ticks| ticks.fit(map, extent)).unwrap_or_else(|| every(all.len().max(1)))
}

impl Ticks {
    /// The multiplier all labels share, as text; empty for 1.
    pub(crate) fn multiplier(&self) -> String {
        if self.exponent == 0 { String::new() } else { format!("×{}", power_of_ten(self.exponent)) }
    }

    /// Whether every label has its room.
    fn fit(&self, map: &Map, extent: &impl Fn(&str) -> f64) -> bool {
        let room = |t: &Tick| Some((map.place(t.value)?, extent(&t.label)));
        let rooms: Vec<(f64, f64)> = self.major.iter().filter_map(room).collect();
        rooms.windows(2).all(|w| (w[1].0 - w[0].0).abs() >= 0.5 * (w[0].1 + w[1].1))
    }
}

/// Ticks at the multiples of 1, 2 or 5 × 10^p with p ≥ `least_power`.
fn linear(map: &Map, least_power: i32, extent: &impl Fn(&str) -> f64) -> Ticks {
    let (lo, hi) = map.range;
    let most = (map.length() / 10.0).clamp(2.0, 100.0);
    let first_power = (((hi - lo) / most).log10().floor() as i32).max(least_power);
    let steps = (first_power..).flat_map(|power| [1i64, 2, 5].map(|m| (m, power)));
    let mut best = Ticks::default();
    for (m, power) in steps {
        let step = m as f64 * 10f64.powi(power);
        // consecutive steps differ by at most 2.5, so one beyond the span, with a single tick, was tried
        if step > 3.0 * (hi - lo) {
            break;
        }
        best = multiples(lo, hi, m, power);
        if best.fit(map, extent) {
            break;
        }
    }
    best
}

/// The multiples of m·10^power in [lo, hi], labelled in engineering notation where plain digits would be many.
fn multiples(lo: f64, hi: f64, m: i64, power: i32) -> Ticks {
    let exponent = shared_exponent((lo, hi));
    let decimals = usize::try_from(exponent - power).unwrap_or(0);
    let step = m as f64 * 10f64.powi(power);
    // a thousandth of a step: an end that is a multiple but for rounding keeps its tick
    let (first, last) = ((lo / step - 1e-3).ceil() as i64, (hi / step + 1e-3).floor() as i64);
    let tick = |k: i64| Tick {
        value: k as f64 * step,
        label: signed(format!("{:.decimals$}", (k * m) as f64 * 10f64.powi(power - exponent))),
    };
    Ticks { major: (first..=last).map(tick).collect(), minor: Vec::new(), exponent }
}

/// The power of 1000 by which a linear axis divides its labels.
pub(crate) fn shared_exponent((lo, hi): (f64, f64)) -> i32 {
    let magnitude = lo.abs().max(hi.abs()).log10().floor() as i32;
    if (-3..5).contains(&magnitude) { 0 } else { magnitude.div_euclid(3) * 3 }
}

/// Ticks at powers of ten; if these are fewer than three at multiples of them, and within a narrow range as on
/// a linear axis.
fn logarithmic(map: &Map, extent: &impl Fn(&str) -> f64) -> Ticks {
    let (lo, hi) = (map.range.0.log10(), map.range.1.log10());
    let (first, last) = ((lo - 1e-6).ceil() as i32, (hi + 1e-6).floor() as i32);
    if last - first < 2 {
        let digits: [&[i32]; 2] = [&[1, 2, 3, 4, 5, 6, 7, 8, 9], &[1, 2, 5]];
        // nine labels a decade are for the case where three would not do
        let candidates = digits.iter().skip(usize::from(hi - lo > 0.8)).map(|d| mantissas(map, d));
        if let Some(ticks) = candidates.into_iter().find(|t| t.major.len() > 1 && t.fit(map, extent)) {
            return ticks;
        }
    }
    if last <= first {
        return linear(map, i32::MIN, extent);
    }
    let decades = |stride: i32| -> Vec<Tick> {
        let tick = |k| Tick { value: 10f64.powi(k), label: power_of_ten(k) };
        (first..=last).filter(|k| k % stride == 0).map(tick).collect()
    };
    let strides = [1, 2, 3, 5, 10, 20, 50, 100, 200, 500];
    let with = |stride| Ticks { major: decades(stride), ..Ticks::default() };
    let stride = strides.into_iter().find(|&s| with(s).fit(map, extent)).unwrap_or(500);
    Ticks { minor: if stride == 1 { parts(map) } else { values_in(map, &[1]) }, ..with(stride) }
}

/// The ninths of decades, where there is room for them.
fn parts(map: &Map) -> Vec<f64> {
    let decades = (map.range.1 / map.range.0).log10();
    if map.length() / decades < 30.0 { Vec::new() } else { values_in(map, &[2, 3, 4, 5, 6, 7, 8, 9]) }
}

/// Ticks at `digits` × 10ⁿ within the range.
fn mantissas(map: &Map, digits: &[i32]) -> Ticks {
    let label = |v: f64| {
        let power = v.log10().floor() as i32;
        let digit = (v / 10f64.powi(power)).round();
        match power {
            -3..0 => format!("{v:.*}", power.unsigned_abs() as usize),
            0..5 => format!("{v:.0}"),
            _ => format!("{digit}×{}", power_of_ten(power)),
        }
    };
    let major = values_in(map, digits).into_iter().map(|value| Tick { value, label: label(value) }).collect();
    Ticks { major, minor: parts(map), exponent: 0 }
}

/// All `digits` × 10ⁿ within the range.
fn values_in(map: &Map, digits: &[i32]) -> Vec<f64> {
    let (lo, hi) = map.range;
    let powers = lo.log10().floor() as i32..=hi.log10().ceil() as i32;
    powers
        .flat_map(|k| digits.iter().map(move |&d| f64::from(d) * 10f64.powi(k)))
        .filter(|v| (lo * (1.0 - 1e-6)..=hi * (1.0 + 1e-6)).contains(v))
        .collect()
}

/// `10ⁿ`.
fn power_of_ten(n: i32) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '0'..='9' => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c as usize - '0' as usize],
        other => other,
    };
    std::iter::once("10".to_owned()).chain(n.to_string().chars().map(|c| raised(c).to_string())).collect()
}

/// The number with a true minus sign, and none on zero.
fn signed(number: String) -> String {
    match number.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => number,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Labels of an axis 400 long on which each label takes 40.
    fn labels(scale: Scale, lo: f64, hi: f64) -> (Vec<String>, String) {
        let map = Map { scale, range: (lo, hi), page: (0.0, 400.0) };
        let ticks = ticks(&map, &|_: &str| 40.0);
        (ticks.major.iter().map(|t| t.label.clone()).collect(), ticks.multiplier())
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(Scale::Linear, 0.0, 1.0).0, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, -3.0, 3.0).0, ["−3", "−2", "−1", "0", "1", "2", "3"]);
        assert_eq!(
            labels(Scale::Linear, 195.0, 1557.0).0,
            ["200", "400", "600", "800", "1000", "1200", "1400"]
        );
    }

    #[test]
    fn large_and_small_numbers_share_a_multiplier() {
        let (got, multiplier) = labels(Scale::Linear, 1.0e6, 2.0e6);
        assert_eq!((got.first(), got.last()), (Some(&"1.0".into()), Some(&"2.0".into())));
        assert_eq!(multiplier, "×10⁶");
        let (got, multiplier) = labels(Scale::Linear, 0.0, 5e-5);
        assert_eq!((got.join(" ").as_str(), multiplier.as_str()), ("0 10 20 30 40 50", "×10⁻⁶"));
    }

    #[test]
    fn whole_numbers_have_no_fractions() {
        assert_eq!(labels(Scale::Whole, 0.5, 3.5).0, ["1", "2", "3"]);
        assert_eq!(labels(Scale::Whole, 0.5, 30.5).0, ["5", "10", "15", "20", "25", "30"]);
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten_with_nine_parts() {
        assert_eq!(labels(Scale::Log, 0.5, 2e3).0, ["10⁰", "10¹", "10²", "10³"]);
        assert_eq!(
            labels(Scale::Log, 1e-12, 1.0).0,
            ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]
        );
        let map = Map { scale: Scale::Log, range: (1.0, 100.0), page: (0.0, 400.0) };
        assert_eq!(ticks(&map, &|_: &str| 40.0).minor.len(), 16);
    }

    #[test]
    fn within_a_decade_logarithmic_ticks_are_multiples() {
        assert_eq!(labels(Scale::Log, 0.15, 2.5).0, ["0.2", "0.5", "1", "2"]);
        assert_eq!(labels(Scale::Log, 4.1, 4.7).0, ["4.1", "4.2", "4.3", "4.4", "4.5", "4.6", "4.7"]);
    }

    proptest! {
        #[test]
        fn labels_never_touch_and_ticks_stay_in_range(
            scale in prop_oneof![Just(Scale::Linear), Just(Scale::Whole), Just(Scale::Log)],
            lo in -240.0..240.0f64, ratio in 1e-3..400.0f64, length in 20.0..2000.0f64,
        ) {
            let range = (10f64.powf(lo), 10f64.powf((lo + ratio).min(249.0)));
            let map = Map { scale, range, page: (0.0, length) };
            let extent = |s: &str| 14.0 + 7.0 * s.chars().count() as f64;
            let got = ticks(&map, &extent);
            prop_assert!(got.fit(&map, &extent) , "{got:?}");
            for tick in &got.major {
                // ends that are multiples but for rounding count as inside, see `multiples`
                let place = map.place(tick.value).unwrap_or(f64::NAN);
                prop_assert!(place > -1.0 && place < length + 1.0, "{place} of {length}");
            }
            prop_assert!(got.major.len() + got.minor.len() < 1000);
        }
    }
}
