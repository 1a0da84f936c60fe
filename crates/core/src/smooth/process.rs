//! The smoother at a given curvature: an integrated Wiener process behind scattered observations, exactly and in one sweep up and one down.

/// So many standard deviations of the best straight line is what the first state may be anywhere within: the process is then the smoothing spline, which asks nothing of level and slope,
/// but for the inverse of its square, 1e-10. Its square is also what roundoff is multiplied by while nothing has been observed yet: 1e-6 in the bars.
const DIFFUSE_STD: f64 = 1e5;

/// A place on the curve, and what was observed there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observation {
    /// Abscissa; ascending from one to the next.
    pub(crate) x: f64,
    /// What was observed: one number or two, each with the same weight.
    pub(crate) value: [f64; 2],
    /// Inverse of the variance; zero where nothing was observed.
    pub(crate) weight: f64,
}

/// A curve at the places of the observations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curve {
    /// Value and slope.
    pub(crate) states: Vec<State>,
    /// Posterior variance of each value.
    pub(crate) variance: Vec<f64>,
}

/// Value and slope, of both numbers.
pub(crate) type State = [[f64; 2]; 2];

/// What the observations say of a curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Likelihood {
    /// ln of the determinant of the observations' covariance times their weights, of one number.
    pub(crate) log_determinant: f64,
    /// Σ e²/F of the innovations, of both numbers.
    pub(crate) squares: f64,
}

/// A lower triangle S with S Sᵀ the covariance of a state: (s₁₁, s₂₁, s₂₂).
type Root = [f64; 3];

/// The best straight line: where everything begins.
#[derive(Debug, Clone, Copy)]
struct Line {
    middle: f64,
    level: [f64; 2],
    slope: [f64; 2],
    level_std: f64,
    slope_std: f64,
}

/// Observations that determine a line, and the line.
#[derive(Debug, Clone)]
pub(crate) struct Process<'o> {
    observations: &'o [Observation],
    line: Line,
}

struct Filtered {
    predicted: (State, Root),
    updated: (State, Root),
}

impl<'o> Process<'o> {
    /// `None` with fewer than two observations that have a weight.
    pub(crate) fn new(observations: &'o [Observation]) -> Option<Self> {
        let sum = |part: &dyn Fn(&Observation) -> f64| -> f64 {
            observations.iter().filter(|o| o.weight > 0.0).map(|o| o.weight * part(o)).sum()
        };
        let weight = sum(&|_| 1.0);
        let middle = sum(&|o| o.x) / weight;
        let spread = sum(&|o| (o.x - middle).powi(2));
        let is_determined = [weight, spread].iter().all(|value| value.is_finite() && *value > 0.0);
        let level = [0, 1].map(|c| sum(&|o| o.value[c]) / weight);
        let slope = [0, 1].map(|c| sum(&|o| (o.x - middle) * (o.value[c] - level[c])) / spread);
        let (level_std, slope_std) = (weight.powf(-0.5), spread.powf(-0.5));
        is_determined
            .then_some(Self { observations, line: Line { middle, level, slope, level_std, slope_std } })
    }

    /// Variances of level and slope of the best straight line.
    pub(crate) fn line_variance(&self) -> (f64, f64) {
        (self.line.level_std.powi(2), self.line.slope_std.powi(2))
    }

    fn first(&self) -> (State, Root) {
        let Line { middle, level, slope, level_std, slope_std } = self.line;
        let x = self.observations[0].x;
        let value = [0, 1].map(|c| level[c] + slope[c] * (x - middle));
        let far = level_std.hypot(slope_std * (x - middle));
        ([value, slope], [DIFFUSE_STD * far, 0.0, DIFFUSE_STD * slope_std])
    }

    fn filter(&self, curvature: f64, mut keep: impl FnMut(Filtered)) -> Likelihood {
        let mut likelihood = Likelihood { log_determinant: 0.0, squares: 0.0 };
        let (mut state, mut root) = self.first();
        for (k, o) in self.observations.iter().enumerate() {
            if k > 0 {
                (state, root) = predict(state, root, o.x - self.observations[k - 1].x, curvature);
            }
            let predicted = (state, root);
            if o.weight > 0.0 {
                let [s11, s21, s22] = root;
                let grown = 1.0 + o.weight * s11 * s11;
                let innovation = [0, 1].map(|c| o.value[c] - state[0][c]);
                let square: f64 = innovation.iter().map(|e| e * e).sum();
                likelihood.squares += square * o.weight / grown;
                let gain = innovation.map(|e| e * o.weight * s11 / grown);
                state = [
                    [0, 1].map(|c| state[0][c] + s11 * gain[c]),
                    [0, 1].map(|c| state[1][c] + s21 * gain[c]),
                ];
                likelihood.log_determinant += grown.ln();
                let shrunk = grown.sqrt();
                root = [s11 / shrunk, s21 / shrunk, s22];
            }
            keep(Filtered { predicted, updated: (state, root) });
        }
        likelihood
    }

