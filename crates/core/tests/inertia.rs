//! The factorisation that everything rests on, on real structures: Sylvester's law against dense eigenvalues, and
//! solutions of what the Harwell–Boeing collection has of structures.

use crate::shared_data;

use frfit_fem::brick::Face;
use frfit_fem::{Assembled, Bar, Beam, Brick, Mass, Plate, Support};
use frfit_linalg::dense::symmetric_eigen;
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Values};
use multifrontal::{Options, Solver, Symbolic, c64};
use shared_data::{read_matrix, shared};
use std::sync::Arc;

/// K and M on one pattern.
struct Structure {
    name: String,
    pattern: Arc<Pattern>,
    k: Vec<f64>,
    m: Vec<f64>,
}

impl Structure {
    fn new(name: &str, stiffness: &[(f64, &SymmetricMatrix)], mass: &[(f64, &SymmetricMatrix)]) -> Self {
        let patterns: Vec<_> = stiffness.iter().chain(mass).map(|(_, matrix)| matrix.pattern()).collect();
        let pattern = Pattern::union(&patterns);
        let sum = |terms: &[(f64, &SymmetricMatrix)]| {
            let mut sum = vec![0.0; pattern.stored()];
            terms.iter().for_each(|(factor, term)| {
                term.on_pattern(&pattern).accumulate_real_into(*factor, &mut sum);
            });
            sum
        };
        Self { name: name.to_owned(), k: sum(stiffness), m: sum(mass), pattern: Arc::clone(&pattern) }
    }

    fn of(name: &str, assembled: &Assembled, moduli: &[f64], densities: &[f64]) -> Self {
        let k: Vec<_> = moduli.iter().copied().zip(&assembled.stiffness).collect();
        let m: Vec<_> = densities.iter().copied().zip(&assembled.mass).collect();
        Self::new(name, &k, &m)
    }

    fn symbolic(&self) -> Symbolic {
        let options = Options::default();
        Symbolic::new(self.pattern.dim(), self.pattern.col_ptr(), self.pattern.row_idx(), &options).unwrap()
    }

    /// K − σ M for a σ of this part of the stiffest row's.
    fn shifted(&self, part: f64) -> (f64, Vec<f64>) {
        let diagonal = self.pattern.col_ptr()[..self.pattern.dim()].iter();
        let quotient = diagonal.filter(|&&k| self.m[k] > 0.0).map(|&k| self.k[k] / self.m[k]);
        let sigma = part * quotient.fold(0.0, f64::max);
        (sigma, self.k.iter().zip(&self.m).map(|(k, m)| k - sigma * m).collect())
    }
}

fn zoo() -> Vec<Structure> {
    let bar = Bar { elements: 80, ends: [Support::Free; 2], ..Bar::default() }.assemble().unwrap();
    let ends = [Support::Clamped, Support::Free];
    let beam = Beam { elements: 60, ends, mass: Mass::Lumped, ..Beam::default() }.assemble().unwrap();
    let plate =
        Plate { elements: [11; 2], edges: [Support::Clamped; 4], ..Plate::default() }.assemble().unwrap();
    let clamped =
        Brick { elements: [12, 3], clamped: vec![Face::XMin], ..Brick::default() }.assemble().unwrap();
    let free = Brick { elements: [6, 4], ..Brick::default() }.assemble().unwrap();
    let moduli = |assembled: &Assembled| -> Vec<f64> {
        // Steel and rubber in turn.
        (0..assembled.stiffness.len()).map(|k| if k % 2 == 0 { 2e11 } else { 1e6 }).collect()
    };
    let densities = |assembled: &Assembled| vec![7800.0; assembled.mass.len()];
    [
        ("free bar", bar),
        ("cantilever, lumped", beam),
        ("clamped plate", plate),
        ("clamped bricks", clamped),
        ("free bricks", free),
    ]
    .iter()
    .map(|(name, assembled)| Structure::of(name, assembled, &moduli(assembled), &densities(assembled)))
    .collect()
}

