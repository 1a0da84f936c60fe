//! A cube of springs and masses: how many of its modes are below a frequency, and how it answers there.

#![allow(clippy::print_stdout, reason = "an example shows what it finds")]

use multifrontal::{Options, Solver, Symbolic, c64};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // n³ unit masses with unit springs to their neighbours and to the walls: K and its diagonal M = 1.
    let n = 20;
    let node = |p: [usize; 3]| (p[0] * n + p[1]) * n + p[2];
    let (mut col_ptr, mut row_idx, mut stiffness) = (vec![0], Vec::new(), Vec::new());
    for p in (0..n * n * n).map(|p| [p / n / n, p / n % n, p % n]) {
        row_idx.push(node(p));
        stiffness.push(6.0);
        for axis in [2, 1, 0] {
            let mut neighbour = p;
            neighbour[axis] += 1;
            if neighbour[axis] < n {
                row_idx.push(node(neighbour));
                stiffness.push(-1.0);
            }
        }
        col_ptr.push(row_idx.len());
    }
    let dim = n * n * n;
    let symbolic = Symbolic::new(dim, &col_ptr, &row_idx, &Options::default())?;
    println!(
        "{dim} unknowns: {} entries in L, {:.1} million operations, {:.1} MB",
        symbolic.factor_entries(),
        symbolic.flops() / 1e6,
        symbolic.factor_bytes::<f64>() as f64 / 1e6
    );

    // K − ω² M: its negative pivots are the modes below ω.
    let diagonal = |k: usize| col_ptr.binary_search(&k).is_ok();
    let square = 0.5;
    let shifted: Vec<f64> = stiffness
        .iter()
        .enumerate()
        .map(|(k, &value)| value - if diagonal(k) { square } else { 0.0 })
        .collect();
    let factor = symbolic.factor(&shifted, &Options::default())?;
    println!("modes below ω² = {square}: {}", factor.inertia().negative);

    // K (1 + 0.02 i) − ω² M with a load in the middle.
    let damped: Vec<c64> = shifted.iter().zip(&stiffness).map(|(&d, &k)| c64::new(d, 0.02 * k)).collect();
    let solver = Solver::new(&symbolic, &damped, &Options::default())?;
    let mut response = vec![c64::default(); dim];
    let middle = node([n / 2; 3]);
    response[middle] = c64::new(1.0, 0.0);
    let solution = solver.solve(&mut response)?;
    println!("response at the load: {:.6}, backward error {:.1e}", response[middle], solution.backward_error);
    Ok(())
}