    /// How likely the observations are under a curvature, up to a constant.
    pub(crate) fn likelihood(&self, curvature: f64) -> Likelihood {
        self.filter(curvature, |_| {})
    }

    /// The curve that is the mean of the process given all observations, with its variance.
    pub(crate) fn smooth(&self, curvature: f64) -> Curve {
        let mut steps: Vec<Filtered> = Vec::with_capacity(self.observations.len());
        self.filter(curvature, |step| steps.push(step));
        let n = steps.len();
        let (mut state, mut root) = steps[n - 1].updated;
        let mut curve = Curve { states: vec![state; n], variance: vec![root[0] * root[0]; n] };
        for k in (0..n - 1).rev() {
            let h = self.observations[k + 1].x - self.observations[k].x;
            let (own, p) = steps[k].updated;
            let (ahead, q) = steps[k + 1].predicted;
            let gain = gain(p, q, h);
            let times =
                |v: [f64; 2]| [gain[0][0] * v[0] + gain[0][1] * v[1], gain[1][0] * v[0] + gain[1][1] * v[1]];
            for c in 0..2 {
                let by = times([state[0][c] - ahead[0][c], state[1][c] - ahead[1][c]]);
                (state[0][c], state[1][c]) = (own[0][c] + by[0], own[1][c] + by[1]);
            }
            // (I − GΦ)P(I − GΦ)ᵀ + G Q Gᵀ + G P′Gᵀ: sums of squares, whatever their sizes.
            let rest = |v: [f64; 2]| {
                let by = times([v[0] + h * v[1], v[1]]);
                [v[0] - by[0], v[1] - by[1]]
            };
            let noise = noise_root(h, curvature);
            let columns = [
                rest([p[0], p[1]]),
                rest([0.0, p[2]]),
                times([noise[0], noise[1]]),
                times([0.0, noise[2]]),
                times([root[0], root[1]]),
                times([0.0, root[2]]),
            ];
            root = triangular_root(&columns);
            curve.states[k] = state;
            curve.variance[k] = root[0] * root[0];
        }
        curve
    }
}

/// ‖Q^{-1/2}(s_{k+1} − Φ s_k)‖² over all steps and both numbers: what a curve costs under a curvature.
pub(crate) fn roughness(x: &[f64], states: &[State], curvature: f64) -> f64 {
    let mut sum = 0.0;
    for k in 1..states.len() {
        let h = x[k] - x[k - 1];
        let [a, b, d] = noise_root(h, curvature);
        for c in 0..2 {
            let (before, after) = (states[k - 1], states[k]);
            let u = (after[0][c] - before[0][c] - h * before[1][c]) / a;
            let v = (after[1][c] - before[1][c] - b * u) / d;
            sum += u * u + v * v;
        }
    }
    sum
}

/// Lower triangle of the covariance that the process gains over a step h: κ²[h³/3, h²/2; h²/2, h].
fn noise_root(h: f64, curvature: f64) -> Root {
    let root = (curvature * h).sqrt();
    [root * h / 3f64.sqrt(), root * 3f64.sqrt() / 2.0, root / 2.0]
}

fn predict(state: State, [s11, s21, s22]: Root, h: f64, curvature: f64) -> (State, Root) {
    let ahead = [[0, 1].map(|c| state[0][c] + h * state[1][c]), state[1]];
    let [a, b, d] = noise_root(h, curvature);
    (ahead, triangular_root(&[[s11 + h * s21, s21], [h * s22, s22], [a, b], [0.0, d]]))
}

/// The lower triangle S with S Sᵀ = Σ v vᵀ, by Gram and Schmidt.
fn triangular_root(columns: &[[f64; 2]]) -> Root {
    let s11 = columns.iter().map(|v| v[0] * v[0]).sum::<f64>().sqrt();
    if s11 == 0.0 {
        return [0.0, 0.0, columns.iter().map(|v| v[1] * v[1]).sum::<f64>().sqrt()];
    }
    let s21 = columns.iter().map(|v| v[0] / s11 * v[1]).sum::<f64>();
    let rest = columns.iter().map(|v| (v[1] - s21 * (v[0] / s11)).powi(2)).sum::<f64>();
    [s11, s21, rest.sqrt()]
}

/// G = P Φᵀ (S Sᵀ)⁻¹ with P the covariance before a step and S Sᵀ that after it.
fn gain([p11, p21, p22]: Root, [s11, s21, s22]: Root, h: f64) -> [[f64; 2]; 2] {
    // Rows of P Φᵀ.
    let (a, b, c) = (p11 * p11, p11 * p21, p21 * p21 + p22 * p22);
    [[a + h * b, b], [b + h * c, c]].map(|[u, v]| {
        // (S Sᵀ)⁻¹ of the row: forward, then back.
        let first = u / s11;
        let second = (v - s21 * first) / s22;
        let second = second / s22;
        [(first - s21 * second) / s11, second]
    })
}
