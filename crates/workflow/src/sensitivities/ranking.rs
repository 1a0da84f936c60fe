//! Parameters by the size of their sensitivities.

use frfit::sensitivity::SensitivityBand;

/// How much the response depends on one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranking {
    /// Which.
    pub variable: usize,
    /// Root mean square of |∂ln x/∂ln p| over frequencies and sensors; `None` where there is no answer at all.
    pub rms: Option<f64>,
    /// The largest |∂ln x/∂ln p|.
    pub largest: Option<Largest>,
}

/// A largest value and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// |∂ln x/∂ln p|.
    pub value: f64,
    /// At this frequency.
    pub frequency_hz: f64,
    /// At this sensor.
    pub sensor: usize,
}

/// All variables, those that matter most first.
pub(super) fn ranking(band: &SensitivityBand<'_>, sensors: usize) -> Vec<Ranking> {
    let one = |variable: usize| {
        let (mut squares, mut count, mut largest) = (0.0, 0usize, None::<Largest>);
        for (i, &frequency_hz) in band.frequency_hz().iter().enumerate() {
            for sensor in 0..sensors {
                let Some((value, _)) = band.logarithmic(i, variable, sensor) else { continue };
                let value = value.norm();
                squares += value * value;
                count += 1;
                if largest.is_none_or(|largest| value > largest.value) {
                    largest = Some(Largest { value, frequency_hz, sensor });
                }
            }
        }
        Ranking { variable, rms: (count > 0).then(|| (squares / count as f64).sqrt()), largest }
    };
    let mut all: Vec<Ranking> = (0..band.variables().len()).map(one).collect();
    // Stable: equals stay in the order of the case.
    all.sort_by(|a, b| b.rms.unwrap_or(0.0).total_cmp(&a.rms.unwrap_or(0.0)));
    all
}
