//! faer's sparse solvers: L D Lᵀ without pivoting, L B Lᵀ with Bunch–Kaufman inside supernodes, and LU.

use crate::case::{Case, Number};
use crate::round::{Report, Round, solves, timed};
use crate::symbolic::Full;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, LdltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuRef, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Which of faer's symmetric factorisations, in which order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symmetric {
    /// No pivoting, nested dissection.
    Ldlt,
    /// No pivoting, minimum degree.
    LdltMinimumDegree,
    /// Bunch–Kaufman within supernodes, nested dissection.
    Lblt,
}

/// So many threads as faer says it.
pub fn parallelism(threads: usize) -> Par {
    if threads == 1 { Par::Seq } else { Par::rayon(threads) }
}

/// One round of a symmetric factorisation, in real numbers only: in complex ones faer's are Hermitian.
///
/// # Errors
/// A pivot that is zero; complex numbers.
pub fn symmetric<T: Number>(kind: Symmetric, case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
    let Some(values) = T::real(&case.values) else { return Err("real only".to_owned()) };
    let Some(rhs) = T::real(&case.rhs) else { return Err("real only".to_owned()) };
    let (par, n) = (parallelism(threads), case.dim());
    let lower =
        SymbolicSparseColMatRef::new_checked(n, n, case.pattern.col_ptr(), None, case.pattern.row_idx());
    let matrix = SparseColMatRef::new(lower, values);
    let (symbolic, analysis) = timed(|| analyse(kind, case, lower));
    let symbolic = symbolic?;
    let mut l = Vec::new();
    let scratch = |request: StackReq| MemBuffer::new(request);
    let (mut subdiagonal, mut forward, mut inverse) = (Vec::new(), Vec::new(), Vec::new());
    let (outcome, factor) = timed(|| {
        l.resize(symbolic.len_val(), 0.0);
        if kind == Symmetric::Lblt {
            subdiagonal.resize(n, 0.0);
            forward.resize(n, 0);
            inverse.resize(n, 0);
            let request = symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(par, Default::default());
            symbolic.factorize_numeric_intranode_lblt(
                &mut l,
                &mut subdiagonal,
                &mut forward,
                &mut inverse,
                matrix,
                Side::Lower,
                par,
                MemStack::new(&mut scratch(request)),
                Default::default(),
            );
            return Ok(());
        }
        let request = symbolic.factorize_numeric_ldlt_scratch::<f64>(par, Default::default());
        let outcome = symbolic.factorize_numeric_ldlt(
            &mut l,
            matrix,
            Side::Lower,
            Default::default(),
            par,
            MemStack::new(&mut scratch(request)),
            Default::default(),
        );
        outcome.map(|_| ()).map_err(|error| format!("{error:?}"))
    });
    outcome?;
    let solve = |x: &mut [f64]| {
        let columns = x.len() / n;
        let mut buffer = scratch(symbolic.solve_in_place_scratch::<f64>(columns, par));
        let (x, stack) = (MatMut::from_column_major_slice_mut(x, n, columns), MemStack::new(&mut buffer));
        if kind == Symmetric::Lblt {
            let pivots = PermRef::new_checked(&forward, &inverse, n);
            IntranodeLbltRef::new(&symbolic, &l, &subdiagonal, pivots).solve_in_place_with_conj(
                Conj::No,
                x,
                par,
                stack,
            );
        } else {
            LdltRef::new(&symbolic, &l).solve_in_place_with_conj(Conj::No, x, par, stack);
        }
        Ok::<_, String>(())
    };
    let (x, solve_8) = solves(rhs, solve)?;
    let (_, solve_1) = solves(&rhs[..n], solve)?;
    let report = Report {
        memory: Some(size_of_val(l.as_slice()) as f64 / 1e6),
        entries: Some(l.len() as f64 / 1e6),
        ..Report::default()
    };
    Ok(Round { analysis, factor, solve_1, solve_8, report, peak: None, solution: T::of_real(x) })
}

fn analyse<T: Number>(
    kind: Symmetric,
    case: &Case<T>,
    lower: SymbolicSparseColMatRef<'_, usize>,
) -> Result<SymbolicCholesky<usize>, String> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let full = Full::new(&case.pattern);
    let order = match kind {
        Symmetric::LdltMinimumDegree => full.minimum_degree()?,
        _ => full.dissection()?,
    };
    let mut inverse = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &row)| inverse[row] = k);
    let order = PermRef::new_checked(&order, &inverse, order.len());
    factorize_symbolic_cholesky(lower, Side::Lower, SymmetricOrdering::Custom(order), params)
        .map_err(|error| format!("{error:?}"))
}

/// One round of LU with threshold partial pivoting and COLAMD.
///
/// # Errors
/// What faer says.
pub fn lu<T: Number>(case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
    let (par, n) = (parallelism(threads), case.dim());
    let ((full, symbolic), analysis) = timed(|| {
        let full = Full::new(&case.pattern);
        let symbolic = factorize_symbolic_lu(full.symbolic(), Default::default());
        (full, symbolic)
    });
    let symbolic = symbolic.map_err(|error| format!("{error:?}"))?;
    let values: Vec<T> = full.source.iter().map(|&k| case.values[k]).collect();
    let mut numeric = NumericLu::new();
    let (outcome, factor) = timed(|| {
        let mut buffer = MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<T>(par, Default::default()));
        let matrix = SparseColMatRef::new(full.symbolic(), &values);
        let stack = MemStack::new(&mut buffer);
        let outcome = symbolic.factorize_numeric_lu(&mut numeric, matrix, par, stack, Default::default());
        outcome.map(|_| ()).map_err(|error| format!("{error:?}"))
    });
    outcome?;
    let solve = |x: &mut [T]| {
        let columns = x.len() / n;
        let mut buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<T>(columns, par));
        let (x, stack) = (MatMut::from_column_major_slice_mut(x, n, columns), MemStack::new(&mut buffer));
        LuRef::new_unchecked(&symbolic, &numeric).solve_in_place_with_conj(Conj::No, x, par, stack);
        Ok::<_, String>(())
    };
    let (solution, solve_8) = solves(&case.rhs, solve)?;
    let (_, solve_1) = solves(&case.rhs[..n], solve)?;
    Ok(Round { analysis, factor, solve_1, solve_8, report: Report::default(), peak: None, solution })
}
