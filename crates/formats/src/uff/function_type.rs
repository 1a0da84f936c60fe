//! What kind of function a dataset 58 holds.

/// Function type (dataset 58, record 6, field 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FunctionType {
    /// 0
    #[default]
    General,
    /// 1
    TimeResponse,
    /// 2
    AutoSpectrum,
    /// 3
    CrossSpectrum,
    /// 4
    FrequencyResponse,
    /// 5
    Transmissibility,
    /// 6
    Coherence,
    /// 7
    AutoCorrelation,
    /// 8
    CrossCorrelation,
    /// 9
    PowerSpectralDensity,
    /// 10
    EnergySpectralDensity,
    /// 11
    ProbabilityDensity,
    /// 12
    Spectrum,
    /// 13
    CumulativeFrequencyDistribution,
    /// 14
    PeaksValley,
    /// 15
    StressCycles,
    /// 16
    StrainCycles,
    /// 17
    Orbit,
    /// 18
    ModeIndicator,
    /// 19
    ForcePattern,
    /// 20
    PartialPower,
    /// 21
    PartialCoherence,
    /// 22
    Eigenvalue,
    /// 23
    Eigenvector,
    /// 24
    ShockResponseSpectrum,
    /// 25
    FiniteImpulseResponse,
    /// 26
    MultipleCoherence,
    /// 27
    Order,
    /// A number that the format document does not name. One that it names is read as its own variant.
    Other(i32),
}

/// Every named type at the place of its number, and what it is called.
const NAMED: [(FunctionType, &str); 28] = [
    (FunctionType::General, "general or unknown"),
    (FunctionType::TimeResponse, "time response"),
    (FunctionType::AutoSpectrum, "auto spectrum"),
    (FunctionType::CrossSpectrum, "cross spectrum"),
    (FunctionType::FrequencyResponse, "frequency response function"),
    (FunctionType::Transmissibility, "transmissibility"),
    (FunctionType::Coherence, "coherence"),
    (FunctionType::AutoCorrelation, "auto correlation"),
    (FunctionType::CrossCorrelation, "cross correlation"),
    (FunctionType::PowerSpectralDensity, "power spectral density"),
    (FunctionType::EnergySpectralDensity, "energy spectral density"),
    (FunctionType::ProbabilityDensity, "probability density"),
    (FunctionType::Spectrum, "spectrum"),
    (FunctionType::CumulativeFrequencyDistribution, "cumulative frequency distribution"),
    (FunctionType::PeaksValley, "peaks valley"),
    (FunctionType::StressCycles, "stress/cycles"),
    (FunctionType::StrainCycles, "strain/cycles"),
    (FunctionType::Orbit, "orbit"),
    (FunctionType::ModeIndicator, "mode indicator function"),
    (FunctionType::ForcePattern, "force pattern"),
    (FunctionType::PartialPower, "partial power"),
    (FunctionType::PartialCoherence, "partial coherence"),
    (FunctionType::Eigenvalue, "eigenvalue"),
    (FunctionType::Eigenvector, "eigenvector"),
    (FunctionType::ShockResponseSpectrum, "shock response spectrum"),
    (FunctionType::FiniteImpulseResponse, "finite impulse response filter"),
    (FunctionType::MultipleCoherence, "multiple coherence"),
    (FunctionType::Order, "order function"),
];

impl FunctionType {
    /// The type with this number.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        let named = usize::try_from(number).ok().and_then(|k| NAMED.get(k));
        named.map_or(Self::Other(number), |(kind, _)| *kind)
    }

    /// The number that stands for it in a file.
    #[must_use]
    pub fn number(self) -> i32 {
        match self {
            Self::Other(number) => number,
            named => NAMED.iter().zip(0..).find(|((kind, _), _)| *kind == named).map_or(0, |(_, k)| k),
        }
    }

    /// Its name in plain words.
    #[must_use]
    pub fn name(self) -> &'static str {
        NAMED.iter().find(|(kind, _)| *kind == self).map_or("unnamed type", |(_, name)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_and_type_are_one_to_one() {
        for number in -2..40 {
            assert_eq!(FunctionType::from_number(number).number(), number);
        }
        assert_eq!(FunctionType::from_number(4), FunctionType::FrequencyResponse);
        assert_eq!(FunctionType::from_number(9).name(), "power spectral density");
        assert_eq!(FunctionType::from_number(27), FunctionType::Order);
        assert_eq!(FunctionType::from_number(28), FunctionType::Other(28));
    }
}
