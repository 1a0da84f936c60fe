//! The hexahedron: null space, patch test, pure bending.

use super::support::{dot, largest, misfit};
use frfit_fem::Error;
use frfit_fem::brick::{Formulation, hexahedron};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use proptest::prelude::*;

const FORMULATIONS: [Formulation; 2] = [Formulation::Incompatible, Formulation::Standard];

/// Corners of the element with lowest corner (i, j, k) in a grid of 4 × 4 × 4 nodes.
fn corners_of([i, j, k]: [usize; 3]) -> [usize; 8] {
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
        .map(|[di, dj, dk]| (i + di) + 4 * (j + dj) + 16 * (k + dk))
}

fn index(node: usize) -> [usize; 3] {
    [node % 4, node / 4 % 4, node / 16]
}

/// 27 elements in the unit cube, all nodes moved by up to 0.3 of a step, faces no longer plane.
fn distorted(moves: &[f64]) -> Vec<[f64; 3]> {
    (0..64)
        .map(|node| {
            let step = 1.0 / 3.0;
            std::array::from_fn(|axis| step * (index(node)[axis] as f64 + 0.3 * moves[3 * node + axis]))
        })
        .collect()
}

fn stiffness(nodes: &[[f64; 3]], poisson: f64, formulation: Formulation) -> DMatrix<f64> {
    let mut k = DMatrix::zeros(192, 192);
    for element in (0..27).map(|e| corners_of([e % 3, e / 3 % 3, e / 9])) {
        let matrices = hexahedron(&element.map(|node| nodes[node]), poisson, formulation).unwrap();
        for (i, row) in matrices.stiffness.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                k[(3 * element[i / 3] + i % 3, 3 * element[j / 3] + j % 3)] += value;
            }
        }
    }
    k
}

/// Right-handed rotation about an axis through the origin.
fn rotation(axis: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]][axis]
}