/// Negative eigenvalues of K − σ M by dense eigenvalues; `None` where one is too near 0 to have a sign.
fn negative_eigenvalues(structure: &Structure, shifted: &[f64]) -> Option<usize> {
    let n = structure.pattern.dim();
    let mut dense = vec![0.0; n * n];
    for ((row, col), &value) in structure.pattern.positions().zip(shifted) {
        dense[col * n + row] = value;
    }
    // Scaled to a unit diagonal, where there is one, so that small stiffnesses are not lost beside large ones.
    let scale: Vec<f64> =
        (0..n).map(|k| dense[k * n + k].abs().sqrt()).map(|d| if d > 0.0 { 1.0 / d } else { 1.0 }).collect();
    (0..n * n).for_each(|k| dense[k] *= scale[k / n] * scale[k % n]);
    let (values, _) = symmetric_eigen(n, &dense).unwrap();
    let largest = values.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    let clear = values.iter().all(|value| value.abs() > 1e-12 * largest);
    clear.then(|| values.iter().filter(|&&value| value < 0.0).count())
}

#[test]
fn negative_pivots_are_the_modes_below_a_shift() {
    for structure in zoo() {
        let symbolic = structure.symbolic();
        let mut decided = 0;
        for part in [1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.5] {
            let (sigma, shifted) = structure.shifted(part);
            let Some(expected) = negative_eigenvalues(&structure, &shifted) else { continue };
            let inertia = symbolic.factor(&shifted, &Options::default()).unwrap().inertia();
            assert_eq!(inertia.negative, expected, "{} under {sigma:e}", structure.name);
            decided += 1;
        }
        assert!(decided >= 4, "{}: {decided}", structure.name);
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn structures_of_the_harwell_boeing_collection_needs_data() {
    let folder = shared("hb");
    let files = std::fs::read_dir(&folder).unwrap();
    let mut names: Vec<String> = files
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.starts_with("bcsstk"))
        .collect();
    names.sort();
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let k = read_matrix(&folder.join(&name));
        let mass = folder.join(name.replace("bcsstk", "bcsstm").replace(".rsa", ".mtx"));
        let m = if mass.exists() { read_matrix(&mass) } else { identity(k.dim()) };
        let structure = Structure::new(&name, &[(1.0, &k)], &[(1.0, &m)]);
        let symbolic = structure.symbolic();
        for part in [0.0, 1e-8, 1e-3] {
            let (sigma, shifted) = structure.shifted(part);
            let factor = symbolic.factor(&shifted, &Options::default()).unwrap();
            // Dense eigenvalues of the larger ones would take minutes.
            if k.dim() < 500
                && let Some(expected) = negative_eigenvalues(&structure, &shifted)
            {
                assert_eq!(factor.inertia().negative, expected, "{name} under {sigma:e}");
            }
            if part == 0.0 {
                // All of these stiffness matrices are positive definite.
                assert_eq!(factor.inertia().negative, 0, "{name}");
            }
            let damped: Vec<c64> =
                shifted.iter().zip(&structure.k).map(|(&d, &k)| c64::new(d, 1e-3 * k)).collect();
            let solver = Solver::new(&symbolic, &damped, &Options::default()).unwrap();
            let mut x: Vec<c64> = (0..k.dim()).map(|i| c64::new((i as f64).sin(), 0.0)).collect();
            let solution = solver.solve(&mut x).unwrap();
            // Refinement ends at a few units of roundoff.
            assert!(solution.backward_error < 1e-15, "{name} under {sigma:e}: {solution:?}");
        }
    }
}

fn identity(dim: usize) -> SymmetricMatrix {
    let pattern = Pattern::new(dim, []);
    SymmetricMatrix::new(Arc::new(pattern), Values::Real(vec![1.0; dim]))
}