fn moves(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, count)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Nodes of the surface follow a linear field; those inside must find it, in any distorted patch.
    /// Irons & Razzaque, in Aziz (ed.), Mathematical Foundations of the Finite Element Method, 1972.
    #[test]
    fn patch_test(moves in moves(192), gradient in moves(9), poisson in 0.0..0.49_f64) {
        let nodes = distorted(&moves);
        let field = |dof: usize| dot(&gradient[3 * (dof % 3)..][..3], &nodes[dof / 3]);
        let inner = |dof: &usize| index(dof / 3).iter().all(|i| (1..=2).contains(i));
        let (inside, surface): (Vec<usize>, Vec<usize>) = (0..192).partition(inner);
        for formulation in FORMULATIONS {
            let k = stiffness(&nodes, poisson, formulation);
            let force = |row: usize| -surface.iter().map(|&col| k[(row, col)] * field(col)).sum::<f64>();
            let load = DVector::from_iterator(inside.len(), inside.iter().map(|&row| force(row)));
            let coupled = DMatrix::from_fn(inside.len(), inside.len(), |i, j| k[(inside[i], inside[j])]);
            let found = coupled.cholesky().unwrap().solve(&load);
            for (found, &dof) in found.iter().zip(&inside) {
                prop_assert!((found - field(dof)).abs() < 1e-12);
            }
        }
    }

    /// Six zero eigenvalues, and no other: neither missing rigid motions nor hourglass modes.
    #[test]
    fn six_rigid_motions_and_no_other(moves in moves(192), poisson in 0.0..0.49_f64) {
        let nodes = distorted(&moves);
        let corners = corners_of([1, 1, 1]).map(|node| nodes[node]);
        for formulation in FORMULATIONS {
            let element = hexahedron(&corners, poisson, formulation).unwrap();
            let k = DMatrix::from_fn(24, 24, |i, j| element.stiffness[i][j]);
            // Roundoff of sums over eight points, and of the condensation.
            prop_assert!((&k - k.transpose()).amax() < 1e-13 * k.amax());
            for axis in 0..3 {
                let moved = DVector::from_fn(24, |i, _| f64::from(i % 3 == axis));
                let turned = DVector::from_fn(24, |i, _| rotation(axis, corners[i / 3])[i % 3]);
                prop_assert!((&k * moved).amax() < 1e-13 * k.amax());
                prop_assert!((&k * turned).amax() < 1e-13 * k.amax());
            }
            let mut values: Vec<f64> = SymmetricEigen::new(k.clone()).eigenvalues.iter().copied().collect();
            values.sort_by(f64::total_cmp);
            // The softest deformation is a shear or bending; the stiffest, change of volume, is some 1/(1−2ν) = 50
            // of it at most, and more where the element is thin.
            prop_assert!(largest(&values[..6]) < 1e-13 * values[23] && values[6] > 1e-4 * values[23], "{values:?}");
        }
    }

    /// Nodes inside move anywhere, those of the surface within it: the patch stays the unit cube, of mass 1.
    #[test]
    fn mass_of_a_patch_with_plane_faces(mut moves in moves(192)) {
        for (dof, distance) in moves.iter_mut().enumerate() {
            *distance *= f64::from((1..=2).contains(&index(dof / 3)[dof % 3]));
        }
        let nodes = distorted(&moves);
        let (mut consistent, mut lumped) = (0.0, 0.0);
        for element in (0..27).map(|e| corners_of([e % 3, e / 3 % 3, e / 9])) {
            let matrices = hexahedron(&element.map(|node| nodes[node]), 0.3, Formulation::Standard).unwrap();
            consistent += (0..8).flat_map(|a| (0..8).map(move |b| (3 * a, 3 * b))).map(|(i, j)| matrices.mass[i][j]).sum::<f64>();
            lumped += (0..8).map(|a| matrices.lumped[3 * a]).sum::<f64>();
            prop_assert!(matrices.lumped.iter().all(|mass| *mass > 0.0));
        }
        prop_assert!((consistent - 1.0).abs() < 1e-13 && (lumped - 1.0).abs() < 1e-13);
    }

    /// Pure bending of a rectangular element about y, with the anticlastic curvature: the energy of a length L
    /// is I L/R² per unit modulus. Exact with incompatible modes, far too high without.
    #[test]
    fn pure_bending(length in 0.5..20.0_f64, width in 0.5..2.0_f64, poisson in 0.0..0.49_f64) {
        let corners = corners_of([0, 0, 0]).map(index).map(|[i, j, k]| {
            [length * i as f64, width * (j as f64 - 0.5), k as f64 - 0.5]
        });
        let bent = corners.map(|[x, y, z]| {
            [x * z, -poisson * y * z, -(x * x + poisson * (z * z - y * y)) / 2.0]
        });
        let u: [f64; 24] = std::array::from_fn(|i| bent[i / 3][i % 3]);
        let stiffness = |formulation| hexahedron(&corners, poisson, formulation).unwrap().stiffness;
        let exact = width / 12.0 * length;
        // Roundoff of eight points and of the condensation.
        prop_assert!(misfit(&stiffness(Formulation::Incompatible), &u, &u, exact) < 1e-13);
        // Straight edges shear by γ = x: μ ∫ γ² dV = μ b h L³/12, against b h³ L/12 that is right; μ > 1/3.
        let locked: f64 = stiffness(Formulation::Standard).iter().zip(&u).map(|(row, u_i)| u_i * dot(row, &u)).sum();
        prop_assert!(locked / exact > 1.0 + 0.3 * length * length);
    }
}

#[test]
fn refusals() {
    let corners = corners_of([0, 0, 0]).map(index).map(|node| node.map(|i| i as f64));
    let upside_down = std::array::from_fn(|i| corners[(i + 4) % 8]);
    let flat = corners.map(|[x, y, _]| [x, y, 0.0]);
    for bad in [upside_down, flat, [[f64::NAN; 3]; 8]] {
        assert_eq!(hexahedron(&bad, 0.3, Formulation::Standard), Err(Error::InsideOut));
    }
    for poisson in [0.5, -1.0, f64::NAN] {
        assert!(matches!(
            hexahedron(&corners, poisson, Formulation::Standard),
            Err(Error::OutOfRange { .. })
        ));
    }
}
